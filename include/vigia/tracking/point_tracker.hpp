#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/feature_status.hpp"

namespace vigia::tracking {

/// What a landmark says of itself: a pattern's code or the number of a tag.
using LandmarkCode = std::variant<PatternCode, int>;

/// A landmark of labelled points measured in one frame.
struct PointsFeature {
  FeatureStatus status = FeatureStatus::not_found;
  std::optional<LandmarkCode> code;    ///< read without doubt; of unknown_code as well
  std::optional<LandmarkId> landmark;  ///< of the map
  /// Labels and points as in PointsObservation, in ascending order of the labels. Dots that are
  /// hidden are left out.
  std::vector<LabelledPoint> points;
  double confidence = 0.0;  ///< probability that the code is right, given the noise
};

/// Where the image of a landmark is expected.
struct PointsPrediction {
  LandmarkId landmark = 0;
  std::vector<LabelledPoint> points;  ///< at least one; their covariances are not used
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< px², common to all points
  double scale_sigma = 0.1;  ///< relative standard deviation of the image's size
};

/// A tracker of landmarks that say who they are and consist of labelled points. One object watches
/// one target; calls for successive frames come in order. It reads only the pixels that it needs.
class PointTracker {
 public:
  virtual ~PointTracker() = default;
  virtual std::string_view name() const = 0;

  /// Finds the predicted landmark in a window round the prediction (three sigma and a margin) and,
  /// when found, begins to track it. Another landmark of the map in its place is a wrong_object
  /// with its own id and points.
  virtual PointsFeature acquire(const imaging::Frame& frame,
                                const PointsPrediction& prediction) = 0;

  /// Measures the landmark that is tracked in the next frame. After any status but found the
  /// tracker keeps its last good state, so that the next frame may find it again.
  virtual PointsFeature track(const imaging::Frame& frame) = 0;

  /// Every landmark of this kind in a full frame, without prediction: the found ones and those
  /// that are seen but not read (occluded, cut_by_border, unreadable, unknown_code).
  virtual std::vector<PointsFeature> find_all(const imaging::Frame& frame) = 0;

  /// Begins to track @p feature, which find_all has found in @p frame.
  virtual void start(const imaging::Frame& frame, const PointsFeature& feature) = 0;

  /// Tells how the image is expected to have moved since the last frame (px), for the next track().
  virtual void expect_motion(const Eigen::Vector2d& shift) = 0;
};

/// Which codes count: those of a map, or any (then found features have no landmark).
struct KnownCodes {
  bool any = true;
  LandmarkMap map;
};

/// A tracker by its name: "pattern" or "tag", with default parameters. Null for another name.
std::unique_ptr<PointTracker> make_point_tracker(const std::string& name, const KnownCodes& known);

}  // namespace vigia::tracking
