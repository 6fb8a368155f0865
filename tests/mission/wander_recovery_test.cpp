#include "wander_recovery.hpp"

#include <gtest/gtest.h>

namespace vigia::mission {
namespace {

/// A base of 0.2 m that goes 0.5 m/s, in a hall of 20 × 20 m.
class WanderRecoveryTest : public ::testing::Test, private Listener {
 protected:
  WanderRecoveryTest() { readings_.dt = Duration::from_seconds(setup_.tick_s); }

  RecoveryStep step() {
    const std::function<RangeScan()> scan = [this] { return scan_; };
    return recovery_.step({readings_, belief_, {}, scan});
  }
  /// The robot is @p hypotheses' first, and they move with it.
  void be(BeliefStatus status, std::vector<Pose2> hypotheses = {}) {
    belief_.status = status;
    belief_.hypotheses.clear();
    for (const Pose2& pose : hypotheses)
      belief_.hypotheses.push_back(
          {pose, Eigen::Matrix3d::Zero(), 1.0 / static_cast<double>(hypotheses.size())});
    if (!hypotheses.empty()) belief_.pose = hypotheses.front();
  }
  void drive(double seconds) {
    for (double t = 0.0; t < seconds; t += setup_.tick_s) {
      const RecoveryStep step = this->step();
      ASSERT_EQ(step.status, RecoveryStatus::searching);
      move(step.commands.base);
    }
  }
  void move(const BaseRates& rates) {
    readings_.now = readings_.now + readings_.dt;
    readings_.odometry.rot1 = rates.w * setup_.tick_s;
    readings_.odometry.trans = rates.v * setup_.tick_s;
    driven_m_ += readings_.odometry.trans;
    const Pose2 by{readings_.odometry.trans, 0.0, readings_.odometry.rot1};
    for (PoseHypothesis& hypothesis : belief_.hypotheses) {
      hypothesis.pose = compose(hypothesis.pose, by);
      nearest_m_ =
          std::min(nearest_m_, setup_.world.plan.clearance(hypothesis.pose.position()) - radius_m_);
    }
  }
  void on_event(const Event& event) override { events_.push_back(event.kind); }

  MissionSetup setup_ =
      load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/ceiling-hall.yaml",
                   {"world.room={width_m: 20, depth_m: 20, height_m: 2.7}",
                    "world.ceiling={min_m: [1, 1], max_m: [19, 19]}", "start.position_m=[5, 5]",
                    "route={goal_m: [15, 15]}"});
  double radius_m_ = setup_.robot.robot.radius_m;
  std::vector<Listener*> listeners_{this};
  EventLog log_{listeners_};
  WanderRecovery recovery_{setup_, log_};
  Readings readings_;
  RangeScan scan_;
  Belief belief_;
  double driven_m_ = 0.0;
  double nearest_m_ = 100.0;
  std::vector<EventKind> events_;
};

TEST_F(WanderRecoveryTest, StandsStillWhileTheLocalizerIsLost) {
  be(BeliefStatus::lost);
  EXPECT_TRUE(recovery_.asked(belief_));
  const RecoveryStep waiting = step();
  EXPECT_EQ(waiting.status, RecoveryStatus::searching);
  EXPECT_EQ(waiting.commands.base.v, 0.0);
  EXPECT_EQ(waiting.commands.base.w, 0.0);
  EXPECT_FALSE(waiting.new_look);
}

TEST_F(WanderRecoveryTest, EndsWithTheLocalizersOwnPoseOnceItTracks) {
  be(BeliefStatus::tracking);
  EXPECT_FALSE(recovery_.asked(belief_));
  const RecoveryStep found = step();
  EXPECT_EQ(found.status, RecoveryStatus::found);
  EXPECT_FALSE(found.pose.has_value());
}

TEST_F(WanderRecoveryTest, IsAskedForWhereOneOfThePlacesLeavesNoRoomToStop) {
  be(BeliefStatus::ambiguous, {{10.0, 10.0, 0.0}, {5.0, 10.0, 0.0}});
  EXPECT_FALSE(recovery_.asked(belief_));
  be(BeliefStatus::ambiguous, {{10.0, 10.0, 0.0}, {19.5, 10.0, 0.0}});
  EXPECT_TRUE(recovery_.asked(belief_));
  belief_.hypotheses[0].weight = 0.995;
  belief_.hypotheses[1].weight = 0.005;
  EXPECT_FALSE(recovery_.asked(belief_));
}

TEST_F(WanderRecoveryTest, GoesOnAndOnAndTouchesNothingFromAnyOfThePlaces) {
  be(BeliefStatus::ambiguous,
     {{10.0, 10.0, 0.3}, {18.0, 10.0, 0.3}, {10.0, 2.0, 0.3}, {3.0, 17.0, 0.3}});
  recovery_.begin(readings_);
  drive(100.0);
  EXPECT_GT(nearest_m_, 0.1);
  EXPECT_GT(driven_m_, 20.0);
}

TEST_F(WanderRecoveryTest, StopsBeforeWhatTheRingHasMet) {
  be(BeliefStatus::ambiguous, {{10.0, 10.0, 0.0}});
  scan_.readings = {{0.0, 0.36, true}, {kPi, 0.36, true}};
  recovery_.begin(readings_);
  EXPECT_EQ(step().commands.base.v, 0.0);
  EXPECT_NE(step().commands.base.w, 0.0);
}

TEST_F(WanderRecoveryTest, WhereItIsHemmedInItStands) {
  be(BeliefStatus::ambiguous,
     {{0.3, 10.0, 0.0}, {19.7, 10.0, 0.0}, {10.0, 0.3, 0.0}, {10.0, 19.7, 0.0}});
  recovery_.begin(readings_);
  const RecoveryStep stands = step();
  EXPECT_EQ(stands.commands.base.v, 0.0);
  EXPECT_EQ(stands.commands.base.w, 0.0);
}

TEST_F(WanderRecoveryTest, GivesUpAfterItsTime) {
  be(BeliefStatus::ambiguous, {{10.0, 10.0, 0.0}, {10.0, 9.0, 0.0}});
  recovery_.begin(readings_);
  drive(setup_.recovery.wander_s - 0.5);
  readings_.now = readings_.now + Duration::from_seconds(1.0);
  EXPECT_EQ(step().status, RecoveryStatus::gave_up);
  ASSERT_EQ(events_.size(), 1U);
  EXPECT_EQ(events_.front(), EventKind::still_lost);
}

}  // namespace
}  // namespace vigia::mission
