#pragma once

#include <Eigen/Core>

#include "vigia/core/actuation.hpp"
#include "vigia/core/camera.hpp"

namespace vigia::servo {

struct PanTiltServoParams {
  double gain = 4.0;            ///< 1/s, exponential decay of the image error
  bool feed_forward = true;     ///< compensate the base's motion
};

/// Keeps an image point on the principal point with pan and tilt: ViSP's vpServo, eye in hand, on
/// the two head columns only, with base feed-forward q̇ += −(L·J_head)⁺ L·J_base (v, ω)ᵀ.
class PanTiltServo {
 public:
  PanTiltServo(HeadGeometry geometry, PanTiltServoParams params);

  /// Pan and tilt rates (rad/s) for the target seen at pixel @p uv at depth @p depth_m.
  HeadAngles rates(const Intrinsics& intrinsics, const Eigen::Vector2d& uv, double depth_m,
                   const HeadAngles& head, const BaseRates& base) const;

 private:
  HeadGeometry geometry_;
  PanTiltServoParams params_;
};

}  // namespace vigia::servo
