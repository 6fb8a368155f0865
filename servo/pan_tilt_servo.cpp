#include "vigia/servo/pan_tilt_servo.hpp"

#include <Eigen/Dense>
#include <visp3/visual_features/vpFeaturePoint.h>
#include <visp3/vs/vpServo.h>

namespace vigia::servo {
namespace {

using Jacobian = Eigen::Matrix<double, 6, 2>;

vpMatrix to_visp(const Jacobian& jacobian) {
  vpMatrix result(6, 2);
  for (unsigned row = 0; row < 6; ++row)
    for (unsigned col = 0; col < 2; ++col) result[row][col] = jacobian(row, col);
  return result;
}

Eigen::Matrix<double, 2, 6> interaction(const Eigen::Vector3d& p_c) {
  vpFeaturePoint point;
  point.buildFrom(p_c.x() / p_c.z(), p_c.y() / p_c.z(), p_c.z());
  const vpMatrix L = point.interaction();
  return Eigen::Map<const Eigen::Matrix<double, 2, 6, Eigen::RowMajor>>(L.data);
}

/// The twist of a camera, in its own frame, that the base carries along.
BaseTwist carried(const Eigen::Isometry3d& rMc, const BaseTwist& of_base) {
  const Eigen::Vector3d turn = of_base.tail<3>();
  BaseTwist twist;
  twist << rMc.linear().transpose() * (of_base.head<3>() + turn.cross(rMc.translation())),
      rMc.linear().transpose() * turn;
  return twist;
}

}  // namespace

PanTiltServo::PanTiltServo(HeadGeometry geometry, PanTiltServoParams params)
    : geometry_(std::move(geometry)), params_(params) {}

HeadAngles PanTiltServo::rates(const Intrinsics& intrinsics, const Eigen::Vector2d& uv,
                               double depth_m, const HeadAngles& head, const BaseRates& base,
                               const BaseTwist& rolling) const {
  const Eigen::Vector2d xy = unproject(intrinsics, uv);
  vpFeaturePoint s;
  s.buildFrom(xy.x(), xy.y(), depth_m);
  vpFeaturePoint sd;
  sd.buildFrom(0.0, 0.0, depth_m);

  vpServo task;
  task.setServo(vpServo::EYEINHAND_L_cVe_eJe);
  task.setInteractionMatrixType(vpServo::CURRENT, vpServo::PSEUDO_INVERSE);
  task.setLambda(params_.gain);
  task.set_cVe(vpVelocityTwistMatrix());
  task.set_eJe(to_visp(camera_jacobian_head(geometry_, head)));
  task.addFeature(s, sd);
  const vpColVector q_dot = task.computeControlLaw();

  HeadAngles result{q_dot[0], q_dot[1]};
  if (params_.feed_forward) {
    const HeadAngles forward =
        compensation({depth_m * xy.x(), depth_m * xy.y(), depth_m}, head, base, rolling);
    result.pan += forward.pan;
    result.tilt += forward.tilt;
  }
  return result;
}

HeadAngles PanTiltServo::compensation(const Eigen::Vector3d& p_c, const HeadAngles& head,
                                      const BaseRates& base, const BaseTwist& rolling) const {
  const HeadAngles now = compensation_now(p_c, head, base, rolling);
  // Held over a tick, the rate must be the mean of the interval: to second order that of its
  // middle.
  const double half = 0.5 * params_.hold_s;
  Eigen::Matrix<double, 6, 1> twist =
      camera_jacobian_base(geometry_, head) * Eigen::Vector2d(base.v, base.w) +
      camera_jacobian_head(geometry_, head) * Eigen::Vector2d(now.pan, now.tilt);
  if (base.vy != 0.0) twist += base.vy * camera_twist_sideways(camera_in_base(geometry_, head));
  if (!rolling.isZero(0.0)) twist += carried(camera_in_base(geometry_, head), rolling);
  const Eigen::Vector3d velocity = twist.head<3>();
  const Eigen::Vector3d omega = twist.tail<3>();
  const Eigen::Vector3d p_c_middle = p_c - half * (velocity + omega.cross(p_c));
  if (p_c_middle.z() <= 0.0) return now;
  return compensation_now(p_c_middle, {head.pan + half * now.pan, head.tilt + half * now.tilt},
                          base, rolling);
}

HeadAngles PanTiltServo::compensation_now(const Eigen::Vector3d& p_c, const HeadAngles& head,
                                          const BaseRates& base, const BaseTwist& rolling) const {
  // q̇ = −(L·J_head)⁺ L·J_base (v, ω)ᵀ
  const Eigen::Matrix<double, 2, 6> L = interaction(p_c);
  const Eigen::Matrix2d task = L * camera_jacobian_head(geometry_, head);
  Eigen::Vector2d drift =
      L * camera_jacobian_base(geometry_, head) * Eigen::Vector2d(base.v, base.w);
  if (base.vy != 0.0) drift += base.vy * L * camera_twist_sideways(camera_in_base(geometry_, head));
  if (!rolling.isZero(0.0)) drift += L * carried(camera_in_base(geometry_, head), rolling);
  const Eigen::Vector2d q_dot = -task.completeOrthogonalDecomposition().solve(drift);
  return {q_dot.x(), q_dot.y()};
}

}  // namespace vigia::servo
