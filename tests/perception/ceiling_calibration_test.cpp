#include "vigia/perception/ceiling_calibration.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/evaluation/ceiling_views.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::perception {
namespace {

constexpr double kTiltSigma = from_deg(1.0);
constexpr double kHeightSigma = 0.03;

evaluation::CeilingSetting mounted_as_drawn(std::uint64_t seed) {
  RandomStream random(seed, "mounting");
  evaluation::CeilingSetting setting;
  setting.seed = setting.ceiling.seed = seed;
  setting.ceiling.grid.placement_m = 0.005;
  setting.ceiling.grid.placement_turn = from_deg(1.3);
  const Eigen::Vector2d tilt(kTiltSigma * random.normal(), kTiltSigma * random.normal());
  setting.tilt = tilt.norm();
  setting.tilt_axis = std::atan2(tilt.y(), tilt.x());
  setting.height_error = kHeightSigma * random.normal();
  return setting;
}

CeilingView view_of(const evaluation::CeilingSetting& setting) {
  CeilingView view;
  view.camera = setting.camera;
  view.rise_m = setting.known_camera().rise_m();
  view.grid = setting.ceiling.grid;
  view.tilt_sigma = kTiltSigma;
  view.height_sigma = kHeightSigma;
  return view;
}

/// Forty pictures over 4 m, turning by 92°.
CeilingCalibration driven(const evaluation::CeilingSetting& setting) {
  CeilingCalibration calibration(view_of(setting));
  const evaluation::CeilingHall hall(setting);
  Pose2 pose{3.3, -7.2, 0.4};
  for (int i = 0; i < 40; ++i) {
    calibration.next(imaging::grey_image(*hall.expose(pose, i)), Stamp::from_seconds(0.1 * i));
    pose = compose(pose, {0.1, 0.0, 0.04});
  }
  return calibration;
}

TEST(CeilingCalibration, ErrsByWhatItsCovarianceStates) {
  constexpr int kDrives = 12;
  Eigen::Vector3d nees = Eigen::Vector3d::Zero();
  for (int seed = 1; seed <= kDrives; ++seed) {
    const auto setting = mounted_as_drawn(static_cast<std::uint64_t>(seed));
    const auto result = driven(setting).result();
    const Eigen::Vector3d error = result.errors.vector() - setting.true_errors().vector();
    nees += error.cwiseAbs2().cwiseQuotient(result.covariance.diagonal()) / kDrives;
  }
  // χ²(12)/12 exceeds 2.4 once in 200.
  EXPECT_LT(nees[0], 2.4);
  EXPECT_LT(nees[1], 2.4);
  EXPECT_LT(nees[2], 2.4);
  EXPECT_GT(nees[2], 0.25);
}

TEST(CeilingCalibration, WithoutAPatchKnowsWhatItKnewBefore) {
  const auto setting = mounted_as_drawn(1);
  CeilingCalibration calibration(view_of(setting));
  calibration.next(vpImage<unsigned char>(480, 640, 180), Stamp{});
  const auto result = calibration.result();
  EXPECT_EQ(result.errors.vector(), Eigen::Vector3d::Zero());
  EXPECT_NEAR(std::sqrt(result.covariance(0, 0)), kTiltSigma, 1e-5);
  EXPECT_NEAR(std::sqrt(result.covariance(2, 2)), kHeightSigma, 1e-9);
}

/// A drive that tells little is not drawn twice towards what it tells.
TEST(CeilingCalibration, OnePictureLeavesThePriorItsShare) {
  evaluation::CeilingSetting setting = mounted_as_drawn(2);
  CeilingCalibration calibration(view_of(setting));
  const evaluation::CeilingHall hall(setting);
  const auto picture = imaging::grey_image(*hall.expose({3.3, -7.2, 0.4}, 0));
  calibration.next(picture, Stamp{});
  CeilingFollower once(view_of(setting));
  once.next(picture, Stamp{});
  const Eigen::Vector3d sigma = calibration.result().covariance.diagonal().cwiseSqrt();
  const Eigen::Vector3d off = calibration.result().errors.vector() - once.camera_errors().vector();
  EXPECT_LT(off.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 0.3);
}

}  // namespace
}  // namespace vigia::perception
