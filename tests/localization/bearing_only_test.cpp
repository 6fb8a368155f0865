#include "vigia/localization/bearing_only.hpp"

#include "localization/points_drive.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace vigia::localization {
namespace {

using test::Drive;
using test::DriveStep;

constexpr int kBearingDrives = 100;

BearingOnlyParams matched_bearings(const Drive& drive) {
  BearingOnlyParams params;
  params.odometry = drive.noise.odometry;
  params.sensor = drive.noise.sensor;
  return params;
}

BearingOnlyLocalizer localizer_for(const Drive& drive, const LandmarkMap& map) {
  return BearingOnlyLocalizer(map, {head_rig(drive.geometry), {}}, matched_bearings(drive),
                              test::room_plan());
}

double bearing_nees(const Belief& belief, const Pose2& truth) {
  const Eigen::Vector3d e = difference(belief.pose, truth);
  return e.dot(belief.covariance.inverse() * e);
}

double off_by(const Belief& belief, const Pose2& truth) {
  return difference(belief.pose, truth).head<2>().norm();
}

/// What became of the looks of one drive.
struct Course {
  std::vector<double> nees;  ///< at the end of each look
  double squared_error = 0.0;
  int fused = 0;
  int other = 0;
  bool was_found = false;
  bool found_right = false;  ///< at the tick at which it was found
  bool was_ambiguous = false;
  double final_error = 0.0;
  BeliefStatus final_status = BeliefStatus::lost;
};

Course follow(const Drive& drive, const std::optional<Prior>& prior) {
  BearingOnlyLocalizer localizer = localizer_for(drive, test::room_landmarks());
  localizer.reset({}, prior);
  Course course;
  BeliefStatus last = localizer.belief().status;
  for (std::size_t i = 0; i < drive.steps.size(); ++i) {
    const DriveStep& step = drive.steps[i];
    localizer.predict(step.measured);
    if (step.seen) {
      const auto status = localizer.update(*step.seen).status;
      status == UpdateStatus::fused ? ++course.fused : ++course.other;
    }
    const Belief& belief = localizer.belief();
    course.squared_error += std::pow(off_by(belief, step.pose), 2);
    const bool last_of_look =
        step.seen && (i + 1 == drive.steps.size() || !drive.steps[i + 1].seen);
    if (last_of_look) course.nees.push_back(bearing_nees(belief, step.pose));
    course.was_ambiguous = course.was_ambiguous || belief.status == BeliefStatus::ambiguous;
    if (last != BeliefStatus::tracking && belief.status == BeliefStatus::tracking &&
        !course.was_found) {
      course.was_found = true;
      course.found_right = off_by(belief, step.pose) < 0.5;
    }
    last = belief.status;
  }
  course.final_error = off_by(localizer.belief(), drive.steps.back().pose);
  course.final_status = localizer.belief().status;
  return course;
}

TEST(BearingOnly, IsConsistentOverAHundredDrivesFromAPrior) {
  double nees = 0.0;
  double squared = 0.0;
  int instants = 0;
  int fused = 0;
  int other = 0;
  std::size_t ticks = 0;
  for (std::uint64_t seed = 0; seed < kBearingDrives; ++seed) {
    const Drive drive = test::simulate_drive({}, seed);
    const Course course = follow(drive, drive.prior);
    for (const double value : course.nees) nees += value;
    instants += static_cast<int>(course.nees.size());
    squared += course.squared_error;
    ticks += drive.steps.size();
    fused += course.fused;
    other += course.other;
    EXPECT_EQ(course.final_status, BeliefStatus::tracking) << "seed " << seed;
  }
  const double per_dof = nees / (3.0 * instants);
  const double rms = std::sqrt(squared / static_cast<double>(ticks));
  RecordProperty("nees_per_dof", std::to_string(per_dof));
  RecordProperty("rms_m", std::to_string(rms));
  EXPECT_GT(per_dof, 0.9);
  EXPECT_LT(per_dof, 1.1);
  EXPECT_LT(rms, 0.08);
  EXPECT_LT(other, 0.01 * fused);
}

TEST(BearingOnly, StaysConsistentWhereTheRobotPassesALandmarkWithinHalfAMetre) {
  const Landmark near = test::disc(1, 3.0, 0.3, 1.4, -90.0);
  const Landmark far = test::disc(2, 9.0, 0.5, 1.4, 180.0);
  const LandmarkMap map({near, far});
  double nees = 0.0;
  int instants = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random(seed, "passing");
    Drive drive;
    BearingOnlyLocalizer localizer(map, {head_rig(drive.geometry), {}}, matched_bearings(drive));
    const Eigen::Vector3d sigma(0.1, 0.1, from_deg(2.0));
    Pose2 pose{1.0, 0.0, 0.0};
    const Pose2 believed{pose.x + sigma.x() * random.normal(), pose.y + sigma.y() * random.normal(),
                         pose.theta + sigma.z() * random.normal()};
    localizer.reset({}, Prior{believed, sigma.cwiseAbs2().asDiagonal()});
    for (int tick = 0; tick < 250; ++tick) {
      const auto u = arc_increment(0.2, 0.0, Stamp::from_seconds(0.04 * tick),
                                   Stamp::from_seconds(0.04 * (tick + 1)));
      OdometryIncrement read = u;
      const Eigen::Matrix3d Q = control_covariance(u, drive.noise.odometry);
      read.rot1 += std::sqrt(Q(0, 0)) * random.normal();
      read.trans += std::sqrt(Q(1, 1)) * random.normal();
      read.rot2 += std::sqrt(Q(2, 2)) * random.normal();
      pose = move(pose, u);
      localizer.predict(read);
      if (tick % 25 != 0) continue;
      const Landmark& landmark = tick % 50 == 0 ? near : far;
      const LookBias bias = test::draw_bias(random, drive.noise.sensor);
      const Shot shot = test::aimed_shot(landmark, {}, pose, bias, 1 + tick / 25, u.to);
      if (!disc_image(landmark, pinhole(shot),
                      to_isometry(pose) * camera_in_base(HeadGeometry{}, shot.head)))
        continue;
      localizer.update(
          test::observe(landmark, shot, {}, pose, bias, 0.0, drive.noise.pixel_sigma, random));
      nees += bearing_nees(localizer.belief(), pose);
      ++instants;
    }
  }
  EXPECT_GT(instants, 1000);
  EXPECT_LT(nees / (3.0 * instants), 1.15);
  EXPECT_GT(nees / (3.0 * instants), 0.85);
}

TEST(BearingOnly, StartedWithoutAPriorItIsLostThenFindsItselfAndIsRight) {
  int found = 0;
  int right = 0;
  int ambiguous = 0;
  for (std::uint64_t seed = 0; seed < kBearingDrives; ++seed) {
    const Course course = follow(test::simulate_drive({}, seed), std::nullopt);
    if (course.was_ambiguous) ++ambiguous;
    if (!course.was_found) continue;
    ++found;
    if (course.found_right) ++right;
  }
  RecordProperty("found", found);
  RecordProperty("right", right);
  RecordProperty("ambiguous", ambiguous);
  EXPECT_GE(found, 90);
  EXPECT_EQ(right, found);
}

TEST(BearingOnly, AKidnappedRobotSaysThatItIsLostAndFindsItselfAgain) {
  int said = 0;
  int back = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Drive drive = test::simulate_drive({}, seed);
    BearingOnlyLocalizer localizer = localizer_for(drive, test::room_landmarks());
    // Told that it stands two metres from where it does.
    Prior wrong = drive.prior;
    wrong.pose = compose(wrong.pose, {1.2, 1.6, 0.6});
    localizer.reset({}, wrong);
    bool lost = false;
    for (const DriveStep& step : drive.steps) {
      localizer.predict(step.measured);
      if (step.seen) localizer.update(*step.seen);
      lost = lost || localizer.belief().status != BeliefStatus::tracking;
    }
    if (lost) ++said;
    const bool tracks = localizer.belief().status == BeliefStatus::tracking;
    if (tracks && off_by(localizer.belief(), drive.steps.back().pose) < 0.3) ++back;
  }
  EXPECT_EQ(said, 20);
  EXPECT_GE(back, 17);
}

TEST(BearingOnly, PatternsAndTagsSayWhoTheyAreAndSoWhereItIs) {
  const Drive drive = test::simulate_drive({}, 1);
  const auto seen = test::points_of(drive, 1);
  BearingOnlyLocalizer localizer = localizer_for(drive, test::room_points());
  EXPECT_EQ(localizer.belief().status, BeliefStatus::lost);
  for (std::size_t i = 0; i < drive.steps.size(); ++i) {
    localizer.predict(drive.steps[i].measured);
    if (seen[i]) localizer.update(*seen[i]);
  }
  EXPECT_EQ(localizer.belief().status, BeliefStatus::tracking);
  EXPECT_LT(off_by(localizer.belief(), drive.steps.back().pose), 0.2);
}

TEST(BearingOnly, ALateImageTellsWhatItWouldHaveToldInTime) {
  const Drive drive = test::simulate_drive({}, 2);
  BearingOnlyLocalizer in_time = localizer_for(drive, test::room_landmarks());
  BearingOnlyLocalizer late = in_time;
  in_time.reset({}, drive.prior);
  late.reset({}, drive.prior);
  // The first image is of the first step.
  ASSERT_TRUE(drive.steps[0].seen);
  for (std::size_t i = 0; i < 5; ++i) {
    in_time.predict(drive.steps[i].measured);
    if (i == 0) in_time.update(*drive.steps[0].seen);
    late.predict(drive.steps[i].measured);
  }
  EXPECT_EQ(late.update(*drive.steps[0].seen).status, UpdateStatus::fused);
  EXPECT_LT(difference(late.belief().pose, in_time.belief().pose).norm(), 1e-3);
  EXPECT_LT((late.belief().covariance - in_time.belief().covariance).norm(),
            0.02 * in_time.belief().covariance.norm());
  EXPECT_EQ(BearingOnlyLocalizer(in_time).update(*drive.steps[0].seen).status, UpdateStatus::fused);
}

}  // namespace
}  // namespace vigia::localization
