#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "vigia/core/rig.hpp"
#include "vigia/sim/disturbances.hpp"

namespace vigia::sim {

/// How far the calibration of a camera and what carries it is from the truth: drawn once, constant
/// since. Each camera of a rig has its own.
class CameraErrors {
 public:
  CameraErrors() = default;
  CameraErrors(const DisturbanceParams& disturbances, std::uint64_t seed, CameraId camera = 0);

  /// Errors of a stereo pair, drawn once for both of its cameras; @p side is +1 of the left one, −1
  /// of the right.
  void draw_pair(const StereoParams& pair, std::uint64_t seed, double side);

  /// The camera's true intrinsics, where the table says @p calibrated at a zoom position that is
  /// the fraction @p u of the way from the wide to the long end.
  Intrinsics true_intrinsics(const Intrinsics& calibrated, double u) const;

  /// The true model of optics that do not zoom: focal length and principal point are off.
  CameraModel true_model(const CameraModel& calibrated) const;

  /// How a camera is truly mounted, but for mounting() of a head that carries it. A mirror tilts
  /// about its optical centre.
  CameraMount true_mount(const Camera& known) const;

  /// rMr': the base frame as the head truly sits on it. The head turns by yaw, pitch and roll about
  /// the crossing of its axes @p mount_r. Nothing when the head is mounted right.
  std::optional<Eigen::Isometry3d> mounting(const Eigen::Vector3d& mount_r) const;

 private:
  Eigen::Vector3d focal_ = Eigen::Vector3d::Zero();          ///< of 1, cos πu, cos 2πu; relative
  Eigen::Vector2d drift_ = Eigen::Vector2d::Zero();          ///< px from end to end
  Eigen::Vector2d bow_ = Eigen::Vector2d::Zero();            ///< px of sin 2πu
  double mirror_scale_ = 0.0;                                ///< relative
  Eigen::Vector2d mirror_centre_ = Eigen::Vector2d::Zero();  ///< px
  Eigen::Vector2d mirror_tilt_ = Eigen::Vector2d::Zero();    ///< rad about x and y of frame c
  bool paired_ = false;
  double pair_baseline_ = 0.0;  ///< relative
  double pair_turn_ = 0.0;      ///< about the base's z axis, rad
  double pair_focal_ = 0.0;     ///< relative
  bool askew_ = false;
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero();    ///< yaw, pitch, roll
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d camera_offset_h_ = Eigen::Vector3d::Zero();
};

}  // namespace vigia::sim
