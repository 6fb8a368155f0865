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

/// Points on lines, off them and near corners, seen from a pose.
std::vector<FieldPoint> some_points(const FieldMap& map, const Pose2& pose, RandomStream& random) {
  std::vector<FieldPoint> points;
  for (const FieldLine& line : map.lines) {
    const Eigen::Vector2d p_w = line.at(random.uniform(0.0, line.length_m()));
    const Eigen::Vector2d off(0.03 * random.normal(), 0.03 * random.normal());
    const Eigen::Vector2d to = p_w + off - pose.position();
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
      // What the gradient leaves out – how incidence, spread and ends change – is small beside it.
      EXPECT_NEAR(sums.gradient[axis], slope,
                  0.05 * sums.complete.diagonal().cwiseSqrt()[axis] + 0.02 * std::abs(slope) + 0.5)
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

TEST(FieldModel, HoweverManyPointsOneLineCountsForItsPriceAtMost) {
  const FieldModel model(field("12x8"));
  const Pose2 pose{-3.0, 3.0, 0.0};
  std::vector<FieldPoint> halfway;
  for (double y = -0.9; y <= 0.9; y += 0.05)  // 3 m ahead, x = 0
    halfway.push_back(polar_point(std::atan2(y, 3.0), std::hypot(y, 3.0), 0.001, 0.02));
  EXPECT_NEAR(model.line_evidence(halfway, pose, 0.2), model.params().line_price, 1e-9);
  const double y = 1.0;  // the touch line, y = 4
  std::vector<FieldPoint> both = halfway;
  for (double x = -0.5; x <= 0.5; x += 0.02)
    both.push_back(polar_point(std::atan2(y, x), std::hypot(x, y), 0.001, 0.02));
  EXPECT_NEAR(model.line_evidence(both, pose, 0.2), 2.0 * model.params().line_price, 1e-6);
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
  EXPECT_NEAR(log_evidence_of(model, {}, fix, 0.2), 0.0, 1e-6);
}

}  // namespace
}  // namespace vigia::localization
