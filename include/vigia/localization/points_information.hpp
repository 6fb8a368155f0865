#pragma once

#include <utility>

#include "vigia/core/camera.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/information.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/disc_information.hpp"

namespace vigia::localization {

struct PointsInformationParams {
  SensorNoise sensor;
  /// Distance that the zoom holds between the image's centre and the landmark's outermost points,
  /// as a share of the image's half height.
  double fill = 0.8;
  double pixel_sigma = 0.1;       ///< of one point in one image, px
  double frames_per_look = 25.0;  ///< over which white errors average out
};

/// What one look at a pattern or tag teaches about (x, y, θ), the look's biases marginalised: the
/// exact images of all points, the head aimed at the landmark and the zoom filling the image with
/// it as far as the calibration allows. Nothing for a disc, from behind, or when a point lies
/// outside the image.
class PointsInformation final : public InformationModel {
 public:
  PointsInformation(const HeadGeometry& geometry, const ZoomCalibration& zoom,
                    const PointsInformationParams& params, const Ground& ground = {})
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
  PointsInformationParams params_;
};

/// Discs by DiscInformation, patterns and tags by PointsInformation.
class LandmarkInformation final : public InformationModel {
 public:
  LandmarkInformation(DiscInformation discs, PointsInformation points)
      : discs_(std::move(discs)), points_(std::move(points)) {}

  std::optional<Eigen::Matrix3d> look_information(const Landmark& landmark,
                                                  const Pose2& pose) const override {
    if (disc_radius(landmark)) return discs_.look_information(landmark, pose);
    return points_.look_information(landmark, pose);
  }

 private:
  DiscInformation discs_;
  PointsInformation points_;
};

}  // namespace vigia::localization
