#include "vigia/localization/points_model.hpp"

#include "localization/points_views.hpp"

#include <gtest/gtest.h>

#include "vigia/localization/view_parameters.hpp"

namespace vigia::localization {
namespace {

const Intrinsics kLens{640, 480, 700.0, 710.0, 320.0, 238.0, 0.06};

Eigen::Isometry3d off_axis_pose() {
  Eigen::Isometry3d cMl = pose_of({from_deg(40.0), from_deg(25.0), from_deg(-10.0), 0.9});
  cMl.translation() += Eigen::Vector3d(0.2, -0.15, 0.0);
  return cMl;
}

/// Centroid of the area inside the image of a circle, by Green's theorem on a fine polygon.
Eigen::Vector2d area_centroid(const LandmarkPoint& dot, const Intrinsics& lens,
                              const Eigen::Isometry3d& cMl) {
  constexpr int kSides = 4000;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < kSides; ++i) {
    const double turn = 2.0 * kPi * i / kSides;
    const Eigen::Vector3d p_l(dot.centre_l.x() + dot.radius_m * std::cos(turn),
                              dot.centre_l.y() + dot.radius_m * std::sin(turn), 0.0);
    outline.push_back(*project(lens, cMl * p_l));
  }
  double area = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  const Eigen::Vector2d origin = outline.front();  // keeps the sums small
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d a = outline[i] - origin;
    const Eigen::Vector2d b = outline[(i + 1) % outline.size()] - origin;
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += 0.5 * cross;
    moment += cross / 6.0 * (a + b);
  }
  return origin + moment / area;
}

TEST(PointsModel, ADotIsSeenWhereTheCentroidOfItsImageLies) {
  const Eigen::Isometry3d cMl = off_axis_pose();
  for (const LandmarkPoint& dot : landmark_points(test::pattern(1, 0.0, 0.0, 0.0, 0.0))) {
    const auto image = predict_point(dot, kLens, cMl);
    ASSERT_TRUE(image);
    EXPECT_LT((image->uv - area_centroid(dot, kLens, cMl)).norm(), 2e-3) << dot.label;
  }
}

TEST(PointsModel, ALargeDotIsNotSeenWhereItsCentreIsProjected) {
  const Eigen::Isometry3d cMl = off_axis_pose();
  const LandmarkPoint dot{0, Eigen::Vector2d::Zero(), 0.05};
  const auto seen = predict_point(dot, kLens, cMl);
  const auto centre = project(kLens, cMl.translation());
  EXPECT_GT((seen->uv - *centre).norm(), 0.5);
  EXPECT_LT((seen->uv - area_centroid(dot, kLens, cMl)).norm(), 0.02);
}

TEST(PointsModel, ACornerIsSeenWhereItIsProjected) {
  const Eigen::Isometry3d cMl = off_axis_pose();
  for (const LandmarkPoint& corner : landmark_points(test::tag(1, 0.0, 0.0, 0.0, 0.0))) {
    const Eigen::Vector3d p_l(corner.centre_l.x(), corner.centre_l.y(), 0.0);
    EXPECT_LT((predict_point(corner, kLens, cMl)->uv - *project(kLens, cMl * p_l)).norm(), 1e-9);
  }
}

/// The largest relative error of the analytic Jacobian against central differences.
double jacobian_error(double radius, const Intrinsics& lens) {
  const Eigen::Isometry3d cMl = off_axis_pose();
  const LandmarkPoint dot{3, {0.113, -0.05}, radius};
  const auto image = predict_point(dot, lens, cMl);
  constexpr double kStep = 1e-6;
  double worst = 0.0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const PoseVector h = kStep * PoseVector::Unit(i);
    const Eigen::Vector2d numeric = (predict_point(dot, lens, moved(cMl, h))->uv -
                                     predict_point(dot, lens, moved(cMl, -h))->uv) /
                                    (2.0 * kStep);
    worst = std::max(worst, (image->duv_dpose.col(i) - numeric).norm() / numeric.norm());
  }
  Intrinsics zoomed = lens;
  zoomed.px *= std::exp(kStep);
  zoomed.py *= std::exp(kStep);
  const Eigen::Vector2d numeric = (predict_point(dot, zoomed, cMl)->uv - image->uv) / kStep;
  return std::max(worst, (image->duv_dlog_focal - numeric).norm() / numeric.norm());
}

TEST(PointsModel, JacobiansEqualFiniteDifferences) {
  Intrinsics pinhole = kLens;
  pinhole.kdu = 0.0;
  for (const double radius : {0.0, 0.012, 0.05}) EXPECT_LT(jacobian_error(radius, pinhole), 1e-5);
  EXPECT_LT(jacobian_error(0.0, kLens), 1e-5);
  // The lens's curvature over a dot is left out of the Jacobian: its share grows as the dot.
  EXPECT_LT(jacobian_error(0.012, kLens), 1e-3);
}

TEST(PointsModel, MovesAreUndoneByTheirDifference) {
  const Eigen::Isometry3d cMl = off_axis_pose();
  PoseVector delta;
  delta << 0.1, -0.2, 0.3, 0.5, -0.4, 0.2;
  EXPECT_LT((move_between(cMl, moved(cMl, delta)) - delta).norm(), 1e-12);
}

TEST(PointsModel, PointsBehindTheCameraOrSeenFromTheBackHaveNoImage) {
  Eigen::Isometry3d cMl = off_axis_pose();
  const LandmarkPoint dot{1, {0.0, 0.113}, 0.012};
  ASSERT_TRUE(predict_point(dot, kLens, cMl));
  cMl.linear().col(1) *= -1.0;
  cMl.linear().col(2) *= -1.0;
  EXPECT_FALSE(predict_point(dot, kLens, cMl));
  cMl = off_axis_pose();
  cMl.translation().z() = -0.9;
  EXPECT_FALSE(predict_point(dot, kLens, cMl));
}

TEST(PointsModel, PointsThatCannotBeUsedAreLeftOut) {
  const Landmark landmark = test::pattern(1, 0.0, 0.0, 0.0, 0.0);
  RandomStream random(1, "unused");
  PointsObservation seen = test::observe_points(landmark, kLens, off_axis_pose(), 0.1, random);
  seen.points[0].label = 17;
  seen.points[1].uv.x() = std::nan("");
  seen.points[2].covariance.setZero();
  EXPECT_EQ(seen_points(landmark, seen).size(), 14U);
  EXPECT_EQ(seen_points(landmark, seen, 0.01).size(), 15U);  // the floor mends the covariance
}

}  // namespace
}  // namespace vigia::localization
