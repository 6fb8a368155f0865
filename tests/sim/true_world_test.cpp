#include "sim/room.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/sim/simulator.hpp"

namespace vigia::sim {
namespace {

constexpr double kWorldSigmas = 4.5;

RobotSetup robot_of_world() {
  return pan_tilt_zoom_robot(
      usual_robot(), ZoomCalibration(640, 480, 319.5, 239.5, {{8, 582, 0.06}, {48, 3490, 0.002}}));
}

Simulator simulator(const DisturbanceParams& disturbances, std::uint64_t seed) {
  return Simulator(robot_of_world(), test_room(), nullptr, {2.0, 3.0, 0.0}, seed, disturbances);
}

TEST(TrueWorld, LandmarksHangOffTheirPlacesByTheStatedErrors) {
  DisturbanceParams disturbances;
  disturbances.map_error.emplace();
  const WorldMap map = test_room();
  double off = 0.0;
  double turned = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Simulator world = simulator(disturbances, seed);
    ASSERT_EQ(world.true_world().landmarks.all().size(), map.landmarks.all().size());
    for (const Landmark& truth : world.true_world().landmarks.all()) {
      const Eigen::Isometry3d lMt = map.landmarks.find(truth.id)->wMl.inverse() * truth.wMl;
      EXPECT_NEAR(lMt.translation().z(), 0.0, 1e-12);
      off += lMt.translation().squaredNorm();
      turned += std::pow(Eigen::AngleAxisd(lMt.linear()).angle(), 2);
      ++n;
    }
  }
  EXPECT_NEAR(off / n / (2.0 * 0.005 * 0.005), 1.0, kWorldSigmas * std::sqrt(1.0 / n));
  EXPECT_NEAR(turned / n / std::pow(from_deg(1.0), 2), 1.0, kWorldSigmas * std::sqrt(2.0 / n));
}

TEST(TrueWorld, AtMostOneLandmarkInSixIsMissing) {
  DisturbanceParams disturbances;
  disturbances.missing_landmarks.emplace();
  constexpr int kSeeds = 400;
  int missing = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto left = simulator(disturbances, seed).true_world().landmarks.all().size();
    ASSERT_GE(left, 5U);
    if (left == 5U) ++missing;
  }
  // One of six is missing when any of six draws says so.
  const double share = 1.0 - std::pow(0.9, 6);
  EXPECT_NEAR(1.0 * missing / kSeeds, share,
              kWorldSigmas * std::sqrt(share * (1.0 - share) / kSeeds));
}

TEST(TrueWorld, WithoutDisturbancesItIsTheMapAndTheSamePixels) {
  const Simulator world = simulator({}, 3);
  const WorldMap map = test_room();
  for (const Landmark& landmark : map.landmarks.all())
    EXPECT_EQ(world.true_world().landmarks.find(landmark.id)->wMl.matrix(), landmark.wMl.matrix());
  const Scene plain(map, nullptr, derive_seed(3, "scene"));
  const auto direct =
      plain.expose(world.robot().camera_pose(), robot_of_world().zoom().at(8), {}, {});
  EXPECT_TRUE(imaging::grey_image(*world.expose()) == imaging::grey_image(*direct));
  EXPECT_EQ(world.latency().ns, 0);
}

TEST(TrueWorld, ClutterPutsMarksOnTheWalls) {
  DisturbanceParams disturbances;
  disturbances.clutter = ClutterParams{40, 40};
  Simulator cluttered = simulator(disturbances, 2);
  Simulator plain = simulator({}, 2);
  // All round: a mark is darker, a plate lighter than the wall by far more than the noise.
  int darker = 0;
  int lighter = 0;
  for (int turn = 0; turn < 8; ++turn) {
    const Pose2 pose{4.0, 4.0, turn * kPi / 4.0};
    cluttered.robot().kidnap(pose);
    plain.robot().kidnap(pose);
    const auto with = imaging::grey_image(*cluttered.expose());
    const auto without = imaging::grey_image(*plain.expose());
    for (unsigned i = 0; i < with.getSize(); ++i) {
      const int change = with.bitmap[i] - without.bitmap[i];
      if (change < -40) ++darker;
      if (change > 40) ++lighter;
    }
  }
  EXPECT_GT(darker, 2000);
  EXPECT_GT(lighter, 2000);
}

TEST(CameraErrors, TheFocalLengthIsOffByTheStatedRms) {
  DisturbanceParams disturbances;
  disturbances.zoom_calibration.emplace();
  const Intrinsics calibrated = camera(1000);
  double square = 0.0;
  constexpr int kSeeds = 2000;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const CameraErrors errors(disturbances, seed);
    double last = errors.true_intrinsics(calibrated, 0.0).px;
    double mean = 0.0;
    for (int i = 0; i < 50; ++i) {
      const Intrinsics truth = errors.true_intrinsics(calibrated, (i + 0.5) / 50.0);
      EXPECT_EQ(truth.px, truth.py);
      EXPECT_EQ(truth.u0, calibrated.u0);
      EXPECT_LT(std::abs(truth.px - last), 0.2 * 5.0 * 5.0);  // smooth: far below 5σ a step
      last = truth.px;
      mean += std::pow(truth.px / 1000.0 - 1.0, 2) / 50.0;
    }
    square += mean / kSeeds;
  }
  // Each seed's mean square has a relative deviation of at most √2.
  EXPECT_NEAR(square / (0.005 * 0.005), 1.0, kWorldSigmas * std::sqrt(2.0 / kSeeds));
}

TEST(CameraErrors, ThePrincipalPointDriftsAlongTheZoom) {
  DisturbanceParams disturbances;
  disturbances.principal_point.emplace();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const CameraErrors errors(disturbances, seed);
    const auto at = [&](double u) {
      const Intrinsics k = errors.true_intrinsics(camera(1000), u);
      EXPECT_EQ(k.px, 1000.0);
      return Eigen::Vector2d(k.u0, k.v0);
    };
    EXPECT_NEAR((at(1.0) - at(0.0)).norm(), 2.5, 1e-9);
    EXPECT_NEAR((at(0.5) - Eigen::Vector2d(319.5, 239.5)).norm(), 0.0, 1e-9);
  }
}

TEST(CameraErrors, TheHeadSitsAskewBySmallAnglesAndMillimetres) {
  DisturbanceParams disturbances;
  disturbances.mounting.emplace();
  double angle = 0.0;
  double offset = 0.0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Simulator askew = simulator(disturbances, seed);
    const Eigen::Isometry3d error =
        simulator({}, seed).robot().camera_pose().inverse() * askew.robot().camera_pose();
    angle += std::pow(Eigen::AngleAxisd(error.linear()).angle(), 2) / kSeeds;
    offset += error.translation().squaredNorm() / kSeeds;
  }
  // Three coordinates each; a mean square of 3n normal numbers.
  const double tolerance = kWorldSigmas * std::sqrt(2.0 / (3.0 * kSeeds));
  EXPECT_NEAR(angle / (3.0 * std::pow(from_deg(0.25), 2)), 1.0, tolerance);
  EXPECT_NEAR(offset / (3.0 * 0.003 * 0.003), 1.0, tolerance);
}

TEST(Kidnapping, PutsTheRobotElsewhereOnceAndOdometryDoesNotNotice) {
  DisturbanceParams disturbances;
  disturbances.kidnapping = KidnappingParams{2.0, 4.0, 1.5};
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Simulator world = simulator(disturbances, seed);
    int times = 0;
    for (int tick = 0; tick < 150; ++tick) {
      world.robot().command({0.1, 0.0}, {});
      const Pose2 before = world.robot().truth().pose;
      if (world.kidnap()) {
        ++times;
        const double t = world.robot().truth().stamp.seconds();
        EXPECT_GE(t, 2.0);
        EXPECT_LE(t, 4.04);
        EXPECT_GE((world.robot().truth().pose.position() - before.position()).norm(), 1.5);
        EXPECT_GE(world.clearance(), 0.2 - 1e-9);
        EXPECT_LT(std::abs(world.robot().read_odometry().trans), 0.01);
      } else {
        world.robot().read_odometry();
      }
      world.advance({40'000'000});
    }
    EXPECT_EQ(times, 1);
  }
}

}  // namespace
}  // namespace vigia::sim
