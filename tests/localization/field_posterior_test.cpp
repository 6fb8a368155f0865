#include "vigia/localization/field_posterior.hpp"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia::localization {
namespace {

/// The half-way line and two touch lines.
FieldModel three_lines() {
  FieldMap map;
  map.lines = {FieldLine::segment({-6.0, 4.0}, {6.0, 4.0}, 0.125),
               FieldLine::segment({-6.0, -4.0}, {6.0, -4.0}, 0.125),
               FieldLine::segment({0.0, -4.0}, {0.0, 4.0}, 0.125)};
  return FieldModel(map);
}

FieldPoint point_at(const Pose2& pose, const Eigen::Vector2d& p_w, RandomStream& random) {
  const Eigen::Vector2d to = p_w - pose.position();
  return polar_point(std::atan2(to.y(), to.x()) - pose.theta + 0.005 * random.normal(),
                     to.norm() + 0.05 * random.normal(), 0.005, 0.05);
}

/// Eight points on each line, and a false one @p false_off beside the half-way line.
std::vector<FieldPoint> points_from(const Pose2& pose, int false_points, double false_off,
                                    RandomStream& random) {
  std::vector<FieldPoint> points;
  for (int i = 0; i < 8; ++i) {
    const double s = 0.4 * i - 1.0;
    points.push_back(point_at(pose, {pose.x + s, 4.0}, random));
    points.push_back(point_at(pose, {pose.x + s, -4.0}, random));
    points.push_back(point_at(pose, {0.0, s}, random));
  }
  for (int i = 0; i < false_points; ++i)
    points.push_back(point_at(pose, {false_off, 0.5 * i - 1.0}, random));
  return points;
}

const Pose2 kTruth{-2.0, 0.3, 0.2};

FieldFix refined(const FieldModel& model, const std::vector<FieldPoint>& points,
                 const std::optional<Prior>& prior = std::nullopt) {
  FieldRefineParams fixed;
  fixed.clutter = 0.2;
  return refine_field_pose(model, points, kTruth, prior, fixed);
}

TEST(FieldPosterior, WithoutClutterIsAboutAsWideAsTheCurvatureSays) {
  const FieldModel model = three_lines();
  RandomStream random(1, "points");
  const auto points = points_from(kTruth, 0, 0.0, random);
  const FieldFix fix = refined(model, points);
  const FieldPosterior posterior = posterior_about(model, points, {}, fix);
  const Eigen::Vector3d sigma = fix.covariance.diagonal().cwiseSqrt();
  const Eigen::Vector3d off = difference(posterior.mean, fix.pose);
  for (int axis = 0; axis < 3; ++axis) {
    // The curvature leaves out how the incidence of rays changes.
    EXPECT_LT(std::abs(off[axis]), sigma[axis]) << axis;
    EXPECT_NEAR(std::sqrt(posterior.covariance(axis, axis)), sigma[axis], 0.2 * sigma[axis]);
  }
}

TEST(FieldPosterior, APriorTakesPart) {
  const FieldModel model = three_lines();
  const Prior prior{kTruth, Eigen::Vector3d(1e-4, 4e-4, 1e-4).asDiagonal()};
  // Nothing seen: the prior itself, and its integral is one.
  FieldFix fix;
  fix.pose = kTruth;
  fix.clutter = 0.2;
  const FieldPosterior posterior = posterior_about(model, {}, {}, fix, prior);
  EXPECT_LT((posterior.covariance - prior.covariance).norm(), 0.015 * prior.covariance.norm());
  EXPECT_NEAR(posterior.log_evidence, 0.0, 0.02);
}

TEST(FieldPosterior, IsThatOfAFineSumWhereWhichPointsLieOnTheLineIsOpen) {
  const FieldModel model = three_lines();
  RandomStream random(2, "points");
  // Five points a little farther off than the half-way line: either they or the others are on it.
  const auto points = points_from(kTruth, 5, 0.2, random);
  const FieldFix fix = refined(model, points);
  const FieldPosterior posterior = posterior_about(model, points, {}, fix);
  FieldPosteriorParams fine;
  fine.step_sigmas = 0.8;
  fine.depth = 12.0;
  fine.max_nodes = 20000;
  const FieldPosterior reference = posterior_about(model, points, {}, fix, std::nullopt, fine);
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = std::sqrt(reference.covariance(axis, axis));
    EXPECT_NEAR(posterior.mean.vector()[axis], reference.mean.vector()[axis], 0.05 * sigma) << axis;
    EXPECT_NEAR(std::sqrt(posterior.covariance(axis, axis)), sigma, 0.05 * sigma) << axis;
  }
  EXPECT_NEAR(posterior.log_evidence, reference.log_evidence, 0.05);
}

}  // namespace
}  // namespace vigia::localization
