#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/actuation.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia {

/// A displacement as the wheels report it: turn by rot1, go trans, turn by rot2 (Armingol §5.1,
/// u(k) = (T, ΔΘ1, ΔΘ2)). Metres and radians.
struct OdometryIncrement {
  Stamp from;
  Stamp to;
  double rot1 = 0.0;
  double trans = 0.0;
  double rot2 = 0.0;
  /// The part of rot1 that is no turn: an omnidirectional base goes in a direction that it does not
  /// face, and rot2 takes it back. Of a unicycle 0. It counts for the errors alone.
  double crab = 0.0;
  /// Of (rot1, trans, rot2), where something else than the wheels' noise model says it.
  std::optional<Eigen::Matrix3d> covariance = std::nullopt;
};

/// Random-walk error of odometry: variances that grow with the distance driven and the angle
/// turned, so that splitting an increment changes nothing.
struct OdometryNoise {
  double trans_per_sqrt_m = 0.01;  ///< m per √m driven, along the path
  double rot_per_sqrt_m = 0.005;   ///< rad per √m driven
  double rot_per_sqrt_rad = 0.01;  ///< rad per √rad turned
};

/// Covariance Σ of (rot1, trans, rot2): the increment's own, or by the wheels' noise, the turn's
/// error split evenly between rot1 and rot2.
Eigen::Matrix3d control_covariance(const OdometryIncrement& u, const OdometryNoise& noise);

/// Armingol eq. 6, corrected: translation along Θ + ΔΘ1.
Pose2 move(const Pose2& pose, const OdometryIncrement& u);
/// ∂move/∂pose.
Eigen::Matrix3d move_jacobian_pose(const Pose2& pose, const OdometryIncrement& u);
/// ∂move/∂(rot1, trans, rot2).
Eigen::Matrix3d move_jacobian_control(const Pose2& pose, const OdometryIncrement& u);

/// The increment between two poses, @p turned the angle turned meanwhile (not wrapped): trans is
/// the chord, negative when it was driven backwards.
OdometryIncrement chord_increment(const Pose2& before, const Pose2& after, double turned,
                                  Stamp from, Stamp to);

/// The same of an omnidirectional base: trans is the chord, crab its direction against the heading
/// in the middle of the turn.
OdometryIncrement crab_increment(const Pose2& before, const Pose2& after, double turned, Stamp from,
                                 Stamp to);

/// The increment of a base that ran at constant speed v (m/s) and turn rate w (rad/s): an arc,
/// whose chord is trans.
OdometryIncrement arc_increment(double v, double w, Stamp from, Stamp to);
/// The same of a base that may run sideways as well.
OdometryIncrement arc_increment(const BaseRates& rates, Stamp from, Stamp to);

/// The rates at which a base that runs on a straight line while it turns makes the increment.
BaseRates mean_rates(const OdometryIncrement& u);

}  // namespace vigia
