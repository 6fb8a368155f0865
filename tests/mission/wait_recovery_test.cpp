#include "recovery.hpp"

#include <gtest/gtest.h>

namespace vigia::mission {
namespace {

class WaitRecoveryTest : public ::testing::Test {
 protected:
  RecoveryStep step(BeliefStatus status) {
    belief_.status = status;
    const std::function<RangeScan()> scan = [] { return RangeScan{}; };
    return recovery_.step({readings_, belief_, {}, scan});
  }
  WaitRecovery recovery_;
  Readings readings_;
  Belief belief_;
};

TEST_F(WaitRecoveryTest, StandsStillAndGivesUpNothingWhileTheLocalizerDoesNotTrack) {
  for (const BeliefStatus status : {BeliefStatus::lost, BeliefStatus::ambiguous}) {
    const RecoveryStep waiting = step(status);
    EXPECT_EQ(waiting.status, RecoveryStatus::searching);
    EXPECT_EQ(waiting.commands.base.v, 0.0);
    EXPECT_EQ(waiting.commands.base.w, 0.0);
    EXPECT_FALSE(waiting.new_look);
  }
}

TEST_F(WaitRecoveryTest, EndsWithTheLocalizersOwnPoseOnceItTracks) {
  const RecoveryStep found = step(BeliefStatus::tracking);
  EXPECT_EQ(found.status, RecoveryStatus::found);
  EXPECT_FALSE(found.pose.has_value());
}

}  // namespace
}  // namespace vigia::mission
