#include "vigia/localization/field_model.hpp"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/localization/field_refine.hpp"

namespace vigia::localization {
namespace {

FieldMap field(const char* name) {
  MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/fields/" + std::string(name) + ".yaml"),
                   "file");
  return read_field_map(reader.map("field"));
}

/// Points on long lines and a little off them, seen from a pose: not near the lines' ends nor at
/// grazing incidence, where the gradient leaves terms out.
std::vector<FieldPoint> some_points(const FieldMap& map, const Pose2& pose, RandomStream& random) {
  std::vector<FieldPoint> points;
  for (const FieldLine& line : map.lines) {
    if (line.length_m() < 3.0) continue;
    const Eigen::Vector2d p_w = line.at(random.uniform(1.0, line.length_m() - 1.0));
    const Eigen::Vector2d off(0.03 * random.normal(), 0.03 * random.normal());
    const Eigen::Vector2d to = p_w + off - pose.position();
    if (std::abs(line_offset(line, p_w).normal.dot(to.normalized())) < 0.3) continue;
    points.push_back(polar_point(std::atan2(to.y(), to.x()) - pose.theta, to.norm(), 0.005,
                                 0.02 + 0.02 * to.norm()));
  }
  return points;
}

Pose2 moved(const Pose2& pose, int axis, double step) {
  return Pose2::from_vector(pose.vector() + step * Eigen::Vector3d::Unit(axis));
}

TEST(FieldModel, GradientIsThatOfTheLogLikelihood) {
  const FieldModel model(field("msl-22x14"));
  RandomStream random(1, "gradient");
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 20; ++i) {
    const Pose2 truth{random.uniform(-9.0, 9.0), random.uniform(-6.0, 6.0),
                      random.uniform(-kPi, kPi)};
    const auto points = some_points(model.map(), truth, random);
    const Pose2 at{truth.x + 0.02, truth.y - 0.01, truth.theta + 0.004};
    const FieldLinearisation sums = model.linearise(points, at, 0.2);
    EXPECT_NEAR(sums.log_likelihood, model.log_likelihood(points, at, 0.2), 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const double slope = (model.log_likelihood(points, moved(at, axis, kStep), 0.2) -
                            model.log_likelihood(points, moved(at, axis, -kStep), 0.2)) /
                           (2.0 * kStep);
      // What the gradient leaves out – how incidence and spread change – is small beside the
      // score's standard deviation.
      EXPECT_NEAR(sums.gradient[axis], slope, 0.25 * sums.complete.diagonal().cwiseSqrt()[axis])
          << axis;
    }
  }
}

TEST(FieldModel, WhatTheGradientLeavesOutIsHowTheIncidenceChanges) {
  FieldMap map;
  map.length_m = 12.0;
  map.width_m = 8.0;
  map.lines = {FieldLine::segment({-6.0, 0.5}, {6.0, 0.5}, 0.125)};
  const FieldModel model(map);
  RandomStream random(4, "incidence");
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 50; ++i) {
    const Pose2 at{random.uniform(-2.0, 2.0), random.uniform(-3.0, -0.5),
                   random.uniform(-kPi, kPi)};
    const Eigen::Vector2d to(random.uniform(-2.0, 2.0), 0.5 + 0.05 * random.normal() - at.y);
    const double bearing = std::atan2(to.y(), to.x()) - at.theta;
    // As wide in all directions, so that the spread across the line does not change with θ.
    const std::vector<FieldPoint> point{polar_point(bearing, to.norm(), 0.04 / to.norm(), 0.04)};
    const FieldLinearisation sums = model.linearise(point, at, 0.2);
    const Eigen::Vector3d left_out(0.0, 0.0, sums.on_lines * to.x() / to.y());  // r ∂ln|n·u|/∂θ
    for (int axis = 0; axis < 3; ++axis) {
      const double slope = (model.log_likelihood(point, moved(at, axis, kStep), 0.2) -
                            model.log_likelihood(point, moved(at, axis, -kStep), 0.2)) /
                           (2.0 * kStep);
      EXPECT_NEAR(sums.gradient[axis] + left_out[axis], slope, 1e-5 * std::abs(slope) + 1e-5)
          << axis;
    }
  }
}

TEST(FieldModel, ObservedInformationIsTheGradientsSlope) {
  const FieldModel model(field("12x8"));
  RandomStream random(2, "information");
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 20; ++i) {
    const Pose2 truth{random.uniform(-5.0, 5.0), random.uniform(-3.0, 3.0),
                      random.uniform(-kPi, kPi)};
    const auto points = some_points(model.map(), truth, random);
    const FieldLinearisation at = model.linearise(points, truth, 0.2);
    for (int axis = 0; axis < 2; ++axis) {  // along x and y straight lines have no other curvature
      const Eigen::Vector3d slope =
          (model.linearise(points, moved(truth, axis, kStep), 0.2).gradient -
           model.linearise(points, moved(truth, axis, -kStep), 0.2).gradient) /
          (2.0 * kStep);
      EXPECT_NEAR(at.observed(axis, axis), -slope[axis], 0.1 * at.complete(axis, axis)) << axis;
    }
  }
}

TEST(FieldModel, GradientOfSightingsIsThatOfTheirLogLikelihood) {
  const FieldModel model(field("12x8"));
  const Pose2 pose{2.0, 1.0, 0.5};
  FieldScan scan;
  for (const FieldGoal& goal : model.map().goals) {
    const Eigen::Vector2d to = goal.centre() - pose.position();
    scan.goals.push_back({goal.colour, std::atan2(to.y(), to.x()) - pose.theta + 0.003,
                          to.norm() - 0.05, 0.005, 0.1});
  }
  const FieldLinearisation at = model.linearise_sightings(scan, pose);
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const double slope = (model.log_likelihood_of_sightings(scan, moved(pose, axis, kStep)) -
                          model.log_likelihood_of_sightings(scan, moved(pose, axis, -kStep))) /
                         (2.0 * kStep);
    EXPECT_NEAR(at.gradient[axis], slope, 1e-3 * std::abs(slope) + 1e-3) << axis;
  }
}

/// A wall of points from (from, at) to (to, at), in the robot's frame.
void add_line_ahead(double ahead, double from, double to, std::vector<FieldPoint>& points) {
  for (double y = from; y <= to; y += 0.05)
    points.push_back(polar_point(std::atan2(y, ahead), std::hypot(y, ahead), 0.001, 0.02));
}

double evidence(const FieldModel& model, const std::vector<FieldPoint>& points, const Pose2& pose) {
  return model.line_evidence(points, straight_groups(points, model.params().floor_m), pose, 0.2);
}

TEST(FieldModel, HoweverManyPointsOneLineCountsForItsPriceAtMost) {
  const FieldModel model(field("12x8"));
  std::vector<FieldPoint> halfway;
  add_line_ahead(3.0, -0.9, 0.9, halfway);
  const Pose2 right{-3.0, 3.0, 0.0};  // the half-way line, x = 0, is 3 m ahead
  const Pose2 wrong{-4.8, 2.2, 0.4};
  EXPECT_NEAR(evidence(model, halfway, right) - evidence(model, halfway, wrong),
              model.params().line_price, 0.5);
}

TEST(FieldModel, PointsByChanceOnLinesCountForLessThanALine) {
  const FieldModel model(field("12x8"));
  std::vector<FieldPoint> halfway;
  add_line_ahead(3.0, -0.9, 0.9, halfway);
  // Turned about: the same points cross the half-way line, three of them lie on it.
  const double on = evidence(model, halfway, {-3.0, 3.0, 0.0});
  EXPECT_GT(on - evidence(model, halfway, {-3.0 * std::cos(0.5), 2.0, 0.5}),
            0.5 * model.params().line_price);
}

TEST(StraightGroups, AreTheLinesOfAScanAndNothingElse) {
  std::vector<FieldPoint> points;
  add_line_ahead(2.0, -1.0, 1.0, points);
  const std::size_t first = points.size();
  add_line_ahead(-3.0, -1.5, 0.5, points);
  const std::size_t second = points.size();
  points.push_back(polar_point(1.4, 2.5, 0.001, 0.02));
  points.push_back(polar_point(-1.3, 1.2, 0.001, 0.02));
  const auto groups = straight_groups(points, 0.002);
  ASSERT_EQ(groups.size(), 2U);
  std::size_t total = 0;
  for (const StraightGroup& group : groups) {
    total += group.points.size();
    const bool of_first = group.points.front() < first;
    for (const std::size_t i : group.points) {
      EXPECT_LT(i, second);
      EXPECT_EQ(i < first, of_first);
    }
  }
  EXPECT_EQ(total, second);
  EXPECT_TRUE(straight_groups({}, 0.002).empty());
}

TEST(FieldModel, ClutterCostsNoMoreHoweverFarItLies) {
  const FieldModel model(field("12x8"));
  const Pose2 pose{1.0, 1.0, 0.3};
  const auto at = [&](double range) {
    return model.log_likelihood({polar_point(0.2, range, 0.005, 0.02)}, pose, 0.2);
  };
  EXPECT_TRUE(std::isfinite(at(500.0)));
  EXPECT_GT(at(500.0), std::log(0.2 * 0.2));
}

TEST(FieldModel, ATwinPoseOfASymmetricFieldIsAsLikely) {
  const FieldModel model(field("msl-22x14"));
  RandomStream random(3, "twins");
  const Pose2 pose{3.0, -2.0, 1.0};
  const auto points = some_points(model.map(), pose, random);
  EXPECT_TRUE(model.symmetric());
  EXPECT_NEAR(model.log_likelihood(points, pose, 0.2),
              model.log_likelihood(points, FieldModel::half_turned(pose), 0.2), 1e-6);
}

TEST(FieldModel, GoalsTellTheHalvesOfAColouredFieldApart) {
  const FieldModel model(field("12x8"));
  const Pose2 pose{2.0, 1.0, 0.5};
  FieldScan scan;
  const Eigen::Vector2d to = model.map().goal(FieldColour::blue)->centre() - pose.position();
  scan.goals.push_back(
      {FieldColour::blue, std::atan2(to.y(), to.x()) - pose.theta, to.norm(), 0.005, 0.1});
  EXPECT_GT(model.log_likelihood_of_sightings(scan, pose),
            model.log_likelihood_of_sightings(scan, FieldModel::half_turned(pose)) + 5.0);
}

TEST(FieldRefine, ExactPointsLeadBackToThePoseTheyWereSeenFrom) {
  const FieldModel model(field("12x8"));
  const Pose2 truth{-2.0, 1.2, 0.7};
  std::vector<FieldPoint> points;
  for (const FieldLine& line : model.map().lines)
    for (const double share : {0.3, 0.6}) {
      const Eigen::Vector2d to = line.at(share * line.length_m()) - truth.position();
      points.push_back(
          polar_point(std::atan2(to.y(), to.x()) - truth.theta, to.norm(), 0.002, 0.01));
    }
  const FieldFix fix = refine_field_pose(model, points, {-1.95, 1.14, 0.72});
  EXPECT_EQ(fix.status, FieldFixStatus::converged);
  EXPECT_LT(difference(fix.pose, truth).norm(), 2e-3);
}

TEST(FieldRefine, PointsOnOneLineAloneAreDegenerate) {
  const FieldModel model(field("12x8"));
  std::vector<FieldPoint> points;
  for (double y = -0.8; y <= 0.8; y += 0.1)  // parallel to the halfway line, 3 m ahead
    points.push_back(polar_point(std::atan2(y, 3.0), std::hypot(y, 3.0), 0.001, 0.01));
  const FieldFix fix = refine_field_pose(model, points, {-3.0, 3.0, 0.0});
  EXPECT_EQ(fix.status, FieldFixStatus::degenerate);
}

TEST(FieldRefine, APriorTakesPartByItsInformation) {
  const FieldModel model(field("12x8"));
  const Prior prior{{0.5, 1.5, 0.2}, Eigen::Vector3d(4e-4, 1e-4, 1e-4).asDiagonal()};
  const FieldFix fix = refine_field_pose(model, {}, prior.pose, prior);
  EXPECT_LT(difference(fix.pose, prior.pose).norm(), 1e-9);
  EXPECT_TRUE(fix.covariance.isApprox(prior.covariance, 1e-6));
  EXPECT_NEAR(log_evidence_of(model, {}, {}, fix, 0.2), 0.0, 1e-6);
}

}  // namespace
}  // namespace vigia::localization
