#include "robot_parts.hpp"

#include <gtest/gtest.h>

#include "vigia/mission/setup.hpp"

namespace vigia::mission {
namespace {

class RobotPartsTest : public ::testing::Test {
 protected:
  Camera fixed(CameraId id) const {
    Camera camera;
    camera.id = id;
    camera.mount = FixedMount{};
    camera.optics = CameraModel(setup_.robot.zoom().at(8.0));
    return camera;
  }
  Camera on_the_head(CameraId id) const {
    Camera camera = setup_.robot.rig().cameras.front();
    camera.id = id;
    return camera;
  }

  MissionSetup setup_ =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml");
  std::vector<Listener*> listeners_;
  EventLog log_{listeners_};
  Readings readings_;
};

TEST_F(RobotPartsTest, WithoutAHeadNothingIsAttendedToAndALostRobotWaits) {
  const Rig rig{{fixed(0), fixed(1)}};
  const auto attention = make_attention(setup_, rig, 1, log_);
  EXPECT_FALSE(attention->request().has_value());
  EXPECT_FALSE(attention->tick(readings_, {}, 0).has_value());
  EXPECT_FALSE(attention->plan(readings_, {}, 0.0, 1).stop);
  const auto feeds = make_feeds(setup_, rig, {}, {});
  ASSERT_EQ(feeds.size(), 2U);
  const RecoveryStep step = make_recovery(setup_, rig, feeds, log_)->begin(readings_);
  EXPECT_EQ(step.status, RecoveryStatus::searching);
  EXPECT_FALSE(step.new_look);
}

TEST_F(RobotPartsTest, WithOneTheFirstCameraOnItIsAttendedToAndALostRobotLooksAround) {
  const Rig rig{{fixed(0), on_the_head(3)}};
  const auto attention = make_attention(setup_, rig, 1, log_);
  EXPECT_TRUE(attention->tick(readings_, {}, 0).has_value());
  const auto feeds = make_feeds(setup_, rig, {}, {});
  ASSERT_EQ(feeds.size(), 2U);
  EXPECT_EQ(feeds.back().id(), 3);
  EXPECT_TRUE(make_recovery(setup_, rig, feeds, log_)->begin(readings_).new_look);
}

TEST_F(RobotPartsTest, OnlyADirectedEyeWaitsToBeAsked) {
  sim::Simulator simulator(setup_.robot, setup_.world, setup_.appearance, Pose2{1.0, 3.2, 0.0}, 1);
  simulator.advance(Duration{40'000'000});
  const auto frame = simulator.expose();
  Shot shot;
  shot.stamp = simulator.robot().truth().stamp;
  shot.model = setup_.robot.zoom().at(8.0);
  const auto feeds = make_feeds(setup_, Rig{{fixed(0), on_the_head(1)}}, {}, {});
  EXPECT_FALSE(feeds.front().eye().observe({*frame, shot}, {}, std::nullopt).empty());
  EXPECT_TRUE(feeds.back().eye().observe({*frame, shot}, {}, std::nullopt).empty());
}

}  // namespace
}  // namespace vigia::mission
