#include "vigia/localization/station_fix.hpp"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia::localization {
namespace {

const std::vector<Eigen::Vector2d> kCorners{{0.0, 0.2}, {0.0, -0.2}, {1.5, 0.2}, {1.5, -0.2}};

Eigen::Vector2d in_robot(const Pose2& pose, const Eigen::Vector2d& p_w) {
  const Eigen::Vector2d to = p_w - pose.position();
  const Eigen::Vector2d u = unit_vector(pose.theta);
  return {u.dot(to), cross(u, to)};
}

/// A drive past places from which corner[i] is seen at pose[i], without error.
StationChain exact_chain(const std::vector<Pose2>& poses, const std::vector<std::size_t>& corners,
                         MotionFrame frame, const StereoErrors& errors = {}) {
  StationChain chain;
  chain.pair = {554.3, 319.5, 0.03};
  for (const auto& corner : kCorners) chain.landmarks.push_back({corner, Eigen::Matrix2d::Zero()});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto image = stereo_image(chain.pair, errors, in_robot(poses[i], kCorners[corners[i]]));
    chain.sightings.push_back({corners[i], {image->columns.x(), image->columns.y()}, 0.1});
    if (i == 0) continue;
    StationMotion motion;
    motion.frame = frame;
    motion.displacement_m = frame == MotionFrame::world
                                ? Eigen::Vector2d(poses[i].position() - poses[i - 1].position())
                                : in_robot(poses[i - 1], poses[i].position());
    motion.turn = wrap_angle(poses[i].theta - poses[i - 1].theta);
    chain.motions.push_back(motion);
  }
  return chain;
}

/// The same with columns so well known that the posterior is its mode.
StationChain precise(StationChain chain) {
  for (auto& sighting : chain.sightings) sighting.sigma_px = 1e-5;
  return chain;
}

const std::vector<Pose2> kTwo{{0.5, -0.4, 0.5}, {0.8, 0.4, -0.4}};
const std::vector<Pose2> kFive{
    {0.5, -0.4, 0.5}, {0.8, 0.4, -0.4}, {0.9, 0.1, 3.0}, {0.4, 0.3, 0.1}, {1.1, -0.4, 2.6}};
const std::vector<std::size_t> kFiveCorners{2, 2, 0, 2, 1};

TEST(StationFix, OneLandmarkFromTwoPointsGivesOnePoseByRangeAndBearing) {
  const StationFix fix = station_fix(precise(exact_chain(kTwo, {2, 2}, MotionFrame::world)));
  EXPECT_EQ(fix.status, StationFixStatus::found);
  EXPECT_LT(difference(fix.hypotheses.front().pose, kTwo[1]).norm(), 1e-7);
}

TEST(StationFix, ResidualsMoveAsTheirJacobianSaysInBothFrames) {
  for (const MotionFrame frame : {MotionFrame::world, MotionFrame::body}) {
    StationChain chain = exact_chain(kFive, kFiveCorners, frame);
    chain.calibration_sigma = {0.01, 0.002, 0.005};
    chain.heading = HeadingPrior{kFive.back().theta, 0.1};
    Eigen::Matrix3d root;
    root << 0.01, 0.0, 0.0, 0.004, 0.02, 0.0, 0.003, -0.002, 0.03;
    for (auto& motion : chain.motions) motion.covariance = root * root.transpose();
    for (auto& place : chain.landmarks) place.covariance << 1e-4, 3e-5, 3e-5, 2e-4;
    RandomStream random(11, "state");
    Eigen::VectorXd state(chain_state_size(chain));
    for (Eigen::Index i = 0; i < state.size(); ++i) state(i) = 0.5 * random.normal();
    state.head<3>() = kFive.back().vector() + Eigen::Vector3d(0.02, -0.01, 0.03);
    const auto at = chain_residuals(chain, state);
    ASSERT_TRUE(at);
    constexpr double kStep = 1e-6;
    for (Eigen::Index i = 0; i < state.size(); ++i) {
      const Eigen::VectorXd d = kStep * Eigen::VectorXd::Unit(state.size(), i);
      const Eigen::VectorXd slope =
          (chain_residuals(chain, state + d)->r - chain_residuals(chain, state - d)->r) /
          (2.0 * kStep);
      EXPECT_LT((slope - at->J.col(i)).norm(), 1e-5 * (1.0 + at->J.col(i).norm())) << i;
    }
  }
}

TEST(StationFix, ByOneLandmarkAndBodyOdometryTheRotationAboutItCannotBeObserved) {
  const StationChain chain = exact_chain(kTwo, {2, 2}, MotionFrame::body);
  EXPECT_EQ(station_fix(chain).status, StationFixStatus::no_heading);
  EXPECT_FALSE(station_bound(chain, kTwo[1]));
  Eigen::VectorXd state = Eigen::VectorXd::Zero(chain_state_size(chain));
  state.head<3>() = kTwo[1].vector();
  const Eigen::MatrixXd J = chain_residuals(chain, state)->J.topLeftCorner(4, 3);
  const Eigen::Vector3d singular = J.jacobiSvd().singularValues();
  EXPECT_LT(singular.z(), 1e-8 * singular.x());
  EXPECT_GT(singular.y(), 1e-3 * singular.x());
}

TEST(StationFix, ACompassOrASecondLandmarkIsWhatBodyOdometryTakes) {
  StationChain compass = precise(exact_chain(kTwo, {2, 2}, MotionFrame::body));
  compass.heading = HeadingPrior{kTwo[1].theta, 1e-5};
  const StationFix by_compass = station_fix(compass);
  EXPECT_EQ(by_compass.status, StationFixStatus::found);
  EXPECT_LT(difference(by_compass.hypotheses.front().pose, kTwo[1]).norm(), 1e-7);
  const StationFix by_two =
      station_fix(precise(exact_chain(kFive, kFiveCorners, MotionFrame::body)));
  EXPECT_EQ(by_two.status, StationFixStatus::found);
  EXPECT_LT(difference(by_two.hypotheses.front().pose, kFive.back()).norm(), 1e-7);
}

TEST(StationFix, BelowTheGateOfSineGammaItSaysDegenerate) {
  const std::vector<Pose2> towards{{0.4, 0.16, 0.0}, {0.9, 0.18, 0.1}};
  const StationFix fix = station_fix(exact_chain(towards, {2, 2}, MotionFrame::world));
  EXPECT_EQ(fix.status, StationFixStatus::degenerate);
  EXPECT_LT(fix.sin_gamma, 0.3);
}

TEST(StationFix, AWayNotMuchLongerThanTheRangesErrorsLeavesTwoPoses) {
  const std::vector<Pose2> across{{0.078, -0.254, -0.42}, {0.431, 0.189, -0.80}};
  StationChain chain = exact_chain(across, {3, 3}, MotionFrame::world);
  for (auto& sighting : chain.sightings) sighting.sigma_px = 1.2;
  const StationFix fix = station_fix(chain);
  EXPECT_EQ(fix.status, StationFixStatus::ambiguous);
  ASSERT_EQ(fix.hypotheses.size(), 2U);
  EXPECT_NEAR(fix.hypotheses[0].weight + fix.hypotheses[1].weight, 1.0, 1e-12);
  EXPECT_GT(difference(fix.hypotheses[0].pose, fix.hypotheses[1].pose).norm(), 0.05);
  EXPECT_LT(std::min(difference(fix.hypotheses[0].pose, across[1]).norm(),
                     difference(fix.hypotheses[1].pose, across[1]).norm()),
            0.02);
}

TEST(StationFix, WhereTheHeadingIsPoorTheCovarianceIsThatOfAPositionBentAboutTheLandmark) {
  // Drawn about the truth by the posterior's own coordinates: heading and range apart.
  const std::vector<Pose2> near{{0.3, -0.1, 0.1}, {0.3, 0.3, -0.05}};
  StationChain chain = exact_chain(near, {2, 2}, MotionFrame::world);
  chain.heading = HeadingPrior{near[1].theta, 0.15};
  chain.motions.clear();
  chain.sightings.erase(chain.sightings.begin());
  const StationFix fix = station_fix(chain);
  ASSERT_EQ(fix.hypotheses.size(), 1U);
  const PoseHypothesis& best = fix.hypotheses[0];
  const Eigen::Vector2d to = kCorners[2] - near[1].position();
  // E[cos] of a normal angle shortens the mean to exp(−σ²/2) of the range.
  EXPECT_NEAR((kCorners[2] - best.pose.position()).norm(), to.norm() * std::exp(-0.15 * 0.15 / 2),
              1e-4);
  const Eigen::Vector2d u = to.normalized();
  const double radial = u.dot(best.covariance.topLeftCorner<2, 2>() * u);
  EXPECT_GT(radial, 0.5 * std::pow(to.norm() * 0.15 * 0.15, 2));
}

TEST(StationFix, ARobotThatOnlyTurnedIsDegenerateWithoutACovariance) {
  const std::vector<Pose2> turned{{0.8, 0.4, -0.4}, {0.8, 0.4, -0.2}};
  const StationFix fix = station_fix(exact_chain(turned, {2, 2}, MotionFrame::world));
  EXPECT_EQ(fix.status, StationFixStatus::degenerate);
  EXPECT_TRUE(fix.hypotheses.empty());
}

TEST(StationFix, ASightingWithoutDisparityIsBehindTheCamera) {
  StationChain chain = exact_chain(kTwo, {2, 2}, MotionFrame::world);
  chain.sightings[0].columns.right = chain.sightings[0].columns.left;
  EXPECT_EQ(station_fix(chain).status, StationFixStatus::behind_camera);
}

TEST(StationFix, TheCalibrationIsEstimatedAlongADrive) {
  const StereoErrors errors{0.012, from_deg(0.12), -0.006};
  StationChain chain = exact_chain(kFive, kFiveCorners, MotionFrame::world, errors);
  const StationFix blind = station_fix(chain);
  chain.calibration_sigma = {0.01, from_deg(0.1), 0.005};
  const StationFix aware = station_fix(chain);
  EXPECT_LT((aware.hypotheses.front().pose.position() - kFive.back().position()).norm(),
            0.2 * (blind.hypotheses.front().pose.position() - kFive.back().position()).norm());
  EXPECT_NEAR(aware.calibration.vergence, errors.vergence, 0.2 * errors.vergence);
  EXPECT_LT(aware.calibration_covariance(1, 1), std::pow(0.3 * from_deg(0.1), 2));
}

TEST(StationFix, ErrorsHaveTheBoundsCovarianceWhenAllIsUncertain) {
  StationChain truth = exact_chain(kFive, kFiveCorners, MotionFrame::world);
  truth.calibration_sigma = {0.01, from_deg(0.1), 0.005};
  for (auto& motion : truth.motions) motion.covariance.diagonal() << 1e-5, 1e-5, 1e-5;
  for (auto& place : truth.landmarks) place.covariance.diagonal() << 1e-5, 1e-5;
  const Eigen::Matrix3d bound = *station_bound(truth, kFive.back());
  RandomStream random(13, "chain");
  const auto draw = [&random](double sigma) { return sigma * random.normal(); };
  constexpr int kDraws = 1000;
  double by_bound = 0.0;
  double by_claim = 0.0;
  for (int n = 0; n < kDraws; ++n) {
    const StereoErrors errors{draw(0.01), draw(from_deg(0.1)), draw(0.005)};
    StationChain chain = exact_chain(kFive, kFiveCorners, MotionFrame::world, errors);
    chain.calibration_sigma = truth.calibration_sigma;
    const double sigma = std::sqrt(1e-5);
    for (auto& sighting : chain.sightings) {
      sighting.columns.left += draw(sighting.sigma_px);
      sighting.columns.right += draw(sighting.sigma_px);
    }
    for (auto& motion : chain.motions) {
      motion.covariance = truth.motions[0].covariance;
      motion.displacement_m += Eigen::Vector2d(draw(sigma), draw(sigma));
      motion.turn += draw(sigma);
    }
    for (auto& place : chain.landmarks) {
      place.covariance = truth.landmarks[0].covariance;
      place.p_w += Eigen::Vector2d(draw(sigma), draw(sigma));
    }
    const StationFix fix = station_fix(chain);
    ASSERT_EQ(fix.status, StationFixStatus::found);
    const Eigen::Vector3d e = difference(fix.hypotheses.front().pose, kFive.back());
    by_bound += e.dot(bound.inverse() * e) / kDraws;
    by_claim += e.dot(fix.hypotheses.front().covariance.inverse() * e) / kDraws;
  }
  // Mean of 1000 χ² of 3 degrees of freedom: standard error √(6/1000) = 0.077; four of them.
  EXPECT_NEAR(by_bound, 3.0, 0.31);
  EXPECT_NEAR(by_claim, 3.0, 0.31);
}

}  // namespace
}  // namespace vigia::localization
