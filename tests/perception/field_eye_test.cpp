#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"
#include "vigia/mission/setup.hpp"
#include "vigia/perception/eye.hpp"

namespace vigia::perception {
namespace {

const mission::MissionSetup& soccer() {
  static const mission::MissionSetup setup = mission::load_mission(
      std::string(VIGIA_SOURCE_DIR) + "/config/missions/soccer.yaml", {"disturbances={}"});
  return setup;
}

std::unique_ptr<Eye> field_eye(const mission::MissionSetup& setup) {
  EyeParts parts{setup.world.landmarks, setup.on_ground()};
  parts.field = &*setup.world.field;
  parts.hull = {setup.robot.robot.radius_m, setup.robot.robot.body_height_m};
  return find_name(eyes(), "field")->make(parts);
}

/// What the eye makes of the picture from a pose.
FieldScan scan_from(Eye& eye, const Pose2& pose, std::uint64_t seed) {
  const mission::MissionSetup& setup = soccer();
  sim::Simulator simulator(setup.robot, setup.world, setup.appearance, pose, seed);
  simulator.advance(Duration{40'000'000});
  Shot shot;
  shot.stamp = simulator.robot().truth().stamp;
  shot.model = setup.robot.rig().cameras.front().model(0.0);
  const auto frame = simulator.expose(0);
  const auto seen = eye.observe({*frame, shot}, {}, std::nullopt);
  return std::get<FieldObservation>(seen.at(0)).scan;
}

/// Offset of a point from the map's nearest line, in its σ across that line and in metres.
struct PointError {
  double sigmas = 1e9;
  double metres = 1e9;
};

PointError error_of(const FieldPoint& point, const Pose2& pose, const FieldMap& field) {
  const Eigen::Rotation2Dd wRr(pose.theta);
  const Eigen::Vector2d p = pose.position() + wRr * point.p_r;
  PointError nearest;
  for (const FieldLine& line : field.lines) {
    const LineOffset offset = line_offset(line, p);
    if (offset.inside_m < -0.1 || std::abs(offset.distance_m) > nearest.metres) continue;
    const Eigen::Vector2d n = wRr.inverse() * offset.normal;
    nearest.metres = std::abs(offset.distance_m);
    // The measurement model adds 2 mm of its own (FieldModelParams::floor_m).
    nearest.sigmas = offset.distance_m / std::sqrt(n.dot(point.covariance * n) + 4e-6);
  }
  return nearest;
}

TEST(FieldEye, ItsLinePointsLieOnTheFieldsLinesAsTheirCovarianceSays) {
  const mission::MissionSetup& setup = soccer();
  const auto eye = field_eye(setup);
  RandomStream random(11, "poses");
  int points = 0;
  int off = 0;
  double nees = 0.0;
  constexpr int kPoses = 25;
  for (int i = 0; i < kPoses; ++i) {
    const double x = random.uniform(-5.0, 5.0);
    const double y = random.uniform(-3.0, 3.0);
    const Pose2 pose{x, y, random.uniform(-kPi, kPi)};
    for (const FieldPoint& point : scan_from(*eye, pose, 1 + static_cast<unsigned>(i)).points) {
      const PointError error = error_of(point, pose, *setup.world.field);
      ++points;
      if (error.metres > 0.3 || std::abs(error.sigmas) > 6.0)
        ++off;
      else
        nees += error.sigmas * error.sigmas;
    }
  }
  RecordProperty("points", points);
  RecordProperty("off", off);
  RecordProperty("nees", std::to_string(nees / (points - off)));
  // 3,270, 7 of them off, and 0.32: the 2 mm are for real floors.
  EXPECT_GT(points, 100 * kPoses);
  EXPECT_LT(off, points / 100);
  EXPECT_GT(nees / (points - off), 0.2);
  EXPECT_LT(nees / (points - off), 0.5);
}

TEST(FieldEye, AGoalIsSightedWhereItStands) {
  const auto eye = field_eye(soccer());
  const Pose2 pose{-3.0, 0.4, 2.8};
  const FieldScan scan = scan_from(*eye, pose, 3);
  const auto goal = std::find_if(scan.goals.begin(), scan.goals.end(), [](const auto& seen) {
    return seen.colour == FieldColour::yellow;
  });
  ASSERT_NE(goal, scan.goals.end());
  const Eigen::Vector2d seen =
      pose.position() + goal->range_m * unit_vector(pose.theta + goal->bearing);
  EXPECT_LT((seen - Eigen::Vector2d(-6.0, 0.0)).norm(), 0.45);  // 3σ of a goal's ends
}

TEST(FieldEye, WithoutAFieldItObservesNothing) {
  const mission::MissionSetup& setup = soccer();
  const auto eye = find_name(eyes(), "field")->make({setup.world.landmarks, setup.on_ground()});
  sim::Simulator simulator(setup.robot, setup.world, setup.appearance, {}, 1);
  simulator.advance(Duration{40'000'000});
  const auto frame = simulator.expose(0);
  Shot shot;
  shot.model = setup.robot.rig().cameras.front().model(0.0);
  EXPECT_TRUE(eye->observe({*frame, shot}, {}, std::nullopt).empty());
}

}  // namespace
}  // namespace vigia::perception
