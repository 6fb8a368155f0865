#include "vigia/evaluation/loss_score.hpp"

#include <gtest/gtest.h>

namespace vigia::evaluation {
namespace {

constexpr double kTick_s = 0.1;

/// A localizer at the origin whose truth lies @p error_m beside it.
struct Story {
  LossScorer scorer;
  double now_s = 0.0;

  void run(int ticks, BeliefStatus status, double error_m, double sigma_m = 0.02,
           double probability = 0.05) {
    Belief belief;
    belief.status = status;
    belief.covariance = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
    belief.lost_probability = probability;
    for (int i = 0; i < ticks; ++i) {
      now_s += kTick_s;
      scorer.add(now_s, kTick_s, 0.03, belief, {error_m, 0.0, 0.0});
    }
  }
  LossScore score() const { return scorer.score(); }
};

TEST(LossScore, ADriveThatGoesWellHasNothingToTell) {
  Story story;
  story.run(100, BeliefStatus::tracking, 0.03);
  const LossScore score = story.score();
  EXPECT_EQ(score.false_alarms + score.misses + score.said, 0);
  EXPECT_EQ(score.right_recoveries + score.wrong_recoveries, 0);
  EXPECT_EQ(score.unsaid_s, 0.0);
  EXPECT_NEAR(score.driven_m, 3.0, 1e-9);
  EXPECT_NEAR(score.brier, 0.0025, 1e-9);
}

TEST(LossScore, SayingLostWhileTheErrorIsWithinTheClaimIsAFalseAlarmAndComingBackARightRecovery) {
  Story story;
  story.run(10, BeliefStatus::tracking, 0.03);
  story.run(10, BeliefStatus::lost, 0.03);
  story.run(10, BeliefStatus::tracking, 0.03);
  EXPECT_EQ(story.score().false_alarms, 1);
  EXPECT_NEAR(story.score().false_alarms_per_km(), 1000.0 / 0.9, 1e-6);
  EXPECT_EQ(story.score().right_recoveries, 1);
}

TEST(LossScore, SayingLostWithAClaimOfMoreThanHalfAMetreIsHonestAndNoFalseAlarm) {
  Story story;
  story.run(10, BeliefStatus::tracking, 0.03, 0.4);
  story.run(10, BeliefStatus::lost, 0.03, 0.7);
  EXPECT_EQ(story.score().false_alarms, 0);
}

TEST(LossScore, AnErrorOfFourClaimedSigmasThatIsNeverSaidIsAMiss) {
  Story story;
  story.run(10, BeliefStatus::tracking, 0.03);
  story.run(10, BeliefStatus::tracking, 0.1);
  // Still more than half of the limit: the same miss.
  story.run(10, BeliefStatus::tracking, 0.06);
  story.run(10, BeliefStatus::tracking, 0.1);
  story.run(10, BeliefStatus::tracking, 0.01);
  const LossScore score = story.score();
  EXPECT_EQ(score.misses, 1);
  EXPECT_EQ(score.misses_over_half_metre, 0);
  EXPECT_NEAR(score.unsaid_s, 2.0, 1e-9);
}

TEST(LossScore, AMissThatLastsToTheEndOfTheDriveCounts) {
  Story story;
  story.run(10, BeliefStatus::tracking, 0.8, 0.1);
  EXPECT_EQ(story.score().misses, 1);
  EXPECT_EQ(story.score().misses_over_half_metre, 1);
}

TEST(LossScore, AnErrorThatAnHonestLargeSigmaAllowsForIsNoMissAndNoWrongRecovery) {
  Story story;
  story.run(10, BeliefStatus::tracking, 0.8, 0.3);
  story.run(10, BeliefStatus::lost, 0.8, 0.3);
  story.run(10, BeliefStatus::tracking, 0.8, 0.3);
  const LossScore score = story.score();
  EXPECT_EQ(score.misses + score.said, 0);
  EXPECT_EQ(score.unsaid_s, 0.0);
  EXPECT_EQ(score.false_alarms, 0);
  EXPECT_EQ(score.right_recoveries, 1);
  EXPECT_EQ(score.wrong_recoveries, 0);
}

TEST(LossScore, OfAClaimNoMoreThanHalfAMetreIsBelieved) {
  Story story;
  story.run(10, BeliefStatus::tracking, 2.1, 3.0);
  EXPECT_EQ(story.score().misses, 1);
}

TEST(LossScore, AnAlarmIsNoFalseOneIfTheErrorPassesHalfAMetreBeforeItTracksAgain) {
  Story story;
  story.run(10, BeliefStatus::tracking, 0.03);
  story.run(10, BeliefStatus::lost, 0.03);
  story.run(10, BeliefStatus::lost, 0.6);
  story.run(10, BeliefStatus::tracking, 0.03);
  EXPECT_EQ(story.score().false_alarms, 0);
  ASSERT_EQ(story.scorer.episodes().size(), 1u);
  EXPECT_TRUE(story.scorer.episodes().front().announced());
}

TEST(LossScore, TheDelayIsFromGoingAstrayToSayingSo) {
  Story story;
  story.run(10, BeliefStatus::tracking, 0.03);
  story.run(20, BeliefStatus::tracking, 2.0);
  story.run(10, BeliefStatus::lost, 2.0);
  story.run(1, BeliefStatus::tracking, 2.0);  // found, it says, in the wrong place
  story.run(5, BeliefStatus::lost, 2.0);
  story.run(10, BeliefStatus::tracking, 0.02);
  const LossScore score = story.score();
  EXPECT_EQ(score.said, 2);
  EXPECT_EQ(score.misses, 0);
  EXPECT_EQ(score.false_alarms, 0);
  EXPECT_NEAR(score.delay_max_s, 2.0, 1e-9);
  EXPECT_NEAR(score.delay_mean_s, 1.05, 1e-9);
  EXPECT_EQ(score.wrong_recoveries, 1);
  EXPECT_EQ(score.right_recoveries, 1);
}

TEST(LossScore, ARobotThatStartsLostIsFoundWithoutHavingBeenAFalseAlarm) {
  Story story;
  story.run(10, BeliefStatus::lost, 8.0, 100.0);
  story.run(5, BeliefStatus::ambiguous, 3.0, 0.1);
  story.run(10, BeliefStatus::tracking, 0.02);
  const LossScore score = story.score();
  EXPECT_EQ(score.false_alarms + score.misses + score.said, 0);
  EXPECT_EQ(score.right_recoveries, 1);
  EXPECT_NEAR(score.ambiguous_s, 0.5, 1e-9);
}

TEST(LossScore, CalibrationCountsHowOftenAProbabilityCameTrue) {
  Story story;
  story.run(30, BeliefStatus::tracking, 0.02, 0.02, 0.12);
  story.run(10, BeliefStatus::tracking, 0.3, 0.02, 0.16);
  story.run(10, BeliefStatus::lost, 0.3, 0.02, 1.0);
  const LossScore score = story.score();
  EXPECT_EQ(score.calibration[1].ticks, 40);
  EXPECT_EQ(score.calibration[1].astray, 10);
  EXPECT_NEAR(score.calibration[1].mean_probability, 0.13, 1e-9);
  EXPECT_EQ(score.calibration[9].ticks, 10);
  EXPECT_EQ(score.calibration[9].astray, 10);
  EXPECT_NEAR(score.brier, (30 * 0.12 * 0.12 + 10 * 0.84 * 0.84) / 50.0, 1e-9);
}

TEST(LossScore, DrivesCombineAsOneLongDriveWould) {
  Story first;
  first.run(20, BeliefStatus::tracking, 2.0, 0.02, 0.3);
  first.run(10, BeliefStatus::lost, 2.0, 0.02, 0.9);
  Story second;
  second.run(10, BeliefStatus::tracking, 2.0, 0.02, 0.3);
  second.run(10, BeliefStatus::lost, 2.0, 0.02, 0.9);
  second.run(10, BeliefStatus::tracking, 0.02, 0.02, 0.1);
  const LossScore both = combined({first.score(), second.score()});
  EXPECT_EQ(both.said, 2);
  EXPECT_NEAR(both.delay_mean_s, 1.5, 1e-9);
  EXPECT_NEAR(both.delay_max_s, 2.0, 1e-9);
  EXPECT_EQ(both.calibration[3].ticks, 30);
  EXPECT_NEAR(both.calibration[3].mean_probability, 0.3, 1e-9);
  EXPECT_NEAR(both.brier, (first.score().brier + second.score().brier) / 2.0, 1e-12);
  EXPECT_NEAR(both.driven_m, 1.8, 1e-9);
}

}  // namespace
}  // namespace vigia::evaluation
