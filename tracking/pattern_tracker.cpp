#include "vigia/tracking/pattern_tracker.hpp"

#include "lost_feature.hpp"
#include "pattern_eye.hpp"
#include "point_window.hpp"

#include <optional>

namespace vigia::tracking {
namespace {

using imaging::Frame;
using imaging::Window;

/// From the outermost dots' centres to their rims and a little of the paper, in extents.
constexpr double kRim = 0.2;

}  // namespace

class PatternTracker::State {
 public:
  State(const KnownCodes& known, const PatternTrackerParams& parameters)
      : parameters_(parameters), eye_(known, parameters) {}

  PointsFeature acquire(const Frame& frame, const PointsPrediction& prediction) {
    expected_ = prediction.landmark;
    return search(
        frame, prediction.points,
        reach_of(prediction) + kRim * extent_of(prediction.points) + parameters_.search_margin_px);
  }

  PointsFeature track(const Frame& frame) {
    if (!sight_) return lost_points(FeatureStatus::not_found);
    if (auto sight = eye_.follow(frame, *sight_, motion_)) {
      keep(*sight);
      return sight->feature;
    }
    std::vector<LabelledPoint> predicted = sight_->feature.points;
    for (LabelledPoint& point : predicted) point.uv += motion_;
    const double margin =
        kRim * extent_of(predicted) + parameters_.search_margin_px + motion_.norm();
    return search(frame, predicted, margin);
  }

  std::vector<PointsFeature> find_all(const Frame& frame) {
    std::vector<PointsFeature> features;
    for (PatternSight& sight : eye_.find(frame, frame.full()))
      features.push_back(std::move(sight.feature));
    return features;
  }

  void start(const Frame& frame, const PointsFeature& feature) {
    if (feature.points.empty()) return;
    const double margin = kRim * extent_of(feature.points) + parameters_.search_margin_px;
    for (PatternSight& sight : eye_.find(frame, window_of(feature.points, margin, frame.full())))
      if (sight.feature.status == FeatureStatus::found && sight.feature.code == feature.code) {
        expected_ = sight.feature.landmark;
        keep(sight);
        return;
      }
  }

  void expect_motion(const Eigen::Vector2d& shift) { motion_ += shift; }

 private:
  void keep(const PatternSight& sight) {
    sight_ = sight;
    motion_.setZero();
  }

  /// Without a map the code that was tracked before says what is wanted.
  bool is_wanted(const PointsFeature& feature) const {
    if (expected_) return feature.landmark == expected_;
    return sight_ && feature.code == sight_->feature.code;
  }

  /// Finds the expected pattern in a window; else says what is there instead.
  PointsFeature search(const Frame& frame, const std::vector<LabelledPoint>& points,
                       double margin) {
    const Window window = window_of(points, margin, frame.full());
    if (window.empty()) return lost_points(FeatureStatus::not_found);
    const std::vector<PatternSight> sights = eye_.find(frame, window);
    for (const PatternSight& sight : sights)
      if (sight.feature.status == FeatureStatus::found && is_wanted(sight.feature)) {
        keep(sight);
        return sight.feature;
      }
    // The nearest to the middle of the prediction.
    const PatternSight* nearest = nullptr;
    double least = 0.0;
    for (const PatternSight& sight : sights) {
      const double distance = (sight.centre - middle_of(points)).norm();
      if (nearest != nullptr && distance > least) continue;
      nearest = &sight;
      least = distance;
    }
    if (nearest == nullptr)
      return lost_points(reaches_over(points, frame.full()) ? FeatureStatus::cut_by_border
                         : eye_.dots_near(points)           ? FeatureStatus::occluded
                                                            : FeatureStatus::not_found);
    PointsFeature feature = nearest->feature;
    if (feature.status == FeatureStatus::found) feature.status = FeatureStatus::wrong_object;
    return feature;
  }

  PatternTrackerParams parameters_;
  PatternEye eye_;
  std::optional<LandmarkId> expected_;
  std::optional<PatternSight> sight_;
  Eigen::Vector2d motion_ = Eigen::Vector2d::Zero();
};

PatternTracker::PatternTracker(const KnownCodes& known, const PatternTrackerParams& parameters)
    : state_(std::make_unique<State>(known, parameters)) {}
PatternTracker::~PatternTracker() = default;

PointsFeature PatternTracker::acquire(const Frame& frame, const PointsPrediction& prediction) {
  return state_->acquire(frame, prediction);
}
PointsFeature PatternTracker::track(const Frame& frame) {
  return state_->track(frame);
}
std::vector<PointsFeature> PatternTracker::find_all(const Frame& frame) {
  return state_->find_all(frame);
}
void PatternTracker::start(const Frame& frame, const PointsFeature& feature) {
  state_->start(frame, feature);
}
void PatternTracker::expect_motion(const Eigen::Vector2d& shift) {
  state_->expect_motion(shift);
}

}  // namespace vigia::tracking
