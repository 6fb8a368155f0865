#include "vigia/tracking/tag_tracker.hpp"

#include "lost_feature.hpp"
#include "point_window.hpp"
#include "side_fit.hpp"
#include "tag_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/imaging/tag_bitmap.hpp"

namespace vigia::tracking {
namespace {

using imaging::Frame;
using imaging::Window;

constexpr double kQuietZone = 0.4;  // of the corners' distance from the middle: the white rim
constexpr int kSmallestWindow = 8;  // px; libapriltag needs some

/// The probability that fields which are no tag at all do not read as one: 587 codes in four turns,
/// with up to @p wrong_bits of 36 bits wrong.
double confidence_of(int wrong_bits) {
  constexpr double kBits = 36.0;
  double words = 0.0;
  double choices = 1.0;
  for (int k = 0; k <= wrong_bits; ++k) {
    words += choices;
    choices *= (kBits - k) / (k + 1.0);
  }
  return 1.0 - kTags * 4.0 * words / std::pow(2.0, kBits);
}

/// The corners where fitted sides meet; none when a side cannot be fitted or a corner leaps.
std::optional<std::array<Corner, 4>> refit(const vpImage<unsigned char>& image,
                                           const TagDetection& tag) {
  std::array<std::optional<SideFit>, 4> sides;
  for (std::size_t k = 0; k < 4; ++k) {
    SideBand band{tag.corners[k], tag.corners[(k + 1) % 4], tag.centre, 0.0};
    // Within the black border and the white rim, each at least one field wide.
    const Eigen::Vector2d across = tag.corners[(k + 3) % 4] - tag.corners[k];
    const Eigen::Vector2d along = (band.to - band.from).normalized();
    const double depth = std::abs(cross(along, across));
    band.half_width = 0.8 * depth / imaging::kTagFields;
    sides[k] = fit_side(image, band);
    if (!sides[k]) return std::nullopt;
  }
  std::array<Corner, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto corner = meet(*sides[(k + 3) % 4], *sides[k]);
    const double field = (tag.corners[(k + 1) % 4] - tag.corners[k]).norm() / imaging::kTagFields;
    if (!corner || (corner->uv - tag.corners[k]).norm() > 0.5 * field + 0.5) return std::nullopt;
    corners[k] = *corner;
  }
  return corners;
}

}  // namespace

class TagTracker::State {
 public:
  State(const KnownCodes& known, const TagTrackerParameters& parameters)
      : known_(known),
        parameters_(parameters),
        detector_(parameters.quad_decimate, parameters.max_hamming) {}

  PointsFeature acquire(const Frame& frame, const PointsPrediction& prediction) {
    expected_ = prediction.landmark;
    return search(frame, prediction.points, reach_of(prediction));
  }

  PointsFeature track(const Frame& frame) {
    if (last_.empty()) return lost_points(FeatureStatus::not_found);
    std::vector<LabelledPoint> predicted = last_;
    for (LabelledPoint& point : predicted) point.uv += motion_;
    return search(frame, predicted, motion_.norm());
  }

  std::vector<PointsFeature> find(const Frame& frame, const Window& window) {
    std::vector<PointsFeature> features;
    if (window.width < kSmallestWindow || window.height < kSmallestWindow) return features;
    image_.resize(static_cast<unsigned>(window.height), static_cast<unsigned>(window.width));
    frame.read_grey(window, image_.bitmap, window.width);
    for (const TagDetection& tag : detector_.detect(image_)) {
      if (tag.decision_margin < parameters_.min_decision_margin) continue;
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
  PointsFeature feature_of(const TagDetection& tag, const Eigen::Vector2d& origin) const {
    PointsFeature feature;
    feature.code = tag.tag;
    feature.confidence = confidence_of(tag.hamming);
    const Landmark* landmark = nullptr;
    for (const Landmark& candidate : known_.map.all()) {
      const auto* shape = std::get_if<TagShape>(&candidate.shape);
      if (shape != nullptr && shape->tag == tag.tag) landmark = &candidate;
    }
    if (landmark != nullptr) feature.landmark = landmark->id;
    const auto corners = refit(image_, tag);
    if (!corners) {
      feature.status = FeatureStatus::occluded;
      return feature;
    }
    for (int k = 0; k < 4; ++k) {
      const Corner& corner = (*corners)[static_cast<std::size_t>(k)];
      feature.points.push_back({k, corner.uv + origin, corner.covariance});
    }
    feature.status =
        landmark != nullptr || known_.any ? FeatureStatus::found : FeatureStatus::unknown_code;
    return feature;
  }

  PointsFeature search(const Frame& frame, const std::vector<LabelledPoint>& points, double reach) {
    const double rim = kQuietZone * extent_of(points) + parameters_.search_margin_px;
    std::vector<PointsFeature> features = find(frame, window_of(points, reach + rim, frame.full()));
    for (const PointsFeature& feature : features)
      if (feature.landmark == expected_ && (expected_ || feature.code == code_)) {
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
    last_ = feature.points;
    code_ = feature.code;
    motion_.setZero();
  }

  KnownCodes known_;
  TagTrackerParameters parameters_;
  TagDetector detector_;
  vpImage<unsigned char> image_;
  std::optional<LandmarkId> expected_;
  std::optional<LandmarkCode> code_;
  std::vector<LabelledPoint> last_;
  Eigen::Vector2d motion_ = Eigen::Vector2d::Zero();
};

TagTracker::TagTracker(const KnownCodes& known, const TagTrackerParameters& parameters)
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
