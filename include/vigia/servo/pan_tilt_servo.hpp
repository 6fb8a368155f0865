#pragma once

#include <Eigen/Core>

#include "vigia/core/actuation.hpp"
#include "vigia/core/camera.hpp"

namespace vigia::servo {

struct PanTiltServoParams {
  double gain = 8.0;         ///< 1/s, exponential decay of the image error
  bool feed_forward = true;  ///< compensate the base's motion
  /// A command holds this long, s: the compensation is that of the interval's middle. 0: of now.
  double hold_s = 0.04;
};

/// (v, ω) of the base in its own frame, beside its rates: where it rolls across a fold.
using BaseTwist = Eigen::Matrix<double, 6, 1>;

/// Keeps an image point on the principal point with pan and tilt: ViSP's vpServo, eye in hand, on
/// the two head columns only, with base feed-forward q̇ += −(L·J_head)⁺ L·J_base (v, ω)ᵀ.
class PanTiltServo {
 public:
  PanTiltServo(HeadGeometry geometry, PanTiltServoParams params);

  /// Pan and tilt rates (rad/s) for the target seen at pixel @p uv at depth @p depth_m, in metres
  /// along the optical axis. @p base: the rates at which the base runs while the command holds.
  HeadAngles rates(const Intrinsics& intrinsics, const Eigen::Vector2d& uv, double depth_m,
                   const HeadAngles& head, const BaseRates& base,
                   const BaseTwist& rolling = BaseTwist::Zero()) const;

  /// The feed-forward alone: pan and tilt rates under which the point @p p_c of the camera frame
  /// (m, z > 0) keeps its image while the base moves, whatever feed_forward says.
  HeadAngles compensation(const Eigen::Vector3d& p_c, const HeadAngles& head, const BaseRates& base,
                          const BaseTwist& rolling = BaseTwist::Zero()) const;

 private:
  HeadAngles compensation_now(const Eigen::Vector3d& p_c, const HeadAngles& head,
                              const BaseRates& base, const BaseTwist& rolling) const;

  HeadGeometry geometry_;
  PanTiltServoParams params_;
};

}  // namespace vigia::servo
