#include "vigia/perception/ceiling_follower.hpp"

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/ceiling_scene.hpp"

namespace vigia::perception {
namespace {

class FollowedCeiling : public ::testing::Test {
 protected:
  FollowedCeiling() : scene_(hall(), {}, truth(), 3) {
    view_.camera.px = view_.camera.py = 0.5 * view_.camera.width / std::tan(from_deg(30.0));
  }
  static WorldMap hall() {
    WorldMap world;
    world.plan = FloorPlan({{-50, -50}, {50, -50}, {50, 50}, {-50, 50}}, 2.7, {}, {});
    return world;
  }
  static sim::CeilingTruth truth() {
    sim::CeilingTruth ceiling;
    ceiling.missing = 0.1;
    return ceiling;
  }
  vpImage<unsigned char> picture(const Pose2& pose, int number) const {
    return imaging::grey_image(
        *scene_.expose(to_isometry(pose, 0.5), view_.camera, Stamp{number}, {}));
  }

  CeilingView view_;
  sim::CeilingScene scene_;
};

TEST_F(FollowedCeiling, ADriveOfFourMetresEndsWhereItDidBesideTheFirstPatch) {
  CeilingFollower follower(view_);
  Pose2 pose{7.2, -3.3, 2.5};
  std::optional<Pose2> offset;  // of the follower's world in the true one
  for (int i = 0; i < 60; ++i) {
    follower.next(picture(pose, i), Stamp::from_seconds(0.04 * i));
    ASSERT_TRUE(follower.belief());
    const Belief belief = *follower.belief();
    EXPECT_EQ(belief.status, BeliefStatus::tracking) << i;
    if (!offset) {
      const Eigen::Vector2d p = pose.position() - belief.pose.position();
      offset = Pose2{std::round(p.x()), std::round(p.y()), 0.0};
      EXPECT_LT((p - offset->position()).norm(), 0.005);
    }
    EXPECT_LT((offset->position() + belief.pose.position() - pose.position()).norm(), 0.005) << i;
    EXPECT_LT(std::abs(wrap_angle(belief.pose.theta - pose.theta)), from_deg(0.3)) << i;
    pose = compose(pose, {0.07, 0.0, 0.01});
  }
}

TEST_F(FollowedCeiling, AfterALongGapItIsAmbiguous) {
  CeilingFollower follower(view_);
  follower.next(picture({7.2, -3.3, 0.5}, 0), Stamp::from_seconds(0.0));
  follower.next(picture({9.2, -3.3, 0.5}, 1), Stamp::from_seconds(3.0));
  EXPECT_EQ(follower.belief()->status, BeliefStatus::ambiguous);
}

TEST_F(FollowedCeiling, TiltAndHeightAreFoundFromADriveThatTurns) {
  const localization::CeilingCameraErrors errors{from_deg(1.2), from_deg(-0.7), 0.02};
  localization::CeilingCamera known;
  known.model = view_.camera;
  known.rMc.translation().z() = 0.5;
  // The follower's rise is 2 % too small for a ceiling at 2.7 m.
  view_.rise_m = 2.2 / std::exp(errors.log_height);
  view_.tilt_sigma = from_deg(1.0);
  view_.height_sigma = 0.03;
  const Eigen::Isometry3d rMc = localization::corrected(known, errors).rMc;
  CeilingFollower follower(view_);
  Pose2 pose{7.2, -3.3, 2.5};
  for (int i = 0; i < 50; ++i) {
    const auto frame = scene_.expose(to_isometry(pose) * rMc, view_.camera, Stamp{i}, {});
    follower.next(imaging::grey_image(*frame), Stamp::from_seconds(0.04 * i));
    pose = compose(pose, {0.04, 0.0, 0.03});
  }
  const localization::CeilingCameraErrors found = follower.camera_errors();
  EXPECT_NEAR(to_deg(found.tilt_x), to_deg(errors.tilt_x), 0.02);
  EXPECT_NEAR(to_deg(found.tilt_y), to_deg(errors.tilt_y), 0.02);
  EXPECT_NEAR(found.log_height, errors.log_height, 0.003);
  EXPECT_EQ(follower.belief()->status, BeliefStatus::tracking);
}

TEST_F(FollowedCeiling, WithoutAPatchThereIsNoPose) {
  CeilingFollower follower(view_);
  vpImage<unsigned char> blank(480, 640, 180);
  const auto step = follower.next(blank, Stamp::from_seconds(0.0));
  EXPECT_TRUE(step.scan.patches.empty());
  EXPECT_FALSE(step.update);
  EXPECT_FALSE(follower.belief());
}

}  // namespace
}  // namespace vigia::perception
