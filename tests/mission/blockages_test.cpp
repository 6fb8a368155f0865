#include "blockages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vigia::mission {
namespace {

using ::testing::IsEmpty;

Stamp at(double seconds) {
  return Stamp::from_seconds(seconds);
}

RoundObstacle thing(double x, double y, double radius_m = 0.2) {
  return {{x, y}, radius_m};
}

TEST(Blockages, NothingBlocksBeforeAnythingWasNoted) {
  EXPECT_THAT(Blockages().recent(at(10.0)), IsEmpty());
}

TEST(Blockages, KeepWhatWasNotedInEarlierCalls) {
  Blockages blockages;
  blockages.note(at(0.0), {thing(1.0, 2.0), thing(1.2, 2.0)});
  blockages.note(at(5.0), {thing(4.0, 2.0, 0.3)});
  const auto recent = blockages.recent(at(5.0));
  // Two things of one call are never taken for one.
  ASSERT_EQ(recent.size(), 3U);
  EXPECT_EQ(recent[2].centre, Eigen::Vector2d(4.0, 2.0));
  EXPECT_EQ(recent[2].radius_m, 0.3);
}

TEST(Blockages, AThingSeenAgainWithinHalfAMetreReplacesTheOlder) {
  Blockages blockages;
  blockages.note(at(0.0), {thing(1.0, 2.0), thing(3.0, 2.0)});
  blockages.note(at(5.0), {thing(1.0, 2.49, 0.4)});
  const auto recent = blockages.recent(at(5.0));
  ASSERT_EQ(recent.size(), 2U);
  EXPECT_EQ(recent[0].centre, Eigen::Vector2d(3.0, 2.0));
  EXPECT_EQ(recent[1].centre, Eigen::Vector2d(1.0, 2.49));
  EXPECT_EQ(recent[1].radius_m, 0.4);
  blockages.note(at(6.0), {thing(1.0, 3.0)});
  EXPECT_EQ(blockages.recent(at(6.0)).size(), 3U);
}

TEST(Blockages, AreForgottenAfterAMinuteUnlessNotedAgain) {
  Blockages blockages;
  blockages.note(at(0.0), {thing(1.0, 2.0), thing(5.0, 2.0)});
  blockages.note(at(40.0), {thing(1.1, 2.0)});
  EXPECT_EQ(blockages.recent(at(60.0)).size(), 2U);
  const auto recent = blockages.recent(at(60.1));
  ASSERT_EQ(recent.size(), 1U);
  EXPECT_EQ(recent[0].centre, Eigen::Vector2d(1.1, 2.0));
  EXPECT_THAT(blockages.recent(at(100.1)), IsEmpty());
}

TEST(Blockages, SeeingNothingNewForgetsNothing) {
  Blockages blockages;
  blockages.note(at(0.0), {thing(1.0, 2.0)});
  blockages.note(at(8.0), {});
  EXPECT_EQ(blockages.recent(at(8.0)).size(), 1U);
}

}  // namespace
}  // namespace vigia::mission
