#include "localization/drive.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/localization/ekf.hpp"

namespace vigia::localization {
namespace {

// A robot that stands before a disc, seen by a camera on the base (1) and one on the head (0).

const Pose2 kStand{4.0, 3.0, 0.2};

Landmark seen_disc() {
  return *test::room_landmarks().find(4);
}

/// The disc's image in the head's camera, of one grey level's noise.
EllipseObservation by_head(LookId look, double seconds) {
  RandomStream random(1, "exact");
  const Shot shot =
      test::aimed_shot(seen_disc(), {}, kStand, {}, look, Stamp::from_seconds(seconds));
  EllipseObservation seen = test::observe(seen_disc(), shot, {}, kStand, {}, 0.0, 0.0, random);
  seen.covariance.setIdentity();
  return seen;
}

/// The same in the fixed camera, which no look directs.
EllipseObservation by_fixed(double seconds, double shift_px = 0.0) {
  EllipseObservation seen = by_head(0, seconds);
  seen.shot.camera = 1;
  seen.shot.head = {};
  seen.ellipse.u += shift_px;
  return seen;
}

EkfLocalizer standing(const EkfParams& params, double sigma_m, double sigma_rad) {
  const Shot shot = by_head(0, 0.0).shot;
  Rig rig = head_rig({});
  Camera fixed;
  fixed.id = 1;
  fixed.mount = FixedMount{camera_in_base({}, shot.head)};
  fixed.optics = shot.model;
  rig.cameras.push_back(fixed);
  EkfLocalizer ekf(LandmarkMap({seen_disc()}), {rig, {}}, params);
  const Eigen::Vector3d sigma(sigma_m, sigma_m, sigma_rad);
  ekf.reset({}, Prior{kStand, sigma.cwiseAbs2().asDiagonal()});
  return ekf;
}

void stand_until(EkfLocalizer& ekf, double from_s, double to_s) {
  ekf.predict({Stamp::from_seconds(from_s), Stamp::from_seconds(to_s), 0.0, 0.0, 0.0});
}

TEST(EkfFixedCamera, SaysThatItIsLostAfterRejectionsInTwoSeconds) {
  constexpr double kOther_px = 60.0;
  constexpr double kPeriod_s = 0.04;
  EkfLocalizer ekf = standing({}, 0.01, from_deg(0.1));
  double t_s = 0.0;
  while (t_s < 0.9) {
    stand_until(ekf, t_s, t_s + kPeriod_s);
    t_s += kPeriod_s;
    EXPECT_EQ(ekf.update(by_fixed(t_s, kOther_px)).status, UpdateStatus::gated);
  }
  EXPECT_EQ(ekf.belief().status, BeliefStatus::tracking);  // a second may hold clutter
  stand_until(ekf, t_s, 1.1);
  ekf.update(by_fixed(1.1, kOther_px));
  EXPECT_EQ(ekf.belief().status, BeliefStatus::lost);
}

TEST(EkfFixedCamera, LearnsFromEveryImageHoweverManyThereAre) {
  constexpr double kPeriod_s = 0.04;
  for (const int look_images : {1, 2, 40}) {
    EkfParams params;
    params.look_images = look_images;
    EkfLocalizer ekf = standing(params, 1.0, from_deg(10.0));
    const Eigen::Matrix3d prior = ekf.belief().covariance.inverse();
    const auto learnt = [&] { return (ekf.belief().covariance.inverse() - prior).norm(); };
    double after_100 = 0.0;
    for (int i = 1; i <= 400; ++i) {
      stand_until(ekf, kPeriod_s * (i - 1), kPeriod_s * i);
      EXPECT_EQ(ekf.update(by_fixed(kPeriod_s * i)).status, UpdateStatus::fused);
      if (i == 100) after_100 = learnt();
    }
    EXPECT_NEAR(learnt() / after_100, 4.0, 0.2) << look_images;
  }
}

TEST(EkfFixedCamera, ItsImagesBesideAHeadsLookAreNoFirstImages) {
  // Each 3.5 σ off, to the left and to the right in turn: as first images of five looks they could
  // not be chance.
  EkfLocalizer ekf = standing({}, 0.001, from_deg(0.01));
  ASSERT_EQ(ekf.update(by_head(3, 0.0)).status, UpdateStatus::fused);
  for (int i = 1; i <= 6; ++i) {
    stand_until(ekf, 0.1 * (i - 1), 0.1 * i);
    EXPECT_EQ(ekf.update(by_fixed(0.1 * i, i % 2 == 0 ? 3.5 : -3.5)).status, UpdateStatus::fused);
  }
  EXPECT_EQ(ekf.belief().status, BeliefStatus::tracking);
}

}  // namespace
}  // namespace vigia::localization
