#include "vigia/localization/motion_fusion.hpp"

#include <random>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/localization/flow_fed_localizer.hpp"
#include "vigia/localization/odometry_localizer.hpp"

namespace vigia::localization {
namespace {

constexpr double kFlowGate = 16.27;
const OdometryNoise kRoughWheels{0.02, from_deg(1.0), from_deg(2.0)};

OdometryIncrement increment(double from_s, double to_s, double rot1, double trans, double rot2) {
  return {Stamp::from_seconds(from_s), Stamp::from_seconds(to_s), rot1, trans, rot2};
}

FlowMotion flow_of(const OdometryIncrement& u, double sigma) {
  FlowMotion seen;
  seen.step = move({}, u);
  seen.covariance = sigma * sigma * Eigen::Matrix3d::Identity();
  return seen;
}

CeilingCamera eye_above() {
  CeilingCamera camera;
  camera.rMc.translation() = Eigen::Vector3d(0.07, -0.02, 0.5);
  return camera;
}

TEST(MotionFusion, APreciseFlowIsFollowedAndARoughOneHardly) {
  const auto read = increment(0.0, 0.04, 0.01, 0.02, 0.0);
  const auto truth = increment(0.0, 0.04, 0.014, 0.022, 0.004);
  const auto precise = fuse_motions(read, kRoughWheels, flow_of(truth, 1e-6), kFlowGate);
  ASSERT_TRUE(precise);
  EXPECT_LT(difference(precise->step, move({}, truth)).norm(), 1e-5);
  const auto rough = fuse_motions(read, kRoughWheels, flow_of(truth, 1.0), kFlowGate);
  ASSERT_TRUE(rough);
  EXPECT_LT(difference(rough->step, move({}, read)).norm(), 1e-5);
}

TEST(MotionFusion, WhereTheTwoExcludeEachOtherThereIsNoMotion) {
  const auto read = increment(0.0, 0.04, 0.0, 0.02, 0.0);
  EXPECT_FALSE(fuse_motions(read, kRoughWheels, flow_of(increment(0.0, 0.04, 0.0, 0.12, 0.0), 1e-4),
                            kFlowGate));
}

TEST(MotionFusion, WheelsThatReadNothingStandUnlessTheFlowSaysOtherwise) {
  const auto still = increment(0.0, 0.04, 0.0, 0.0, 0.0);
  const auto stands = fuse_motions(still, kRoughWheels,
                                   flow_of(increment(0.0, 0.04, 0.0, 2e-4, 0.0), 2e-4), kFlowGate);
  ASSERT_TRUE(stands);
  EXPECT_EQ(stands->step.position().norm(), 0.0);
  EXPECT_EQ(stands->covariance.norm(), 0.0);
  const auto towed = fuse_motions(still, kRoughWheels,
                                  flow_of(increment(0.0, 0.04, 0.0, 8e-3, 0.0), 2e-4), kFlowGate);
  ASSERT_TRUE(towed);
  EXPECT_NEAR(towed->step.x, 8e-3, 1e-3);
}

TEST(MotionFusion, IncrementsJoinedLeadWhereTheyLead) {
  const std::vector<OdometryIncrement> parts{increment(0.0, 0.04, 0.1, 0.02, 0.1),
                                             increment(0.04, 0.08, 0.05, 0.03, 0.0),
                                             increment(0.08, 0.12, -0.02, 0.01, -0.02)};
  Pose2 end;
  for (const auto& part : parts) end = move(end, part);
  const OdometryIncrement whole = joined(parts);
  EXPECT_LT(difference(move({}, whole), end).norm(), 1e-12);
  EXPECT_EQ(whole.from, parts.front().from);
  EXPECT_EQ(whole.to, parts.back().to);
}

TEST(MotionFusion, AnIncrementHasTheMotionsCovariance) {
  FusedMotion motion;
  motion.step = {0.02, 0.003, 0.1};
  motion.covariance << 4e-8, 1e-8, 0.0, 1e-8, 3e-8, 1e-8, 0.0, 1e-8, 5e-8;
  const OdometryIncrement u = as_increment(motion, increment(0.0, 0.04, 0.0, 0.02, 0.1));
  EXPECT_LT(difference(move({}, u), motion.step).norm(), 1e-12);
  const Eigen::Matrix3d G = move_jacobian_control({}, u);
  const Eigen::Matrix3d back = G * control_covariance(u, kRoughWheels) * G.transpose();
  EXPECT_LT((back - motion.covariance).norm(), 1e-12);
}

/// By a tenth too fast, each frame within what the wheels allow of it.
TEST(FlowTrust, AFlowThatIsTooFastAllTheTimeIsFoundOut) {
  FlowTrust wrong;
  FlowTrust right;
  int found_out = -1;
  for (int i = 0; i < 200; ++i) {
    const auto read = increment(0.04 * i, 0.04 * (i + 1), 0.0, 0.02, 0.0);
    const auto fast = flow_of(increment(0.04 * i, 0.04 * (i + 1), 0.0, 0.0225, 0.0), 3e-4);
    EXPECT_TRUE(fuse_motions(read, kRoughWheels, fast, kFlowGate));
    const bool held = wrong.holds(read, kRoughWheels, fast, Eigen::Matrix3d::Zero(), kFlowGate);
    if (!held && found_out < 0) found_out = i;
    EXPECT_TRUE(
        right.holds(read, kRoughWheels, flow_of(read, 3e-4), Eigen::Matrix3d::Zero(), kFlowGate));
  }
  EXPECT_GT(found_out, 5);
  EXPECT_LT(found_out, 100);
}

/// Dead reckoning under a ceiling's flow of 0.3 mm and 0.02° a frame.
class FlowFedDrive {
 public:
  explicit FlowFedDrive(unsigned seed) : random_(seed) {
    params_.odometry = kRoughWheels;
    params_.flow_floor = 0.0;
    auto wheels = std::make_unique<OdometryLocalizer>(kRoughWheels);
    fed_ = std::make_unique<FlowFedLocalizer>(std::move(wheels), camera_, params_);
    fed_->reset({}, Prior{{}, Eigen::Matrix3d::Zero()});
    plain_.reset({}, Prior{{}, Eigen::Matrix3d::Zero()});
  }

  /// @p every: ticks from frame to frame.
  void go(int ticks, int every) {
    for (int tick = 1; tick <= ticks; ++tick) {
      const double turn = 0.01 * std::sin(0.02 * tick);
      const auto u = increment(0.04 * (tick - 1), 0.04 * tick, turn, 0.02, 0.0);
      truth_ = move(truth_, u);
      since_ = move(since_, u);
      const Eigen::Matrix3d sigma =
          control_covariance(u, kRoughWheels).diagonal().cwiseSqrt().asDiagonal();
      const Eigen::Vector3d error = sigma * draw();
      OdometryIncrement read = u;
      read.rot1 += error[0];
      read.trans += error[1];
      read.rot2 += error[2];
      fed_->predict(read);
      plain_.predict(read);
      if (tick % every == 0) show_frame(u.to);
    }
  }

  Localizer& fed() { return *fed_; }
  const Localizer& plain() const { return plain_; }
  const Pose2& truth() const { return truth_; }

 private:
  Eigen::Vector3d draw() { return {normal_(random_), normal_(random_), normal_(random_)}; }

  void show_frame(Stamp stamp) {
    const Eigen::Vector3d sigma(1.4e-4, 1.4e-4, from_deg(0.02));
    FlowObservation flow;
    flow.from = before_;
    flow.shot.stamp = before_ = stamp;
    flow.shift = seen_shift(camera_, since_);
    const Eigen::Vector3d error = sigma.cwiseProduct(draw());
    flow.shift.shift += error.head<2>();
    flow.shift.turn += error[2];
    flow.shift.covariance = sigma.cwiseAbs2().asDiagonal();
    since_ = {};
    EXPECT_EQ(fed_->update(flow).status, UpdateStatus::fused);
    EXPECT_EQ(fed_->belief().stamp, stamp);
  }

  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  CeilingCamera camera_ = eye_above();
  CeilingFilterParams params_;
  std::unique_ptr<FlowFedLocalizer> fed_;
  OdometryLocalizer plain_{kRoughWheels};
  Pose2 truth_;
  Pose2 since_;  ///< the last frame
  Stamp before_;
};

double nees_of(const Localizer& localizer, const Pose2& truth) {
  const Eigen::Vector3d off = difference(localizer.belief().pose, truth);
  return off.dot(localizer.belief().covariance.inverse() * off);
}

TEST(FlowFedLocalizer, DeadReckoningIsNearerAndAsConsistent) {
  for (const int every : {1, 5}) {
    double fed = 0.0;
    double plain = 0.0;
    double nees = 0.0;
    constexpr int kDrives = 200;
    for (unsigned seed = 1; seed <= kDrives; ++seed) {
      FlowFedDrive drive(seed);
      drive.go(100, every);
      fed += (drive.fed().belief().pose.position() - drive.truth().position()).squaredNorm();
      plain += (drive.plain().belief().pose.position() - drive.truth().position()).squaredNorm();
      nees += nees_of(drive.fed(), drive.truth()) / 3.0;
    }
    EXPECT_LT(fed, 0.04 * plain) << "a frame in " << every;
    // 600 degrees of freedom: 0.85 to 1.15 is 2.6 σ.
    EXPECT_NEAR(nees / kDrives, 1.0, 0.15) << "a frame in " << every;
  }
}

TEST(FlowFedLocalizer, BetweenFramesItGoesAheadByTheOdometry) {
  FlowFedDrive drive(1);
  drive.go(10, 5);
  const Pose2 before = drive.fed().belief().pose;
  const double sigma = drive.fed().belief().position_sigma();
  const auto u = increment(0.4, 0.44, 0.0, 0.02, 0.0);
  drive.fed().predict(u);
  EXPECT_LT(difference(drive.fed().belief().pose, move(before, u)).norm(), 1e-12);
  EXPECT_GT(drive.fed().belief().position_sigma(), sigma);
  EXPECT_EQ(drive.fed().belief().stamp, u.to);
}

TEST(FlowFedLocalizer, AFlowOverFramesThatItHasPassedComesTooLate) {
  FlowFedDrive drive(1);
  drive.go(3, 1);
  FlowObservation old;
  old.from = Stamp::from_seconds(0.0);
  old.shot.stamp = Stamp::from_seconds(0.04);
  EXPECT_EQ(drive.fed().update(old).status, UpdateStatus::too_late);
}

TEST(FlowFedLocalizer, AFlowThatTheWheelsExcludeIsNotFollowed) {
  FlowFedDrive drive(1);
  drive.go(3, 1);
  const auto u = increment(0.12, 0.16, 0.0, 0.02, 0.0);
  const Pose2 expected = move(drive.fed().belief().pose, u);
  drive.fed().predict(u);
  FlowObservation wrong;
  wrong.from = u.from;
  wrong.shot.stamp = u.to;
  wrong.shift.shift = Eigen::Vector2d(0.2, 0.0);
  wrong.shift.covariance = 1e-8 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(drive.fed().update(wrong).status, UpdateStatus::gated);
  EXPECT_LT(difference(drive.fed().belief().pose, expected).norm(), 1e-12);
}

}  // namespace
}  // namespace vigia::localization
