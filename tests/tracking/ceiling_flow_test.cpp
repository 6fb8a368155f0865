#include "tracking/ceiling_scene.hpp"

#include <gtest/gtest.h>

#include "vigia/tracking/edge_flow.hpp"
#include "vigia/tracking/plane_flow.hpp"

namespace vigia::tracking {
namespace {

vpImage<unsigned char> picture(const CeilingScene& scene, const Pose2& pose, std::int64_t number) {
  return imaging::grey_image(*scene.expose(pose, number));
}

TEST(EdgeFlow, FindsTurnAndShiftToAPixelOfTheWindow) {
  const CeilingScene scene({}, 1.0);
  EdgeFlowParams params;
  params.max_shift_px = 4;
  params.max_turn = from_deg(0.6);
  params.turn_step = from_deg(0.2);
  const EdgeImage before = find_edges(picture(scene, {0.3, 0.2, 0.0}, 1), params);
  // Three pixels ahead, two to the left, a turn of 0.4°.
  const double pixel = 2.2 / scene.camera.px;
  const EdgeImage after =
      find_edges(picture(scene, {0.3 + 3 * pixel, 0.2 + 2 * pixel, from_deg(0.4)}, 2), params);
  const EdgeMatch match = match_edges(before, after, params);
  EXPECT_NEAR(match.shift_px.x(), -3.0, 1.0);
  EXPECT_NEAR(match.shift_px.y(), -2.0, 1.0);
  EXPECT_NEAR(to_deg(match.turn), -0.4, 0.21);
  EXPECT_LT(match.lost_share, 0.03);
  EXPECT_GT(match.matched, static_cast<int>(before.array.size()) / 3);
}

TEST(PlaneFlow, FollowsADriveToAThousandthOfItsLength) {
  const CeilingScene scene({}, 1.0);
  PlaneFlow flow(scene.camera, Eigen::Matrix3d::Identity());
  Pose2 key{0.0, 0.0, 0.4};
  Pose2 estimate = key;
  int keys = 0;
  constexpr int kSteps = 60;
  Pose2 robot = key;
  for (int i = 0; i <= kSteps; ++i) {
    robot = {0.025 * i, 0.0, 0.4 + 0.005 * i};
    const PlaneFlowResult result = flow.next(picture(scene, robot, i));
    ASSERT_NE(result.status, FlowStatus::failed) << i;
    const ImageShift& since = result.since_key;
    estimate = compose(key, {2.2 * since.shift.x(), 2.2 * since.shift.y(), since.turn});
    if (!result.new_key) continue;
    ++keys;
    key = i == 0 ? robot : estimate;
  }
  EXPECT_GE(keys, 2);
  EXPECT_LT((estimate.position() - robot.position()).norm(), 0.0015);
  EXPECT_LT(std::abs(wrap_angle(estimate.theta - robot.theta)), 0.002);
}

TEST(PlaneFlow, RecoversFromAJumpThatNothingForetold) {
  const CeilingScene scene({}, 1.0);
  PlaneFlow flow(scene.camera, Eigen::Matrix3d::Identity());
  flow.next(picture(scene, {0.0, 0.0, 0.0}, 1));
  const PlaneFlowResult result = flow.next(picture(scene, {0.06, -0.04, 0.0}, 2));
  ASSERT_EQ(result.status, FlowStatus::matched);
  EXPECT_NEAR(2.2 * result.since_key.shift.x(), 0.06, 0.001);
  EXPECT_NEAR(2.2 * result.since_key.shift.y(), -0.04, 0.001);
}

TEST(PlaneFlow, SaysThatAPlainCeilingTellsNothing) {
  sim::CeilingTruth none;
  none.missing = 1.0;
  const CeilingScene scene(none, 0.0);
  PlaneFlow flow(scene.camera, Eigen::Matrix3d::Identity());
  flow.next(picture(scene, {0.0, 0.0, 0.0}, 1));
  EXPECT_EQ(flow.next(picture(scene, {0.01, 0.0, 0.0}, 2)).status, FlowStatus::failed);
}

}  // namespace
}  // namespace vigia::tracking
