#include "vigia/tracking/point_picture_run.hpp"

#include "csv_text.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "vigia/core/error.hpp"

namespace vigia::tracking {
namespace {

constexpr int kShift = 4;  // OpenCV's sub-pixel drawing, sixteenths
constexpr int kTagCorners = 4;

/// A light line on a wider dark one.
struct Pen {
  cv::Scalar colour;
  int width;
};

cv::Point fine(const Eigen::Vector2d& uv) {
  const auto sixteenths = [](double value) { return static_cast<int>(std::lround(16.0 * value)); };
  return {sixteenths(uv.x()), sixteenths(uv.y())};
}

void draw_points(const PointsFeature& feature, const Pen& pen, cv::Mat& canvas) {
  const auto& points = feature.points;
  const bool tag = std::holds_alternative<int>(*feature.code);
  for (std::size_t i = 0; tag && points.size() == kTagCorners && i < points.size(); ++i)
    cv::line(canvas, fine(points[i].uv), fine(points[(i + 1) % points.size()].uv), pen.colour,
             pen.width, cv::LINE_AA, kShift);
  for (const LabelledPoint& point : points) {
    const Eigen::Vector2d across(4.0, 0.0);
    const Eigen::Vector2d down(0.0, 4.0);
    for (const Eigen::Vector2d& arm : {across, down})
      cv::line(canvas, fine(point.uv - arm), fine(point.uv + arm), pen.colour, pen.width,
               cv::LINE_AA, kShift);
    cv::putText(canvas, std::to_string(point.label),
                cv::Point(static_cast<int>(point.uv.x()) + 5, static_cast<int>(point.uv.y()) - 4),
                cv::FONT_HERSHEY_SIMPLEX, 0.35, pen.colour, pen.width, cv::LINE_AA);
  }
}

/// The code, beside the landmark and within the picture.
void draw_code(const PointPictureRow& row, const Pen& pen, cv::Mat& canvas) {
  double right = 0.0;
  double top = canvas.rows;
  for (const LabelledPoint& point : row.feature.points) {
    right = std::max(right, point.uv.x());
    top = std::min(top, point.uv.y());
  }
  const std::string text = to_string(*row.feature.code) + " (" + std::to_string(row.target) + ')';
  int below = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.5, pen.width, &below);
  const cv::Point place(
      std::clamp(static_cast<int>(right) + 8, 1, std::max(1, canvas.cols - size.width - 2)),
      std::clamp(static_cast<int>(top) - 6, size.height + 2,
                 std::max(size.height + 2, canvas.rows - 3)));
  cv::putText(canvas, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.5, pen.colour, pen.width,
              cv::LINE_AA);
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
  cv::Mat canvas(static_cast<int>(picture.getHeight()), static_cast<int>(picture.getWidth()),
                 CV_8UC4, picture.bitmap);
  // vpRGBa is R, G, B, A in memory.
  const Pen dark{cv::Scalar(20, 20, 60, 255), 3};
  const Pen light{cv::Scalar(255, 210, 0, 255), 1};
  for (const Pen& pen : {dark, light})
    for (const PointPictureRow& row : result.rows) {
      if (!row.feature.code || row.feature.points.empty()) continue;
      draw_points(row.feature, pen, canvas);
      draw_code(row, pen, canvas);
    }
}

}  // namespace vigia::tracking
