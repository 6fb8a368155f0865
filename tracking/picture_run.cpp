#include "vigia/tracking/picture_run.hpp"

#include "csv_text.hpp"
#include "lost_feature.hpp"
#include "overlay_pen.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/error.hpp"
#include "vigia/tracking/correlation_tracker.hpp"
#include "vigia/tracking/disc_tracker.hpp"
#include "vigia/tracking/moving_edge_tracker.hpp"

namespace vigia::tracking {
namespace {

double distance(const Ellipse& a, const Ellipse& b) {
  return std::hypot(a.u - b.u, a.v - b.v);
}

bool same_disc(const EllipseFeature& a, const EllipseFeature& b) {
  return a.status == FeatureStatus::found && b.status == FeatureStatus::found &&
         distance(a.ellipse, b.ellipse) < 0.5 * std::min(a.ellipse.b, b.ellipse.b);
}

}  // namespace

std::unique_ptr<EllipseTracker> make_picture_tracker(const std::string& name) {
  DiscTrackerParameters disc;
  disc.polarity = Polarity::either;
  disc.search_margin_px = 20.0;
  // Prints and prints' edges are less perfect than the landmarks of a mission.
  disc.max_outline_px = 0.6;
  disc.max_raggedness_px = 0.35;
  disc.min_agreement = 0.8;
  if (name == "disc") return std::make_unique<DiscTracker>(disc);
  if (name == "ellipse") {
    MovingEdgeTrackerParameters parameters;
    parameters.min_visible = 0.35;
    parameters.finder = disc;
    return std::make_unique<MovingEdgeTracker>(parameters);
  }
  if (name == "correlation") {
    CorrelationTrackerParameters parameters;
    parameters.finder = disc;
    parameters.search_margin_px = disc.search_margin_px;
    return std::make_unique<CorrelationTracker>(parameters);
  }
  return nullptr;
}

PictureRun::PictureRun(const std::string& tracker)
    : tracker_(tracker), finder_(make_picture_tracker(tracker)) {
  if (!finder_)
    throw InputError("there is no tracker '" + tracker +
                     "'; known are 'disc', 'ellipse' and 'correlation'");
}

std::vector<PictureRow> PictureRun::find(const std::filesystem::path& name,
                                         imaging::Canvas& canvas) {
  targets_.clear();
  std::vector<PictureRow> rows;
  for (const EllipseFeature& feature : finder_->find_all(canvas)) {
    Target target{++numbers_, make_picture_tracker(tracker_), feature.ellipse};
    target.tracker->start(canvas, feature.ellipse);
    rows.push_back({name, target.number, feature});
    targets_.push_back(std::move(target));
  }
  found_anew_ = targets_.size();
  return rows;
}

std::vector<PictureRow> PictureRun::follow(const std::filesystem::path& name,
                                           imaging::Canvas& canvas) {
  std::vector<PictureRow> rows;
  for (Target& target : targets_)
    rows.push_back({name, target.number, target.tracker->track(canvas)});
  give_up_doubles(rows);
  return rows;
}

void PictureRun::give_up_doubles(std::vector<PictureRow>& rows) {
  // Of equal ways the first target's counts as the shorter.
  const auto nearer = [&](std::size_t i, std::size_t j) {
    const double way_i = distance(rows[i].feature.ellipse, targets_[i].last);
    const double way_j = distance(rows[j].feature.ellipse, targets_[j].last);
    return way_i < way_j || (way_i == way_j && i < j);
  };
  std::vector<bool> double_of_another(rows.size(), false);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows.size(); ++j)
      if (i != j && same_disc(rows[i].feature, rows[j].feature) && nearer(j, i))
        double_of_another[i] = true;
  std::vector<Target> kept;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (double_of_another[i]) {
      rows[i].feature = lost_ellipse(FeatureStatus::wrong_object);
      continue;
    }
    if (rows[i].feature.status == FeatureStatus::found) targets_[i].last = rows[i].feature.ellipse;
    kept.push_back(std::move(targets_[i]));
  }
  targets_ = std::move(kept);
}

PictureResult PictureRun::next(const std::filesystem::path& name,
                               const imaging::ImageFrame& picture) {
  imaging::Canvas canvas;
  canvas.attach(picture);
  PictureResult result{name, {}};
  const bool same_size = picture.width() == width_ && picture.height() == height_;
  width_ = picture.width();
  height_ = picture.height();
  if (same_size) result.rows = follow(name, canvas);
  const auto found = std::count_if(result.rows.begin(), result.rows.end(), [](const auto& row) {
    return row.feature.status == FeatureStatus::found;
  });
  if (found == 0 || 2 * static_cast<std::size_t>(found) < found_anew_)
    result.rows = find(name, canvas);
  return result;
}

void run_pictures(
    const std::string& tracker, const std::vector<std::filesystem::path>& files,
    const std::function<void(const PictureResult&, const imaging::ImageFrame&)>& report) {
  PictureRun run(tracker);
  for (const std::filesystem::path& file : files) {
    const imaging::ImageFrame picture = imaging::read_image(file);
    report(run.next(file, picture), picture);
  }
}

std::string picture_csv_header() {
  return "image,target,status,u,v,a,b,psi_deg,sigma_u,sigma_v,sigma_a,sigma_b,sigma_psi_deg,score,"
         "contrast";
}

std::string picture_csv_line(const PictureRow& row) {
  const EllipseFeature& feature = row.feature;
  std::string line = csv_field(row.image.string()) + ',' + std::to_string(row.target) + ',' +
                     std::string(to_string(feature.status));
  if (feature.status != FeatureStatus::found) return line + std::string(12, ',');
  const Ellipse& e = feature.ellipse;
  for (const double value : {e.u, e.v, e.a, e.b}) line += ',' + csv_number(value, 4);
  line += ',' + csv_number(to_deg(e.psi), 3);
  for (int i = 0; i < 4; ++i) line += ',' + csv_number(std::sqrt(feature.covariance(i, i)), 4);
  line += ',' + csv_number(to_deg(std::sqrt(feature.covariance(4, 4))), 3);
  return line + ',' + csv_number(feature.score, 3) + ',' + csv_number(feature.contrast, 1);
}

void draw_overlay(const PictureResult& result, vpImage<vpRGBa>& picture) {
  draw_twice(picture, [&](const OverlayPen& pen) {
    for (const PictureRow& row : result.rows) {
      if (row.feature.status != FeatureStatus::found) continue;
      const Ellipse& e = row.feature.ellipse;
      pen.ellipse(e);
      pen.cross({e.u, e.v}, std::clamp(0.3 * e.b, 2.0, 8.0));
      pen.text_within(
          std::to_string(row.target),
          {static_cast<int>(e.u + 0.71 * e.a) + 3, static_cast<int>(e.v - 0.71 * e.a) - 1}, 0.4);
    }
  });
}

}  // namespace vigia::tracking
