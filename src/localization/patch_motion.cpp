#include "vigia/localization/patch_motion.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "vigia/core/angle.hpp"
#include "vigia/core/pose.hpp"

namespace vigia::localization {
namespace {

// Of a patch's image in two frames beside what it states: the texture beside it moves through the
// pixels.
constexpr double kImageSlack_m = 0.001;
constexpr double kImageSlackTurn = from_deg(0.3);
constexpr double kRestSlack_m = 0.02;
constexpr double kRestSlackTurn = from_deg(4.0);

double turn_between(double a, double b) {
  const double off = std::abs(wrap_angle(a - b));
  return std::min(off, kPi - off);  // which end is forward may be read otherwise
}

/// Where a robot's step leaves a patch, in the robot's frame.
Eigen::Vector2d left_behind(const Pose2& step, const Eigen::Vector2d& q) {
  return Eigen::Rotation2Dd(-step.theta) * (q - step.position());
}

bool is_led_there(const PatchOnCeiling& before, const PatchOnCeiling& now, const FlowMotion& flow,
                  double gate) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(-flow.step.theta).toRotationMatrix();
  const Eigen::Vector2d expected = left_behind(flow.step, before.q);
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  J.topLeftCorner<2, 2>() = -R;
  J.block<2, 1>(0, 2) = Eigen::Vector2d(expected.y(), -expected.x());
  J(2, 2) = -1.0;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = R;
  Eigen::Matrix3d S = now.covariance + turn * before.covariance * turn.transpose() +
                      J * flow.covariance * J.transpose();
  S.diagonal().head<2>().array() += kImageSlack_m * kImageSlack_m;
  S(2, 2) += kImageSlackTurn * kImageSlackTurn;
  Eigen::Vector3d off;
  off << now.q - expected, turn_between(now.psi, before.psi - flow.step.theta);
  return off.dot(S.ldlt().solve(off)) <= gate;
}

bool may_be_the_same(const PatchOnCeiling& before, const PatchOnCeiling& now, double reach_m,
                     double reach) {
  const double off = (now.q - before.q).norm();
  return off <= reach_m + reach * before.q.norm() + kRestSlack_m &&
         turn_between(now.psi, before.psi) <= reach + kRestSlackTurn;
}

}  // namespace

FlowVerdict judge_flow(const std::vector<PatchOnCeiling>& before,
                       const std::vector<PatchOnCeiling>& now, const FlowMotion& flow,
                       double reach_m, double reach, double gate) {
  int with = 0;
  int against = 0;
  for (const PatchOnCeiling& was : before) {
    bool led = false;
    bool elsewhere = false;
    for (const PatchOnCeiling& is : now) {
      led = led || is_led_there(was, is, flow, gate);
      elsewhere = elsewhere || may_be_the_same(was, is, reach_m, reach);
    }
    with += led ? 1 : 0;
    against += !led && elsewhere ? 1 : 0;
  }
  if (with == 0 && against == 0) return FlowVerdict::silent;
  return with >= against ? FlowVerdict::agrees : FlowVerdict::contradicts;
}

}  // namespace vigia::localization
