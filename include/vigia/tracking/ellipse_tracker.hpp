#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/observation.hpp"
#include "vigia/imaging/canvas.hpp"
#include "vigia/tracking/feature_status.hpp"

namespace vigia::tracking {

/// An ellipse measured in one frame.
struct EllipseFeature {
  FeatureStatus status = FeatureStatus::not_found;
  Ellipse ellipse;
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Identity();
  double contrast = 0.0;  ///< ground minus disc, grey levels; negative: bright on dark
  double score = 0.0;     ///< tracker's own quality in [0, 1]
  double visible = 1.0;   ///< share of the outline that agrees; less than 1: partly covered
  double clipped = 0.0;   ///< share of the outline's pixels that are at 0 or 255
};

/// Where the image of a landmark is expected.
struct EllipsePrediction {
  Ellipse ellipse;
  Eigen::Matrix2d centre_covariance = Eigen::Matrix2d::Identity();  ///< px²
  double scale_sigma = 0.1;  ///< relative standard deviation of the axes
};

/// A tracker of elliptical landmarks. One object watches one target; calls for successive frames
/// come in order.
class EllipseTracker {
 public:
  virtual ~EllipseTracker() = default;
  virtual std::string_view name() const = 0;

  /// Finds the predicted ellipse in a window round the prediction (three sigma and a margin) and,
  /// when found, begins to track it.
  virtual EllipseFeature acquire(imaging::Canvas& canvas, const EllipsePrediction& prediction) = 0;

  /// Measures the ellipse that is tracked in the next frame. After any status but found the tracker
  /// keeps its last good state, so that the next frame may find it again.
  virtual EllipseFeature track(imaging::Canvas& canvas) = 0;

  /// Every disc of a full frame, without prediction; only those with status found.
  virtual std::vector<EllipseFeature> find_all(imaging::Canvas& canvas) = 0;

  /// Begins to track @p ellipse as if it had been acquired in this frame.
  virtual void start(imaging::Canvas& canvas, const Ellipse& ellipse) = 0;

  /// Tells how the image is expected to have moved since the last frame (px), for the next track().
  virtual void expect_motion(const Eigen::Vector2d& shift) = 0;
};

/// A tracker by its name: "disc", "ellipse" (moving edges) or "correlation", with default
/// parameters. Null for another name.
std::unique_ptr<EllipseTracker> make_ellipse_tracker(const std::string& name);

}  // namespace vigia::tracking
