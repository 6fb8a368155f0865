#include "vigia/localization/patch_motion.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/pose.hpp"

namespace vigia::localization {
namespace {

constexpr double kGate = 16.27;

PatchOnCeiling patch_at(const Eigen::Vector2d& q, double psi) {
  PatchOnCeiling patch;
  patch.q = q;
  patch.psi = psi;
  patch.covariance = Eigen::Vector3d(1e-6, 1e-6, 1e-5).asDiagonal();
  return patch;
}

PatchOnCeiling after(const Pose2& step, const PatchOnCeiling& before) {
  PatchOnCeiling patch = before;
  patch.q = Eigen::Rotation2Dd(-step.theta) * (before.q - step.position());
  patch.psi = wrap_angle(before.psi - step.theta);
  return patch;
}

FlowMotion flow_of(const Pose2& step) {
  FlowMotion flow;
  flow.step = step;
  flow.covariance = Eigen::Vector3d(1e-6, 1e-6, 1e-7).asDiagonal();
  return flow;
}

FlowVerdict verdict(const std::vector<PatchOnCeiling>& before,
                    const std::vector<PatchOnCeiling>& now, const Pose2& flow) {
  return judge_flow(before, now, flow_of(flow), 0.2, 0.4, kGate);
}

TEST(PatchMotion, PatchesMoveWithAFlowThatFollowsTheCeiling) {
  const Pose2 step{0.06, 0.01, 0.1};
  const PatchOnCeiling one = patch_at({0.4, -0.3}, 0.2);
  const PatchOnCeiling other = patch_at({-0.6, 0.2}, 0.25);
  EXPECT_EQ(verdict({one, other}, {after(step, other), after(step, one)}, step),
            FlowVerdict::agrees);
}

TEST(PatchMotion, APatchThatStaysBehindContradictsAShadow) {
  const Pose2 step{0.06, 0.0, 0.0};
  const PatchOnCeiling one = patch_at({0.4, -0.3}, 0.2);
  EXPECT_EQ(verdict({one}, {after(step, one)}, {0.06, 0.14, 0.0}), FlowVerdict::contradicts);
  EXPECT_EQ(verdict({one}, {after(step, one)}, {0.04, 0.0, 0.0}), FlowVerdict::contradicts);
}

TEST(PatchMotion, PatchesThatComeAndGoSayNothing) {
  const PatchOnCeiling one = patch_at({0.4, -0.3}, 0.2);
  EXPECT_EQ(verdict({one}, {}, {0.06, 0.0, 0.0}), FlowVerdict::silent);
  EXPECT_EQ(verdict({}, {one}, {0.06, 0.0, 0.0}), FlowVerdict::silent);
  // A metre off, or turned by half a right angle, it is another one.
  EXPECT_EQ(verdict({one}, {patch_at({-0.6, -0.3}, 0.2)}, {0.06, 0.0, 0.0}), FlowVerdict::silent);
  EXPECT_EQ(verdict({one}, {patch_at({0.4, -0.3}, 1.0)}, {0.06, 0.0, 0.0}), FlowVerdict::silent);
}

TEST(PatchMotion, MostOfThemDecide) {
  const Pose2 step{0.06, 0.0, 0.0};
  const PatchOnCeiling one = patch_at({0.4, -0.3}, 0.2);
  const PatchOnCeiling other = patch_at({-0.6, 0.2}, 0.25);
  PatchOnCeiling mistaken = after(step, patch_at({0.9, 0.4}, 0.2));
  mistaken.q.y() += 0.05;
  EXPECT_EQ(verdict({one, other, patch_at({0.9, 0.4}, 0.2)},
                    {after(step, one), after(step, other), mistaken}, step),
            FlowVerdict::agrees);
}

TEST(PatchMotion, AReadingOfTheEndsTheOtherWayRoundIsNoTurn) {
  const Pose2 step{0.06, 0.0, 0.0};
  const PatchOnCeiling one = patch_at({0.4, -0.3}, 0.2);
  PatchOnCeiling reversed = after(step, one);
  reversed.psi = wrap_angle(reversed.psi + kPi);
  EXPECT_EQ(verdict({one}, {reversed}, step), FlowVerdict::agrees);
}

}  // namespace
}  // namespace vigia::localization
