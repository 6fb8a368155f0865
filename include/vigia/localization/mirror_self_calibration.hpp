#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/belief.hpp"
#include "vigia/core/camera_model.hpp"
#include "vigia/core/field_scan.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/localization/field_model.hpp"

namespace vigia::localization {

/// What a mirror camera's calibration may leave wrong, σ.
struct MirrorErrorParams {
  double scale = 0.005;         ///< relative, of its focal length
  double tilt = from_deg(0.1);  ///< about either axis of the image, rad
  double centre_px = 0.4;       ///< of either coordinate of its middle
  /// What changes in time: share of these σ in √s.
  double drift = 0.03;
  /// Scans in a row whose points' errors are alike, for they come from the same lines seen from
  /// nearly the same place: so many scans teach as much about the mirror as one whose errors are
  /// new.
  double alike_scans = 25.0;
};

/// Errors of a mirror camera: relative scale, tilt about x and y of frame c (rad), middle (px).
constexpr int kMirrorErrors = 5;
using MirrorErrors = Eigen::Matrix<double, kMirrorErrors, 1>;

/// A mirror camera and where the robot has it.
struct MirrorOnRobot {
  UnifiedOmni mirror;
  Eigen::Isometry3d rMc = Eigen::Isometry3d::Identity();

  /// What it is with these errors.
  MirrorOnRobot with(const MirrorErrors& errors) const;
  /// The pixel of a point of the floor z = 0, frame r.
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector2d& p_r) const;
};

/// Where the floor lies that a pixel shows, frame r, and how that moves with the camera's errors.
struct FloorOfPixel {
  Eigen::Vector2d p_r;
  Eigen::Matrix<double, 2, kMirrorErrors> dp_derrors;
};
std::optional<FloorOfPixel> floor_of_pixel(const MirrorOnRobot& camera, const Eigen::Vector2d& uv);

/// A scan whose points lie where the errors known so far leave them. Their covariances have grown
/// by what is not known of the errors.
struct CorrectedScan {
  FieldScan scan;
  std::vector<Eigen::Matrix2d> own;  ///< the points' covariances without
  std::vector<Eigen::Matrix<double, 2, kMirrorErrors>> dp_derrors;
};
/// The same from another place, as carried() does it.
CorrectedScan carried(const CorrectedScan& scan_b, const Pose2& aMb, Stamp stamp);

/// Estimates a mirror's errors while the robot drives. They move all points of a picture together,
/// which no filter averages out that takes points' errors for independent: 0.05° of tilt moves a
/// point at 4 m by 2 cm, a picture's points fix the pose to less than a millimetre. A Kalman
/// filter over pose and errors together, (x, y, θ, errors), iterated at each scan, learns from the
/// points whose line is beyond doubt; it starts where a localizer believes itself to be.
class MirrorSelfCalibration {
 public:
  MirrorSelfCalibration(const FieldModel& model, const MirrorErrorParams& params,
                        const OdometryNoise& odometry);

  /// Forgets the place, and keeps what is known of the mirror.
  void lose_place() { placed_ = false; }
  void predict(const OdometryIncrement& increment);
  CorrectedScan corrected(const FieldScan& scan, const MirrorOnRobot& camera) const;
  /// @p belief: the localizer's after the same scan.
  void update(const CorrectedScan& scan, const Belief& belief);

  const MirrorErrors& errors() const { return errors_; }
  Eigen::Matrix<double, kMirrorErrors, kMirrorErrors> covariance() const {
    return P_.bottomRightCorner<kMirrorErrors, kMirrorErrors>();
  }
  /// What is to be added to the covariance of a pose from the last scan.
  const Eigen::Matrix3d& widening() const { return widening_; }

 private:
  static constexpr int kStates = 3 + kMirrorErrors;
  using State = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;
  /// A point beside its line.
  struct Row {
    State h;  ///< ∂offset/∂(pose, errors)
    double offset_m;
    double own_variance;       ///< of the point's offset
    double variance;           ///< with what is not known of the errors
    double believed_variance;  ///< and of the pose: of the offset as predicted
  };
  std::vector<Row> rows_of(const CorrectedScan& scan, const Pose2& pose,
                           const MirrorErrors& further) const;
  Eigen::Matrix<double, 3, kMirrorErrors> sensitivity(const std::vector<Row>& rows) const;
  void place(const Belief& belief, const Eigen::Matrix<double, 3, kMirrorErrors>& dpose_derrors);
  bool elsewhere(const Belief& belief) const;

  const FieldModel* model_;
  MirrorErrorParams params_;
  OdometryNoise odometry_;
  bool placed_ = false;
  Pose2 pose_;
  MirrorErrors errors_ = MirrorErrors::Zero();
  Covariance P_ = Covariance::Zero();
  Eigen::Matrix3d widening_ = Eigen::Matrix3d::Zero();
};

}  // namespace vigia::localization
