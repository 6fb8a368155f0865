#include <cmath>
#include <memory>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/random.hpp"
#include "vigia/localization/ml_fix_localizer.hpp"
#include "vigia/localization/running_fix_localizer.hpp"
#include "vigia/localization/travelled.hpp"

namespace vigia::localization {
namespace {

constexpr double kSigma_px = 0.1;

FieldMap mirosot() {
  FieldMap field;
  field.length_m = 1.5;
  field.width_m = 1.3;
  field.goals = {{FieldColour::yellow, {-0.75, -0.2}, {-0.75, 0.2}, 0.15, 0.05, 0.0},
                 {FieldColour::blue, {0.75, 0.2}, {0.75, -0.2}, 0.15, 0.05, 0.0}};
  return field;
}

CornerFilterParams pair_of_the_robot(bool calibrated) {
  CornerFilterParams params;
  params.lens = {320, 240, 277.1, 277.1, 159.5, 119.5, 0.0};
  if (!calibrated) params.calibration_sigma = {0.01, from_deg(0.1), 0.005};
  params.odometry = {0.01, from_deg(1.0), from_deg(2.0)};
  return params;
}

/// A robot that drives circles on the field and sees corners without any picture.
class Drive {
 public:
  Drive(const CornerFilterParams& params, std::uint64_t seed)
      : params_(params), random_(seed, "drive") {
    errors_ = {params.calibration_sigma.baseline * random_.normal(),
               params.calibration_sigma.vergence * random_.normal(),
               params.calibration_sigma.focal * random_.normal()};
  }

  /// The prior that a robot has whose true start is drawn from it.
  Prior start(double sigma_m, double sigma_rad) {
    const Prior prior{
        {truth_.x + sigma_m * random_.normal(), truth_.y + sigma_m * random_.normal(),
         wrap_angle(truth_.theta + sigma_rad * random_.normal())},
        Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal()};
    return prior;
  }

  /// A fifth of a second, along a circle unless said; the odometry of it, with its errors.
  OdometryIncrement step(double v_mps = 0.3, double w_radps = 0.75) {
    const Stamp to = now_ + Duration::from_seconds(0.2);
    const OdometryIncrement u = arc_increment(v_mps, w_radps, now_, to);
    truth_ = move(truth_, u);
    now_ = to;
    const Eigen::Matrix3d S = control_covariance(u, params_.odometry);
    OdometryIncrement read = u;
    read.rot1 += std::sqrt(S(0, 0)) * random_.normal();
    read.trans += std::sqrt(S(1, 1)) * random_.normal();
    read.rot2 += std::sqrt(S(2, 2)) * random_.normal();
    return read;
  }

  StereoObservation look() {
    StereoObservation seen;
    seen.shot.stamp = seen.right.stamp = now_;
    seen.shot.model = seen.right.model = params_.lens;
    for (const FieldColour colour : {FieldColour::yellow, FieldColour::blue}) {
      for (const bool left : {true, false}) {
        const Eigen::Vector2d place = *goal_corner_place(field, {colour, left});
        const Eigen::Vector2d p_r = Eigen::Rotation2Dd(-truth_.theta) * (place - truth_.position());
        if (p_r.x() < 0.1) continue;
        const auto image = stereo_image(params_.pair, errors_, p_r);
        if (!image || image->columns.minCoeff() < 5.0 || image->columns.maxCoeff() > 314.0)
          continue;
        StereoCorner corner;
        corner.corner = {colour, left};
        corner.left_uv = {image->columns.x() + kSigma_px * random_.normal(), 125.0};
        corner.right_uv = {image->columns.y() + kSigma_px * random_.normal(), 125.0};
        corner.covariance = kSigma_px * kSigma_px * Eigen::Matrix2d::Identity();
        seen.corners.push_back(corner);
      }
    }
    return seen;
  }

  const Pose2& truth() const { return truth_; }
  const StereoErrors& errors() const { return errors_; }
  Stamp now() const { return now_; }
  FieldMap field = mirosot();

 private:
  CornerFilterParams params_;
  RandomStream random_;
  StereoErrors errors_;
  Pose2 truth_{0.0, -0.4, 0.0};
  Stamp now_;
};

TEST(GoalCornerPlace, IsNamedAsItIsSeenFromTheField) {
  const FieldMap field = mirosot();
  EXPECT_EQ(*goal_corner_place(field, {FieldColour::yellow, true}), Eigen::Vector2d(-0.75, -0.2));
  EXPECT_EQ(*goal_corner_place(field, {FieldColour::yellow, false}), Eigen::Vector2d(-0.75, 0.2));
  EXPECT_EQ(*goal_corner_place(field, {FieldColour::blue, true}), Eigen::Vector2d(0.75, 0.2));
  EXPECT_EQ(*goal_corner_place(field, {FieldColour::blue, false}), Eigen::Vector2d(0.75, -0.2));
  EXPECT_FALSE(goal_corner_place(field, {FieldColour::white, true}));
}

/// Mean NEES (3 degrees of freedom) at the end of @p runs drives of @p steps.
double mean_nees(bool calibrated, int runs, int steps, double* rms = nullptr) {
  double sum = 0.0;
  double square = 0.0;
  for (int run = 0; run < runs; ++run) {
    Drive drive(pair_of_the_robot(calibrated), static_cast<std::uint64_t>(run + 1));
    MlFixParams params;
    params.filter = pair_of_the_robot(calibrated);
    MlFixLocalizer localizer(drive.field, params);
    localizer.reset({}, drive.start(0.02, from_deg(3.0)));
    for (int i = 0; i < steps; ++i) {
      localizer.predict(drive.step());
      localizer.update(drive.look());
    }
    const Belief& belief = localizer.belief();
    const Eigen::Vector3d e = difference(belief.pose, drive.truth());
    sum += e.dot(belief.covariance.ldlt().solve(e));
    square += e.head<2>().squaredNorm();
  }
  if (rms != nullptr) *rms = std::sqrt(square / runs);
  return sum / runs;
}

TEST(MlFix, IsConsistentWithAnExactCalibration) {
  // χ² of 3 · 200 degrees of freedom: σ of the mean 0.17.
  EXPECT_NEAR(mean_nees(true, 200, 50), 3.0, 4.0 * 0.173);
}

TEST(MlFix, IsConsistentWithErrorsOfCalibrationThatItEstimates) {
  EXPECT_NEAR(mean_nees(false, 200, 50), 3.0, 4.0 * 0.173);
}

TEST(MlFix, FindsItselfWithoutAPriorOnceItHasSeenTwoCorners) {
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Drive drive(pair_of_the_robot(false), seed);
    MlFixParams params;
    params.filter = pair_of_the_robot(false);
    MlFixLocalizer localizer(drive.field, params);
    localizer.reset({}, std::nullopt);
    EXPECT_EQ(localizer.belief().status, BeliefStatus::lost);
    for (int i = 0; i < 60; ++i) {
      localizer.predict(drive.step());
      localizer.update(drive.look());
    }
    EXPECT_EQ(localizer.belief().status, BeliefStatus::tracking);
    right += difference(localizer.belief().pose, drive.truth()).head<2>().norm() < 0.05 ? 1 : 0;
  }
  EXPECT_EQ(right, 20);
}

TEST(MlFix, FusesAPairOfImagesThatComesLate) {
  Drive drive(pair_of_the_robot(true), 1);
  MlFixParams params;
  params.filter = pair_of_the_robot(true);
  MlFixLocalizer late(drive.field, params);
  MlFixLocalizer prompt(drive.field, params);
  const Prior prior = drive.start(0.02, from_deg(3.0));
  late.reset({}, prior);
  prompt.reset({}, prior);
  int fused = 0;
  for (int i = 0; i < 20; ++i) {
    const OdometryIncrement first = drive.step();
    late.predict(first);
    prompt.predict(first);
    const StereoObservation seen = drive.look();
    prompt.update(seen);
    const OdometryIncrement second = drive.step();
    late.predict(second);
    prompt.predict(second);
    fused += late.update(seen).status == UpdateStatus::fused ? 1 : 0;
  }
  EXPECT_GT(fused, 5);
  EXPECT_LT(difference(late.belief().pose, prompt.belief().pose).norm(), 1e-9);
  EXPECT_LT((late.belief().covariance - prompt.belief().covariance).norm(), 1e-9);
}

TEST(MlFix, SaysThatItIsLostWhenNothingFitsForLong) {
  Drive drive(pair_of_the_robot(true), 1);
  MlFixParams params;
  params.filter = pair_of_the_robot(true);
  MlFixLocalizer localizer(drive.field, params);
  localizer.reset({}, Prior{{0.2, 0.3, 1.0}, 1e-6 * Eigen::Matrix3d::Identity()});
  bool lost = false;
  for (int i = 0; i < 100 && !lost; ++i) {
    localizer.predict(drive.step());
    localizer.update(drive.look());
    lost = localizer.belief().status == BeliefStatus::lost;
  }
  EXPECT_TRUE(lost);
}

TEST(RunningFixLocalizer, HoldsTheDriftOfOdometryDownWhereTheRobotTurns) {
  double fixes = 0.0;
  double odometry = 0.0;
  double nees = 0.0;
  int tracking = 0;
  RunningFixLocalizerParams params;
  params.pair = pair_of_the_robot(true);
  params.pair.odometry = {0.05, from_deg(0.3), from_deg(0.3)};
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Drive drive(params.pair, seed);
    RunningFixLocalizer localizer(drive.field, params);
    const Prior prior = drive.start(0.02, from_deg(3.0));
    localizer.reset({}, prior);
    Pose2 dead = prior.pose;
    for (int i = 0; i < 500; ++i) {
      // Forward by 0.3 m, then once and a quarter round.
      const OdometryIncrement u = i % 25 < 5 ? drive.step(0.3, 0.0) : drive.step(0.0, 0.625 * kPi);
      dead = move(dead, u);
      localizer.predict(u);
      localizer.update(drive.look());
    }
    if (localizer.belief().status != BeliefStatus::tracking) continue;
    ++tracking;
    const Eigen::Vector3d e = difference(localizer.belief().pose, drive.truth());
    nees += e.dot(localizer.belief().covariance.ldlt().solve(e)) / 3.0;
    fixes += e.head<2>().squaredNorm();
    odometry += difference(dead, drive.truth()).head<2>().squaredNorm();
  }
  EXPECT_GE(tracking, 45);
  EXPECT_LT(fixes, 0.6 * odometry);
  // 150 degrees of freedom: σ 0.115.
  EXPECT_NEAR(nees / tracking, 1.0, 4.0 * 0.115);
}

TEST(RunningFixLocalizer, CannotBeginWithoutAHeading) {
  Drive drive(pair_of_the_robot(true), 1);
  RunningFixLocalizerParams params;
  params.pair = pair_of_the_robot(true);
  RunningFixLocalizer localizer(drive.field, params);
  localizer.reset({}, std::nullopt);
  for (int i = 0; i < 20; ++i) {
    localizer.predict(drive.step());
    EXPECT_EQ(localizer.update(drive.look()).status, UpdateStatus::no_prior);
  }
  EXPECT_EQ(localizer.belief().status, BeliefStatus::lost);
}

TEST(Travel, ComposesIncrementsInTheRobotsAxes) {
  const OdometryNoise noise{0.01, 0.02, 0.03};
  StationMotion motion;
  Pose2 pose{0.3, -0.2, 0.7};
  const Pose2 begin = pose;
  for (int i = 0; i < 5; ++i) {
    const OdometryIncrement u = arc_increment(0.3, 0.5, {}, Stamp{200'000'000});
    pose = move(pose, u);
    travel(motion, u, noise);
  }
  const Eigen::Vector2d in_world =
      Eigen::Rotation2Dd(begin.theta) * motion.displacement_m + begin.position();
  EXPECT_LT((in_world - pose.position()).norm(), 1e-12);
  EXPECT_NEAR(wrap_angle(begin.theta + motion.turn - pose.theta), 0.0, 1e-12);
  EXPECT_GT(motion.covariance.determinant(), 0.0);
}

}  // namespace
}  // namespace vigia::localization
