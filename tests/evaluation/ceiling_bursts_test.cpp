#include "vigia/evaluation/ceiling_bursts.hpp"

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/evaluation/ceiling_views.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/plane_flow.hpp"

namespace vigia::evaluation {
namespace {

/// The flow's steps of a drive beside the true ones.
struct FlowTally {
  int matched = 0;
  double worst_m = 0.0;
};

FlowTally follow_by_flow(std::uint64_t seed, double step_m, double turn, int frames) {
  CeilingSetting setting;
  setting.seed = setting.ceiling.seed = seed;
  setting.ceiling.spurious = 0.05;
  const CeilingHall hall(setting);
  const auto known = setting.known_camera();
  tracking::FrameFlow flow(known.model, known.rMc.linear());
  RandomStream random(seed, "x");
  Pose2 pose{random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0), random.uniform(-3.0, 3.0)};
  Pose2 before = pose;
  FlowTally tally;
  for (int i = 0; i < frames; ++i) {
    const auto step = flow.next(imaging::grey_image(*hall.expose(pose, i)));
    if (step) {
      const Pose2 seen = localization::robot_motion(known, *step);
      const Pose2 truth = compose(inverse(before), pose);
      ++tally.matched;
      tally.worst_m = std::max(tally.worst_m, (seen.position() - truth.position()).norm());
    }
    before = pose;
    pose = compose(pose, {step_m, 0.0, turn});
  }
  return tally;
}

TEST(FrameFlow, AMatchThatIsOnlyAlikeIsNotBelieved) {
  // Under this ceiling, pictures four pixels beside each other are alike enough to settle there.
  const FlowTally slow = follow_by_flow(8, 0.012, 0.004, 12);
  EXPECT_GE(slow.matched, 10);
  EXPECT_LT(slow.worst_m, 0.001);
}

TEST(FrameFlow, FollowsStepsOfFiftyPixelsThatNothingForetold) {
  // The third begins under a panel that shows hardly anything.
  int matched = 0;
  for (const std::uint64_t seed : {3, 4, 5}) {
    const FlowTally fast = follow_by_flow(seed, 0.2, 0.02, 10);
    matched += fast.matched;
    EXPECT_LT(fast.worst_m, 0.002) << seed;
  }
  EXPECT_GE(matched, 18);
}

TEST(CeilingOutage, NobodyIsSureOfAnotherCellAfterwards) {
  const auto conditions = ceiling_conditions();
  int trials = 0;
  for (std::size_t i = 0; i < conditions.size(); i += 5) {
    const CeilingOutageTrial trial = try_outage(conditions[i], {}, 5000 + i);
    ++trials;
    EXPECT_GT(trial.instants, 0);
    EXPECT_EQ(trial.wrong_unflagged, 0) << "condition " << i;
    // Less than half a pitch, also at the robot's greatest speed and before the next picture; or
    // odometry over no more than two metres.
    const CeilingCondition& own = conditions[i];
    const bool known = own.odometry ? trial.blind_m <= 2.0
                                    : 1.2 * (trial.blind_m + own.speed_mps / own.rate_hz) < 0.45;
    EXPECT_TRUE(trial.recovered || !known) << "condition " << i;
  }
  EXPECT_EQ(trials, 15);
}

TEST(CeilingKidnapping, IsSaidInThreeFramesAndThePoseInTheCellIsKnown) {
  for (const CeilingKidnapping& trial : try_kidnappings(6, {}, 7000, 1)) {
    EXPECT_LE(trial.wrong_unflagged, 2);
    EXPECT_TRUE(trial.flagged);
    EXPECT_LT(trial.in_cell_m, 0.02);
    EXPECT_LT(to_deg(trial.heading_error), 1.0);
  }
}

TEST(CeilingSettling, MappedGapsTellTheCellsApartAndAnEndlessGridNever) {
  int settled = 0;
  for (std::uint64_t seed = 8100; seed < 8106; ++seed) {
    const CeilingSettling with = try_settling(true, {}, seed);
    EXPECT_EQ(with.wrong_unflagged, 0) << seed;
    settled += with.right ? 1 : 0;
    const CeilingSettling endless = try_settling(false, {}, seed);
    EXPECT_TRUE(endless.ambiguous) << seed;
    EXPECT_FALSE(endless.settled) << seed;
  }
  EXPECT_GE(settled, 4);
}

}  // namespace
}  // namespace vigia::evaluation
