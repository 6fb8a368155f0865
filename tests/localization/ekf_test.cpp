#include "vigia/localization/ekf.hpp"

#include "localization/drive.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/localization/chi_square.hpp"
#include "vigia/localization/odometry_localizer.hpp"

namespace vigia::localization {
namespace {

using test::disc;
using test::simulate_drive;

const Pose2 kPose{4.0, 3.0, 0.2};

Prior prior_at(const Pose2& pose, double sigma_m = 0.03, double sigma_rad = from_deg(1.0)) {
  const Eigen::Vector3d sigma(sigma_m, sigma_m, sigma_rad);
  return {pose, sigma.cwiseAbs2().asDiagonal()};
}

/// An observation of @p landmark from @p truth without noise.
EllipseObservation exact(const Landmark& landmark, const Pose2& truth, LookId look = 1,
                         double seconds = 0.0) {
  RandomStream random(1, "exact");
  const Shot shot = test::aimed_shot(landmark, {}, truth, {}, look, Stamp::from_seconds(seconds));
  EllipseObservation seen = test::observe(landmark, shot, {}, truth, {}, 0.0, 0.0, random);
  seen.covariance = 1e-4 * Eigen::Matrix<double, 5, 5>::Identity();
  return seen;
}

OdometryIncrement forward(double from_s, double to_s, double v = 0.3, double w = 0.2) {
  return arc_increment(v, w, Stamp::from_seconds(from_s), Stamp::from_seconds(to_s));
}

EkfLocalizer ekf_at(const Pose2& pose, const LandmarkMap& map = test::room_landmarks(),
                    const EkfParams& params = {}, std::optional<FloorPlan> plan = std::nullopt) {
  EkfLocalizer ekf(map, {}, params, std::move(plan));
  ekf.reset({}, prior_at(pose));
  return ekf;
}

/// With wheels whose every reading tells its distance: where a mean speed stands for it, the
/// variance of an increment depends on what has been read until then.
EkfLocalizer precise_at(const Pose2& pose) {
  EkfParams params;
  params.odometry.trans_per_sqrt_m = 0.003;
  return ekf_at(pose, test::room_landmarks(), params);
}

void expect_equal(const LookState& a, const LookState& b, double tolerance) {
  EXPECT_TRUE(a.stamp == b.stamp);
  EXPECT_EQ(a.look, b.look);
  EXPECT_LT((a.mean - b.mean).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((a.covariance - b.covariance).cwiseAbs().maxCoeff(), tolerance);
}

TEST(LookState, PartsOfAnIncrementEndWhereTheWholeEnds) {
  RandomStream random(1, "parts");
  for (int i = 0; i < 100; ++i) {
    const OdometryIncrement whole{Stamp::from_seconds(1.0), Stamp::from_seconds(1.2),
                                  random.uniform(-0.5, 0.5), random.uniform(-0.3, 0.3),
                                  random.uniform(-0.5, 0.5)};
    const double f = random.uniform(0.0, 1.0);
    const Pose2 end = move(move(kPose, first_part(whole, f)), second_part(whole, f));
    EXPECT_LT(difference(end, move(kPose, whole)).norm(), 1e-12);
    EXPECT_TRUE(second_part(whole, f).to == whole.to);
    EXPECT_TRUE(first_part(whole, f).to == second_part(whole, f).from);
  }
}

TEST(LookState, ANewLookForgetsTheBiasesAndKeepsThePose) {
  const SensorNoise noise;
  LookState state = initial_state({}, prior_at(kPose), noise);
  state.mean(3) = 0.01;
  state.covariance.setConstant(1e-6);
  const LookState fresh = begin_look(state, 7, noise);
  EXPECT_EQ(fresh.look, 7);
  EXPECT_EQ(fresh.bias().pan, 0.0);
  EXPECT_TRUE(fresh.pose_covariance().isApprox(state.pose_covariance()));
  EXPECT_TRUE(fresh.covariance.topRightCorner(3, 3).isZero());
  EXPECT_TRUE(fresh.covariance.bottomRightCorner(3, 3).isApprox(look_covariance(noise)));
}

TEST(Ekf, ALookMovesTheEstimateTowardsTheTruth) {
  const LandmarkMap map = test::room_landmarks();
  EkfLocalizer ekf = ekf_at({kPose.x + 0.04, kPose.y - 0.03, kPose.theta + 0.01});
  const double before = ekf.belief().position_sigma();
  for (const LandmarkId id : {0, 4}) {
    const auto result = ekf.update(exact(*map.find(id), kPose, id + 1));
    EXPECT_EQ(result.status, UpdateStatus::fused);
    EXPECT_EQ(result.landmark, id);
    EXPECT_EQ(result.dof, 3);
  }
  EXPECT_LT(difference(ekf.belief().pose, kPose).head<2>().norm(), 0.015);
  EXPECT_LT(ekf.belief().position_sigma(), before);
  EXPECT_EQ(ekf.count(UpdateStatus::fused), 2);
}

TEST(Ekf, WithoutTheSizeADiscOfAnotherSizeTeachesTheSame) {
  const Landmark landmark = disc(1, 8.0, 4.0, 1.5, 180.0);
  EkfParams pan_tilt;
  pan_tilt.use_size = false;
  EllipseObservation seen = exact(landmark, kPose);
  EllipseObservation larger = seen;
  larger.ellipse.a *= 1.004;
  larger.ellipse.b *= 1.004;
  Belief beliefs[2];
  for (const auto* observation : {&seen, &larger}) {
    EkfLocalizer ekf(LandmarkMap({landmark}), {}, pan_tilt);
    ekf.reset({}, prior_at({4.02, 2.99, 0.21}));
    ASSERT_EQ(ekf.update(*observation).status, UpdateStatus::fused);
    beliefs[observation == &seen ? 0 : 1] = ekf.belief();
  }
  // The size's σ is a factor of e^1000: what is left of it is 1e-6 of a step.
  EXPECT_TRUE(beliefs[0].pose.vector().isApprox(beliefs[1].pose.vector(), 1e-7));
  // The range along the line of sight is not learnt.
  const Eigen::Vector2d along = (landmark.centre_w().head<2>() - kPose.position()).normalized();
  const Eigen::Matrix2d P = beliefs[0].covariance.topLeftCorner<2, 2>();
  EXPECT_GT(std::sqrt(along.dot(P * along)), 0.9 * 0.03);
}

TEST(Ekf, ManyFramesOfOneLookTeachLittleMoreThanOne) {
  const Landmark landmark = *test::room_landmarks().find(0);
  EkfLocalizer once = ekf_at(kPose);
  EkfLocalizer often = ekf_at(kPose);
  EkfLocalizer looks = ekf_at(kPose);
  once.update(exact(landmark, kPose));
  for (int i = 0; i < 50; ++i) {
    often.update(exact(landmark, kPose));
    looks.update(exact(landmark, kPose, i + 1));
  }
  const auto volume = [](const EkfLocalizer& ekf) {
    return std::sqrt(ekf.belief().covariance.determinant());
  };
  EXPECT_GT(volume(often), 0.95 * volume(once));
  EXPECT_LT(volume(looks), 0.3 * volume(once));  // three errors, each averaged over 50 draws
}

TEST(Ekf, ALateObservationGivesWhatItWouldHaveGivenInTime) {
  const Landmark landmark = *test::room_landmarks().find(4);
  const OdometryIncrement whole = forward(0.2, 0.4);
  const Pose2 at_exposure = move(move(kPose, forward(0.0, 0.2)), first_part(whole, 0.3));
  const EllipseObservation seen = exact(landmark, at_exposure, 1, 0.26);

  EkfLocalizer in_time = precise_at(kPose);
  in_time.predict(forward(0.0, 0.2));
  in_time.predict(first_part(whole, 0.3));
  EXPECT_EQ(in_time.update(seen).status, UpdateStatus::fused);
  in_time.predict(second_part(whole, 0.3));
  in_time.predict(forward(0.4, 0.6));

  EkfLocalizer late = precise_at(kPose);
  late.predict(forward(0.0, 0.2));
  late.predict(whole);
  late.predict(forward(0.4, 0.6));
  EXPECT_EQ(late.update(seen).status, UpdateStatus::fused);
  expect_equal(late.state(), in_time.state(), 1e-12);
}

TEST(Ekf, ObservationsOutOfOrderGiveWhatTheyWouldHaveGivenInOrder) {
  const LandmarkMap map = test::room_landmarks();
  const Pose2 later = move(kPose, forward(0.0, 0.2));
  const EllipseObservation first = exact(*map.find(4), kPose, 1, 0.0);
  const EllipseObservation second = exact(*map.find(0), later, 2, 0.2);

  EkfLocalizer in_order = ekf_at(kPose);
  in_order.update(first);
  in_order.predict(forward(0.0, 0.2));
  in_order.update(second);

  EkfLocalizer out_of_order = ekf_at(kPose);
  out_of_order.predict(forward(0.0, 0.2));
  out_of_order.update(second);
  EXPECT_EQ(out_of_order.update(first).status, UpdateStatus::fused);
  expect_equal(out_of_order.state(), in_order.state(), 1e-12);
}

TEST(Ekf, AnObservationAheadOfTheOdometryIsFusedAndFusedAgainWhenTheOdometryArrives) {
  const Landmark landmark = *test::room_landmarks().find(4);
  const OdometryIncrement whole = forward(0.2, 0.4, 0.25, -0.3);
  const Pose2 before = move(kPose, forward(0.0, 0.2));
  const EllipseObservation seen = exact(landmark, move(before, first_part(whole, 0.5)), 1, 0.3);

  EkfLocalizer ahead = precise_at(kPose);
  ahead.predict(forward(0.0, 0.2));
  EXPECT_EQ(ahead.update(seen).status, UpdateStatus::fused);
  EXPECT_TRUE(ahead.belief().stamp == Stamp::from_seconds(0.3));
  ahead.predict(whole);

  EkfLocalizer in_time = precise_at(kPose);
  in_time.predict(forward(0.0, 0.2));
  in_time.predict(first_part(whole, 0.5));
  in_time.update(seen);
  in_time.predict(second_part(whole, 0.5));
  expect_equal(ahead.state(), in_time.state(), 1e-12);
}

TEST(Ekf, AnObservationOlderThanTheHistoryIsTooLate) {
  EkfParams params;
  params.history_s = 0.5;
  EkfLocalizer ekf = ekf_at(kPose, test::room_landmarks(), params);
  for (int i = 0; i < 10; ++i) ekf.predict(forward(0.2 * i, 0.2 * (i + 1)));
  const LookState before = ekf.state();
  const Landmark landmark = *test::room_landmarks().find(4);
  EXPECT_EQ(ekf.update(exact(landmark, kPose, 1, 1.0)).status, UpdateStatus::too_late);
  EXPECT_EQ(ekf.count(UpdateStatus::too_late), 1);
  expect_equal(ekf.state(), before, 1e-15);
}

TEST(Ekf, TheGateRejectsADiscThatIsNoLandmark) {
  EkfLocalizer ekf = ekf_at(kPose);
  const LookState before = ekf.state();
  const auto result = ekf.update(exact(disc(9, 4.0, 7.0, 0.6, -90.0), kPose));
  EXPECT_EQ(result.status, UpdateStatus::gated);
  EXPECT_GT(result.nis, chi_square_quantile(0.999, 3));
  EXPECT_EQ(ekf.count(UpdateStatus::gated), 1);
  expect_equal(ekf.state(), before, 1e-15);
}

TEST(Ekf, AssociationPicksTheRightOfTwoDiscsWhateverWasExpected) {
  const Landmark left = disc(1, 8.0, 3.4, 1.3, 180.0);
  const Landmark right = disc(2, 8.0, 2.6, 1.3, 180.0);
  const LandmarkMap map({left, right});
  EkfLocalizer ekf = ekf_at({4.0, 3.0, 0.0}, map);
  EllipseObservation seen = exact(right, {4.0, 3.0, 0.0});
  seen.expected = 1;
  const auto result = ekf.update(seen);
  EXPECT_EQ(result.status, UpdateStatus::fused);
  EXPECT_EQ(result.landmark, 2);
}

TEST(Ekf, TwoDiscsThatExplainAnObservationEquallyWellMakeItAmbiguous) {
  const Landmark left = disc(1, 8.0, 3.02, 1.3, 180.0);
  const Landmark right = disc(2, 8.0, 2.98, 1.3, 180.0);
  EkfLocalizer ekf = ekf_at({4.0, 3.0, 0.0}, LandmarkMap({left, right}));
  const LookState before = ekf.state();
  const auto result = ekf.update(exact(right, {4.0, 3.0, 0.0}));
  EXPECT_EQ(result.status, UpdateStatus::ambiguous);
  EXPECT_EQ(ekf.count(UpdateStatus::ambiguous), 1);
  expect_equal(ekf.state(), before, 1e-15);
}

TEST(Ekf, ALandmarkBehindAWallIsNoCandidate) {
  const LandmarkMap map({disc(1, 8.0, 3.0, 1.3, 180.0)});
  const FloorPlan plan({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8,
                       {Wall{{6.0, 0.0}, {6.0, 7.0}, 2.8}, Wall{{8.0, 0.0}, {8.0, 7.0}, 2.8}}, {});
  const Pose2 pose{4.0, 3.0, 0.0};
  const EllipseObservation seen = exact(*map.find(1), pose);
  EkfLocalizer blind = ekf_at(pose, map);
  EkfLocalizer aware = ekf_at(pose, map, {}, plan);
  EXPECT_EQ(blind.update(seen).status, UpdateStatus::fused);
  EXPECT_EQ(aware.update(seen).status, UpdateStatus::gated);
}

TEST(Ekf, AnObservationWithoutAnyLandmarkInFrontIsDegenerate) {
  const LandmarkMap map({disc(1, 8.0, 3.0, 1.3, 180.0)});
  EllipseObservation seen = exact(*map.find(1), {4.0, 3.0, 0.0});
  EkfLocalizer ekf = ekf_at({4.0, 3.0, kPi}, map);
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::degenerate);
}

TEST(Ekf, NumbersThatAreNoneDoNotEnter) {
  EllipseObservation seen = exact(*test::room_landmarks().find(4), kPose);
  EkfLocalizer ekf = ekf_at(kPose);
  seen.ellipse.u = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::degenerate);
  seen = exact(*test::room_landmarks().find(4), kPose);
  seen.ellipse.b = 0.0;
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::degenerate);
  seen = exact(*test::room_landmarks().find(4), kPose);
  seen.covariance(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ekf.update(seen).status, UpdateStatus::degenerate);
  EXPECT_TRUE(ekf.state().mean.allFinite());
}

TEST(Ekf, IsLostWhileItsUncertaintyIsAboveTheLimit) {
  EkfLocalizer ekf = ekf_at(kPose);
  EXPECT_EQ(ekf.belief().status, BeliefStatus::tracking);
  ekf.reset({}, prior_at(kPose, 1.0));
  EXPECT_EQ(ekf.belief().status, BeliefStatus::lost);
}

TEST(Ekf, IsLostAfterRejectionsInTwoLooksAndRecoversByAReset) {
  const LandmarkMap map = test::room_landmarks();
  const Pose2 kidnapped{8.0, 4.0, 2.0};
  EkfLocalizer ekf = ekf_at(kPose);
  for (int i = 0; i < 20; ++i) ekf.update(exact(*map.find(2), kidnapped, 1));
  EXPECT_EQ(ekf.belief().status, BeliefStatus::tracking);  // one look may have met clutter
  for (int i = 0; i < 20; ++i) ekf.update(exact(*map.find(3), kidnapped, 2));
  EXPECT_EQ(ekf.belief().status, BeliefStatus::lost);
  ekf.reset({}, prior_at(kidnapped));
  EXPECT_EQ(ekf.belief().status, BeliefStatus::tracking);
  EXPECT_EQ(ekf.update(exact(*map.find(3), kidnapped, 3)).status, UpdateStatus::fused);
  EXPECT_EQ(ekf.belief().status, BeliefStatus::tracking);
}

TEST(Ekf, IsLostWhenTheFirstFramesOfItsLooksAreUnlikelyTogether) {
  // Readings off by 3.5 σ in pan, to the left and to the right in turn: each single innovation
  // passes the gate, five of them cannot be chance.
  const Landmark landmark = *test::room_landmarks().find(4);
  const EkfParams params;
  EkfLocalizer ekf = ekf_at(kPose);
  ekf.reset({}, prior_at(kPose, 0.001, from_deg(0.01)));
  for (int look = 1; look <= 5; ++look) {
    EXPECT_EQ(ekf.belief().status, BeliefStatus::tracking);
    EllipseObservation seen = exact(landmark, kPose, look);
    seen.shot.head.pan += (look % 2 == 0 ? 3.5 : -3.5) * params.sensor.look_angle;
    EXPECT_EQ(ekf.update(seen).status, UpdateStatus::fused) << look;
  }
  EXPECT_EQ(ekf.belief().status, BeliefStatus::lost);
}

TEST(Ekf, TracksASimulatedDriveWithAlmostEveryFrameFused) {
  const test::Drive drive = simulate_drive({}, 1);
  EkfParams params;
  params.odometry = drive.noise.odometry;
  EkfLocalizer ekf(test::room_landmarks(), {head_rig(drive.geometry), {}}, params,
                   test::room_plan());
  OdometryLocalizer odometry(drive.noise.odometry);
  ekf.reset({}, drive.prior);
  odometry.reset({}, drive.prior);
  int frames = 0;
  for (const test::DriveStep& step : drive.steps) {
    ekf.predict(step.measured);
    odometry.predict(step.measured);
    if (!step.seen) continue;
    ++frames;
    ekf.update(*step.seen);
    EXPECT_EQ(odometry.update(*step.seen).status, UpdateStatus::unsupported);
  }
  EXPECT_GT(ekf.count(UpdateStatus::fused), 0.99 * frames);
  EXPECT_EQ(ekf.belief().status, BeliefStatus::tracking);
  const auto position_error = [&drive](const Localizer& localizer) {
    return difference(localizer.belief().pose, drive.steps.back().pose).head<2>().norm();
  };
  EXPECT_LT(position_error(ekf), 4.0 * ekf.belief().position_sigma());
  EXPECT_LT(ekf.belief().position_sigma(), 0.2 * odometry.belief().position_sigma());
}

TEST(OdometryLocalizer, GrowsItsCovarianceLikeTheEkf) {
  OdometryLocalizer odometry({});
  odometry.reset({}, prior_at(kPose));
  EkfLocalizer ekf = ekf_at(kPose);
  for (int i = 0; i < 50; ++i) {
    odometry.predict(forward(0.2 * i, 0.2 * (i + 1)));
    ekf.predict(forward(0.2 * i, 0.2 * (i + 1)));
  }
  EXPECT_LT(difference(odometry.belief().pose, ekf.belief().pose).norm(), 1e-12);
  EXPECT_TRUE(odometry.belief().covariance.isApprox(ekf.belief().covariance, 1e-12));
  EXPECT_TRUE(odometry.belief().stamp == Stamp::from_seconds(10.0));
}

}  // namespace
}  // namespace vigia::localization
