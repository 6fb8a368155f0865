#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/core/field_map.hpp"
#include "vigia/core/goal_corner.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/localization/stereo_pair.hpp"

namespace vigia::localization {

struct CornerFilterParams {
  StereoPair pair;
  Intrinsics lens;  ///< of both cameras, whose distortion is taken off the columns
  /// What the calibration of the pair may miss, constant along a drive; 0 where it is exact.
  StereoErrors calibration_sigma;
  OdometryNoise odometry;
  double gate = 13.8;  ///< χ² of a corner's two columns, 0.1 % of them
  int iterations = 5;  ///< of an update's linearisation, at most
};

/// Columns of a corner on the pair's ideal images, as pinholes without distortion have them.
StereoColumns ideal_columns(const CornerFilterParams& params, const StereoCorner& corner);

/// What an update made of a pair of images.
struct CornerUpdate {
  int fused = 0;
  int gated = 0;
  double nis = 0.0;  ///< of all fused columns
};

/// Range and bearing of goals' corners by a stereo pair, jointly with the errors of its
/// calibration: an iterated extended Kalman filter on (x, y, θ, baseline, vergence, focal), the
/// recursive form of station_fix(), which lets go of what it has passed.
class CornerFilter {
 public:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  CornerFilter(const FieldMap& field, const CornerFilterParams& params);

  void reset(Stamp stamp, const Prior& prior);
  /// Begins with a pose and errors of calibration that are known together.
  void reset(Stamp stamp, const Vector6& mean, const Matrix6& covariance);
  void predict(const OdometryIncrement& increment);
  CornerUpdate update(const std::vector<StereoCorner>& corners);

  const Belief& belief() const { return belief_; }
  StereoErrors calibration() const { return {x_[3], x_[4], x_[5]}; }
  Eigen::Matrix3d calibration_covariance() const { return P_.bottomRightCorner<3, 3>(); }
  const CornerFilterParams& params() const { return params_; }

  /// For bounds: the same recursion linearised at the truth, a calibration without errors. Replaces
  /// the mean.
  void relinearise(const Pose2& pose);

 private:
  struct Rows {
    Eigen::Vector2d y;
    Eigen::Matrix<double, 2, 6> H;
  };
  std::optional<Rows> rows_at(const StereoCorner& corner, const Vector6& x) const;
  bool passes(const StereoCorner& corner) const;
  void refresh_belief(Stamp stamp);

  FieldMap field_;
  CornerFilterParams params_;
  Vector6 x_ = Vector6::Zero();
  Matrix6 P_ = Matrix6::Zero();
  Belief belief_;
};

}  // namespace vigia::localization
