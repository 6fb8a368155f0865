#include "vigia/perception/ceiling_follower.hpp"

#include <cmath>

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

/// Patches of a perfect grid as a level camera sees them, without a picture.
class ToldCeiling : public FollowedCeiling {
 protected:
  PatchImage patch_at(const Eigen::Vector2d& q, double psi) const {
    PatchImage patch;
    const double px_per_m = view_.camera.px / view_.rise_m;
    patch.uv = Eigen::Vector2d(view_.camera.u0, view_.camera.v0) + px_per_m * q;
    patch.angle = psi;
    patch.covariance = Eigen::Vector3d(4e-4, 4e-4, 1e-6).asDiagonal();
    patch.forward_log_odds = 20.0;
    return patch;
  }
  CeilingFollower::Sight sight_from(const Pose2& pose, double time_s) const {
    CeilingFollower::Sight sight;
    sight.stamp = Stamp::from_seconds(time_s);
    for (int i = -9; i <= 9; ++i) {
      for (int j = -9; j <= 9; ++j) {
        const Eigen::Vector2d q =
            Eigen::Rotation2Dd(-pose.theta) * (Eigen::Vector2d(i, j) - pose.position());
        if (std::abs(q.x()) < 1.1 && std::abs(q.y()) < 0.8)
          sight.scan.patches.push_back(patch_at(q, wrap_angle(-pose.theta)));
      }
    }
    return sight;
  }
  static ImageShift shift_by(const Eigen::Vector2d& metres) {
    ImageShift shift;
    shift.shift = metres / 2.2;
    shift.covariance = Eigen::Vector3d(1e-8, 1e-8, 1e-8).asDiagonal();
    return shift;
  }
};

TEST_F(ToldCeiling, APatchThatIsNoneOfTheGridsDoesNotLayTheGrid) {
  CeilingFollower follower(view_);
  const Pose2 pose{0.3, 0.2, 0.1};
  CeilingFollower::Sight sight = sight_from(pose, 0.0);
  sight.scan.patches.push_back(patch_at({0.05, 0.02}, 2.0));
  follower.follow(sight);
  ASSERT_TRUE(follower.belief());
  const Pose2 found = follower.belief()->pose;
  EXPECT_LT(std::abs(wrap_angle(found.theta - pose.theta)), 0.01);
  const Eigen::Vector2d off = found.position() - pose.position();
  EXPECT_LT((off - Eigen::Vector2d(std::round(off.x()), std::round(off.y()))).norm(), 0.005);
}

TEST_F(ToldCeiling, PatchesAreBelievedAgainstAFlowThatFollowsAShadow) {
  CeilingFollower follower(view_);
  Pose2 pose{0.0, 0.0, 0.0};
  for (int i = 0; i < 20; ++i) {
    CeilingFollower::Sight sight = sight_from(pose, 0.125 * i);
    if (i > 0) sight.motion = shift_by({0.02, i > 5 ? 0.08 : 0.0});
    const auto step = follower.follow(sight);
    EXPECT_EQ(step.update, localization::CeilingUpdate::fused) << i;
    EXPECT_LT((follower.belief()->pose.position() - pose.position()).norm(), 0.005) << i;
    EXPECT_EQ(follower.belief()->status, BeliefStatus::tracking) << i;
    pose = compose(pose, {0.02, 0.0, 0.0});
  }
}

TEST_F(ToldCeiling, OnePatchIsEnoughToSeeThatTheFlowFollowsAShadow) {
  CeilingFollower follower(view_);
  Pose2 pose{0.4, 0.3, 0.0};
  for (int i = 0; i < 24; ++i) {
    CeilingFollower::Sight sight = sight_from(pose, 0.125 * i);
    if (i > 4) sight.scan.patches.resize(1);
    if (i > 16) sight.scan.patches.clear();
    if (i > 0) sight.motion = shift_by({0.02, i > 6 ? 0.14 : 0.0});
    follower.follow(sight);
    const Belief belief = *follower.belief();
    const Eigen::Vector2d off = belief.pose.position() - pose.position();
    // Nothing tells the motion once the last patch is out of sight.
    EXPECT_LT(std::abs(off.y() - std::round(off.y())), i > 16 ? 0.3 : 0.02) << i;
    EXPECT_LT(std::abs(off.y()), 5.0 * std::sqrt(belief.covariance(1, 1)) + 0.005) << i;
    if (i > 21) {
      EXPECT_EQ(belief.status, BeliefStatus::ambiguous) << i;
    }
    pose = compose(pose, {0.02, 0.0, 0.0});
  }
}

TEST_F(ToldCeiling, AJumpThatTheRobotCannotMakeIsSaid) {
  for (const Eigen::Vector2d& jump : {Eigen::Vector2d(0.8, 0.3), {-0.3, 0.31}, {3.6, -2.56}}) {
    CeilingFollower follower(view_);
    Pose2 pose{0.0, 0.0, 0.0};
    for (int i = 0; i < 30; ++i) {
      follower.follow(sight_from(pose, 0.04 * i));
      if (i >= 22) {
        EXPECT_NE(follower.belief()->status, BeliefStatus::tracking) << jump << ' ' << i;
      }
      pose = compose(pose, {0.02, 0.0, 0.0});
      if (i == 19) pose = {pose.x + jump.x(), pose.y + jump.y(), 0.0};
    }
  }
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
