#include "vigia/evaluation/drive_bound.hpp"

#include "evaluation/filter_on_truth.hpp"
#include "localization/drive.hpp"

#include <deque>

#include <gtest/gtest.h>

#include "vigia/localization/ceiling_localizer.hpp"

namespace vigia::evaluation {
namespace {

using localization::test::Drive;
using localization::test::DriveStep;

constexpr Duration kDelay{200'000'000};  // five ticks

/// An image on its way.
struct LateImage {
  Observation observation;
  mission::ExposureTruth truth;
};

/// What a disc's image exactly is.
EllipseObservation exact_image(const Landmark& landmark, const Drive& drive,
                               const DriveStep& step) {
  RandomStream unused(1, "unused");
  const Shot shot = localization::test::aimed_shot(landmark, drive.geometry, step.pose, {},
                                                   step.seen->shot.look, step.seen->shot.stamp);
  EllipseObservation seen =
      localization::test::observe(landmark, shot, drive.geometry, step.pose, {}, 0.0, 0.0, unused);
  seen.covariance = step.seen->covariance;
  return seen;
}

EstimatorSetup setup_of(const Drive& drive, Duration longest_delay) {
  EstimatorSetup setup{localization::test::room_landmarks(),
                       {head_rig(drive.geometry), {}},
                       drive.noise.odometry,
                       drive.noise.sensor,
                       drive.prior.covariance};
  setup.longest_delay = longest_delay;
  return setup;
}

TEST(DriveBound, OfLateImagesIsTheCovarianceOfAFilterThatSitsOnTheTruth) {
  const Drive drive = localization::test::simulate_drive({}, 1);
  const LandmarkMap map = localization::test::room_landmarks();
  const auto ekf = test::filter_on_truth(drive);
  DriveBound bound(setup_of(drive, kDelay));
  std::deque<LateImage> on_the_way;
  Pose2 before = drive.start;
  int fused = 0;
  for (const DriveStep& step : drive.steps) {
    ekf->predict(step.truth);
    bound.move(before, step.truth);
    before = step.pose;
    if (step.seen)
      on_the_way.push_back({exact_image(*map.find(*step.seen->expected), drive, step),
                            {step.seen->shot.stamp, step.pose, {}}});
    while (!on_the_way.empty() && on_the_way.front().truth.stamp + kDelay <= step.truth.to) {
      const LateImage& late = on_the_way.front();
      ASSERT_EQ(ekf->update(late.observation).status, localization::UpdateStatus::fused);
      bound.learn(late.observation, late.truth);
      on_the_way.pop_front();
      ++fused;
    }
    ASSERT_TRUE(ekf->belief().covariance.isApprox(bound.covariance(), 1e-5))
        << "at " << step.truth.to.seconds() << " s, after " << fused << " images";
  }
  EXPECT_GT(fused, 300);
}

TEST(DriveBound, ALateImageTeachesNothingBeforeItIsDeliveredAndWhatItWouldHaveFromThenOn) {
  const Drive drive = localization::test::simulate_drive({}, 1);
  const LandmarkMap map = localization::test::room_landmarks();
  DriveBound blind(setup_of(drive, kDelay));
  DriveBound late(setup_of(drive, kDelay));
  DriveBound punctual(setup_of(drive, {}));
  Pose2 before = drive.start;
  for (std::size_t i = 0; i < 6; ++i) {
    const DriveStep& step = drive.steps[i];
    for (DriveBound* bound : {&blind, &late, &punctual}) bound->move(before, step.truth);
    before = step.pose;
    if (i == 0)
      punctual.learn(exact_image(*map.find(*step.seen->expected), drive, step),
                     {step.seen->shot.stamp, step.pose, {}});
    ASSERT_EQ(late.covariance(), blind.covariance());
  }
  const DriveStep& first = drive.steps.front();
  late.learn(exact_image(*map.find(*first.seen->expected), drive, first),
             {first.seen->shot.stamp, first.pose, {}});
  EXPECT_LT(late.covariance().trace(), 0.9 * blind.covariance().trace());
  EXPECT_EQ(late.covariance(), punctual.covariance());
}

TEST(DriveBound, AFlowThatComesLateMovesOnWhatWasSeenMeanwhile) {
  // Patches at 0.2 s that come at once, and the flow from 0.2 to 0.4 s, late by 0.2 s.
  EstimatorSetup setup;
  setup.odometry = {0.05, 0.05, 0.05};
  setup.prior_covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  setup.ceiling.emplace();
  setup.ceiling->flow = true;
  setup.ceiling->params.max_speed_mps = 1.0;
  const auto drive = [&](Duration longest_delay, bool late) {
    EstimatorSetup of = setup;
    of.longest_delay = longest_delay;
    DriveBound bound(of);
    FlowObservation flow;
    flow.from = Stamp::from_seconds(0.2);
    flow.shot.stamp = Stamp::from_seconds(0.4);
    flow.shift.covariance = 1e-8 * Eigen::Matrix3d::Identity();
    for (int i = 0; i < 15; ++i) {
      const Stamp from = Stamp::from_seconds(0.04 * i);
      const Stamp to = Stamp::from_seconds(0.04 * (i + 1));
      bound.move({0.012 * i, 0.0, 0.0}, arc_increment(0.3, 0.0, from, to));
      if (to == Stamp::from_seconds(late ? 0.6 : 0.4)) bound.learn(flow, {flow.shot.stamp, {}, {}});
    }
    return bound.covariance();
  };
  const Eigen::Matrix3d late = drive(kDelay, true);
  EXPECT_TRUE(late.isApprox(drive({}, false), 1e-12));
}

}  // namespace
}  // namespace vigia::evaluation
