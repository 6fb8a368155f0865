#pragma once

#include "vigia/core/camera.hpp"
#include "vigia/core/information.hpp"
#include "vigia/localization/measurement_model.hpp"

namespace vigia::localization {

struct LandmarkInformationParams {
  SensorNoise sensor;
  double frames_per_look = 25.0;  ///< over which white errors average out
  double radius_px = 24.0;        ///< apparent semi-major axis of a disc that the zoom holds
  double disc_sigma_px = 0.02;    ///< of an ellipse's centre and axes over the whole look, px
  /// Distance that the zoom holds between the image's centre and the outermost points of a pattern
  /// or tag, as a share of the image's half height.
  double fill = 0.8;
  double point_sigma_px = 0.1;  ///< of one point in one image, px
};

/// What one look at a landmark teaches about (x, y, θ): Jᵀ (R + J_b B J_bᵀ)⁻¹ J of the measurement
/// model, B the covariance of the look's biases, the head aimed at the landmark and the zoom as the
/// look would have it, as far as the calibration allows. Nothing from behind, or when the image
/// would be cut by the border.
class LandmarkInformation final : public InformationModel {
 public:
  LandmarkInformation(const HeadGeometry& geometry, const ZoomCalibration& zoom,
                      const LandmarkInformationParams& params, const Ground& ground = {});

  std::optional<Eigen::Matrix3d> look_information(const Landmark& landmark,
                                                  const Pose2& pose) const override;

 private:
  std::optional<Match> expected_disc(const Landmark& landmark, const DiscShape& disc,
                                     const Pose2& pose) const;
  std::optional<Match> expected_points(const Landmark& landmark, const Pose2& pose) const;
  Shot aimed_shot(const Landmark& landmark, const Pose2& pose, double focal_per_metre) const;

  HeadGeometry geometry_;
  ZoomCalibration zoom_;
  LandmarkInformationParams params_;
  MeasurementModel model_;
};

}  // namespace vigia::localization
