#include "vigia/tracking/tag_tracker.hpp"

#include "lost_feature.hpp"
#include "point_window.hpp"
#include "tag_detector.hpp"
#include "tag_fit.hpp"

#include <algorithm>
#include <optional>

namespace vigia::tracking {
namespace {

using imaging::Frame;
using imaging::Window;

constexpr double kRimShare = 0.4;   // of the corners' distance from the middle: the white rim
constexpr int kSmallestWindow = 8;  // px; libapriltag needs some
constexpr double kSteps = 3.0;      // px that a fit may move

}  // namespace

class TagTracker::State {
 public:
  State(const KnownCodes& known, const TagTrackerParams& parameters)
      : known_(known),
        parameters_(parameters),
        detector_(parameters.family, parameters.quad_decimate, parameters.max_hamming) {
    fit_.max_bad_fields = std::min(parameters.max_hamming, detector_.demands().max_hamming);
    min_margin_ = std::max(parameters.min_decision_margin, detector_.demands().min_decision_margin);
  }

  PointsFeature acquire(const Frame& frame, const PointsPrediction& prediction) {
    expected_ = prediction.landmark;
    return search(frame, prediction.points, reach_of(prediction));
  }

  PointsFeature track(const Frame& frame) {
    if (last_.points.empty()) return lost_points(FeatureStatus::not_found);
    std::vector<LabelledPoint> predicted = last_.points;
    for (LabelledPoint& point : predicted) point.uv += motion_;
    if (const auto feature = follow(frame, predicted)) {
      keep(*feature);
      return *feature;
    }
    return search(frame, predicted, motion_.norm());
  }

  std::vector<PointsFeature> find(const Frame& frame, const Window& window) {
    std::vector<PointsFeature> features;
    if (window.width < kSmallestWindow || window.height < kSmallestWindow) return features;
    read(frame, window);
    for (const TagDetection& tag : detector_.detect(image_)) {
      if (tag.decision_margin < min_margin_) continue;
      features.push_back(feature_of(tag, {window.u, window.v}));
    }
    return features;
  }

  void start(const PointsFeature& feature) {
    expected_ = feature.landmark;
    keep(feature);
  }

  void expect_motion(const Eigen::Vector2d& shift) { motion_ += shift; }

 private:
  void read(const Frame& frame, const Window& window) {
    image_.resize(static_cast<unsigned>(window.height), static_cast<unsigned>(window.width));
    frame.read_grey(window, image_.bitmap, window.width);
  }

  const Landmark* landmark_of(int tag) const {
    for (const Landmark& candidate : known_.map.all()) {
      const auto* shape = std::get_if<TagShape>(&candidate.shape);
      if (shape != nullptr && shape->tag == tag) return &candidate;
    }
    return nullptr;
  }

  PointsFeature feature_of(const TagDetection& tag, const Eigen::Vector2d& origin) {
    PointsFeature feature;
    feature.code = tag.tag;
    feature.confidence = detector_.confidence_of(tag.hamming);
    const Landmark* landmark = landmark_of(tag.tag);
    if (landmark != nullptr) feature.landmark = landmark->id;
    const TagFit fit = fit_tag(image_, detector_.grid(tag.tag), tag.corners, fit_);
    feature.status = FeatureStatus::occluded;
    if (fit.status != TagFitStatus::fitted) return feature;
    list_corners(fit, origin, feature);
    feature.status =
        landmark != nullptr || known_.any ? FeatureStatus::found : FeatureStatus::unknown_code;
    return feature;
  }

  static void list_corners(const TagFit& fit, const Eigen::Vector2d& origin,
                           PointsFeature& feature) {
    feature.points.clear();
    for (int k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(k);
      feature.points.push_back({k, fit.corners[i] + origin, fit.covariance[i]});
    }
  }

  /// The tag that is tracked, fitted from where it is expected.
  std::optional<PointsFeature> follow(const Frame& frame,
                                      const std::vector<LabelledPoint>& predicted) {
    const Window window =
        window_of(predicted, kRimShare * extent_of(predicted) + kSteps, frame.full());
    if (window.width < kSmallestWindow || window.height < kSmallestWindow) return std::nullopt;
    read(frame, window);
    const Eigen::Vector2d origin(window.u, window.v);
    TagCorners corners;
    for (std::size_t k = 0; k < corners.size(); ++k) corners[k] = predicted[k].uv - origin;
    TagFitParams params = fit_;
    params.start_blur = blur_;
    const TagFit fit = fit_tag(image_, detector_.grid(std::get<int>(*last_.code)), corners, params);
    if (fit.status != TagFitStatus::fitted) return std::nullopt;
    blur_ = fit.blur;
    PointsFeature feature = last_;
    list_corners(fit, origin, feature);
    return feature;
  }

  PointsFeature search(const Frame& frame, const std::vector<LabelledPoint>& points, double reach) {
    const double rim = kRimShare * extent_of(points) + parameters_.search_margin_px;
    std::vector<PointsFeature> features = find(frame, window_of(points, reach + rim, frame.full()));
    for (const PointsFeature& feature : features)
      if (feature.landmark == expected_ && (expected_ || feature.code == last_.code)) {
        if (feature.status == FeatureStatus::found) keep(feature);
        return feature;
      }
    if (features.empty())
      return lost_points(reaches_over(points, frame.full()) ? FeatureStatus::cut_by_border
                                                            : FeatureStatus::not_found);
    PointsFeature other = features.front();
    if (other.status == FeatureStatus::found) other.status = FeatureStatus::wrong_object;
    return other;
  }

  void keep(const PointsFeature& feature) {
    last_ = feature;
    motion_.setZero();
  }

  KnownCodes known_;
  TagTrackerParams parameters_;
  TagDetector detector_;
  TagFitParams fit_;
  double min_margin_ = 0.0;
  double blur_ = TagFitParams{}.start_blur;  ///< of the tracked tag, px
  vpImage<unsigned char> image_;
  std::optional<LandmarkId> expected_;
  PointsFeature last_;
  Eigen::Vector2d motion_ = Eigen::Vector2d::Zero();
};

TagTracker::TagTracker(const KnownCodes& known, const TagTrackerParams& parameters)
    : state_(std::make_unique<State>(known, parameters)) {}
TagTracker::~TagTracker() = default;

PointsFeature TagTracker::acquire(const Frame& frame, const PointsPrediction& prediction) {
  return state_->acquire(frame, prediction);
}
PointsFeature TagTracker::track(const Frame& frame) {
  return state_->track(frame);
}
std::vector<PointsFeature> TagTracker::find_all(const Frame& frame) {
  return state_->find(frame, frame.full());
}
void TagTracker::start(const Frame& /*frame*/, const PointsFeature& feature) {
  state_->start(feature);
}
void TagTracker::expect_motion(const Eigen::Vector2d& shift) {
  state_->expect_motion(shift);
}

}  // namespace vigia::tracking
