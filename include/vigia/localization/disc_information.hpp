#pragma once

#include <utility>

#include "vigia/core/camera.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/information.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"

namespace vigia::localization {

struct DiscInformationParams {
  SensorNoise sensor;
  double radius_px = 24.0;        ///< apparent semi-major axis that the zoom holds
  double pixel_sigma = 0.02;      ///< of the ellipse's centre and axes over the whole look, px
  double frames_per_look = 25.0;  ///< over which the white part of the readings averages out
};

/// What one look at a disc teaches about (x, y, θ): Jᵀ (R + J_b B J_bᵀ)⁻¹ J at the exact disc
/// model, B the covariance of the look's biases, the head aimed at the disc and the zoom at
/// radius_px as far as the calibration allows. Nothing when the disc has no image, or only one cut
/// by the border.
class DiscInformation final : public InformationModel {
 public:
  DiscInformation(const HeadGeometry& geometry, const ZoomCalibration& zoom,
                  const DiscInformationParams& params, const Ground& ground = {})
      : geometry_(geometry),
        zoom_(zoom),
        on_ground_{head_rig(geometry, zoom), ground},
        params_(params) {}

  std::optional<Eigen::Matrix3d> look_information(const Landmark& landmark,
                                                  const Pose2& pose) const override;

 private:
  HeadGeometry geometry_;
  ZoomCalibration zoom_;
  RigOnGround on_ground_;
  DiscInformationParams params_;
};

}  // namespace vigia::localization
