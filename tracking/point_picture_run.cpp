#include "vigia/tracking/point_picture_run.hpp"

#include "csv_text.hpp"
#include "overlay_pen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/error.hpp"

namespace vigia::tracking {
namespace {

constexpr int kTagCorners = 4;

void draw_points(const PointsFeature& feature, const OverlayPen& pen) {
  const auto& points = feature.points;
  const bool tag = std::holds_alternative<int>(*feature.code);
  for (std::size_t i = 0; tag && points.size() == kTagCorners && i < points.size(); ++i)
    pen.line(points[i].uv, points[(i + 1) % points.size()].uv);
  for (const LabelledPoint& point : points) {
    pen.cross(point.uv, 4.0);
    pen.text(std::to_string(point.label),
             {static_cast<int>(point.uv.x()) + 5, static_cast<int>(point.uv.y()) - 4}, 0.35);
  }
}

/// The code, beside the landmark and within the picture.
void draw_code(const PointPictureRow& row, const OverlayPen& pen) {
  double right = 0.0;
  double top = std::numeric_limits<double>::infinity();
  for (const LabelledPoint& point : row.feature.points) {
    right = std::max(right, point.uv.x());
    top = std::min(top, point.uv.y());
  }
  pen.text_within(to_string(*row.feature.code) + " (" + std::to_string(row.target) + ')',
                  {static_cast<int>(right) + 8, static_cast<int>(top) - 6}, 0.5);
}

}  // namespace

PointPictureRun::PointPictureRun(const std::string& tracker)
    : tracker_(tracker), finder_(make_point_tracker(tracker, {})) {
  if (!finder_)
    throw InputError("there is no tracker '" + tracker + "'; known are 'pattern' and 'tag'");
}

std::vector<PointPictureRow> PointPictureRun::find(const imaging::ImageFrame& picture) {
  targets_.clear();
  std::vector<PointPictureRow> rows;
  for (const PointsFeature& feature : finder_->find_all(picture)) {
    rows.push_back({++numbers_, feature});
    if (feature.status != FeatureStatus::found) continue;
    Target target{numbers_, make_point_tracker(tracker_, {})};
    target.tracker->start(picture, feature);
    targets_.push_back(std::move(target));
  }
  return rows;
}

PointPictureResult PointPictureRun::next(const std::filesystem::path& name,
                                         const imaging::ImageFrame& picture) {
  PointPictureResult result{name, {}};
  const bool same_size = picture.width() == width_ && picture.height() == height_;
  width_ = picture.width();
  height_ = picture.height();
  if (same_size)
    for (Target& target : targets_)
      result.rows.push_back({target.number, target.tracker->track(picture)});
  const auto found = std::count_if(result.rows.begin(), result.rows.end(), [](const auto& row) {
    return row.feature.status == FeatureStatus::found;
  });
  if (found == 0 || 2 * static_cast<std::size_t>(found) < result.rows.size())
    result.rows = find(picture);
  return result;
}

std::string to_string(const LandmarkCode& code) {
  if (const int* tag = std::get_if<int>(&code)) return std::to_string(*tag);
  const auto& pattern = std::get<PatternCode>(code);
  return std::to_string(pattern.floor) + '-' + std::to_string(pattern.room) + '-' +
         std::to_string(pattern.pattern);
}

std::string point_csv_header() {
  return "image,target,status,code,confidence,label,u,v,sigma_u,sigma_v,correlation";
}

std::string point_csv_lines(const PointPictureResult& result) {
  std::string lines;
  for (const PointPictureRow& row : result.rows) {
    const PointsFeature& feature = row.feature;
    const std::string start = csv_field(result.image.string()) + ',' + std::to_string(row.target) +
                              ',' + std::string(to_string(feature.status)) + ',' +
                              (feature.code ? to_string(*feature.code) : "");
    if (feature.status != FeatureStatus::found) {
      lines += start + std::string(7, ',') + '\n';
      continue;
    }
    for (const LabelledPoint& point : feature.points) {
      const double sigma_u = std::sqrt(point.covariance(0, 0));
      const double sigma_v = std::sqrt(point.covariance(1, 1));
      lines += start + ',' + csv_number(feature.confidence, 6) + ',' + std::to_string(point.label);
      for (const double value : {point.uv.x(), point.uv.y(), sigma_u, sigma_v})
        lines += ',' + csv_number(value, 4);
      lines += ',' + csv_number(point.covariance(0, 1) / (sigma_u * sigma_v), 3) + '\n';
    }
  }
  return lines;
}

void draw_overlay(const PointPictureResult& result, vpImage<vpRGBa>& picture) {
  draw_twice(picture, [&](const OverlayPen& pen) {
    for (const PointPictureRow& row : result.rows) {
      if (!row.feature.code || row.feature.points.empty()) continue;
      draw_points(row.feature, pen);
      draw_code(row, pen);
    }
  });
}

}  // namespace vigia::tracking
