#include "vigia/core/landmark.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/belief.hpp"
#include "vigia/core/observation.hpp"

namespace vigia {
namespace {

Landmark disc(LandmarkId id) {
  Landmark landmark;
  landmark.id = id;
  landmark.shape = DiscShape{0.12};
  return landmark;
}

TEST(LandmarkMap, IsSortedByIdAndFindsById) {
  const LandmarkMap map({disc(6), disc(0), disc(3)});
  ASSERT_EQ(map.all().size(), 3U);
  EXPECT_EQ(map.all()[0].id, 0);
  EXPECT_EQ(map.all()[2].id, 6);
  ASSERT_NE(map.find(3), nullptr);
  EXPECT_EQ(map.find(3)->id, 3);
  EXPECT_EQ(map.find(5), nullptr);
  EXPECT_EQ(map.find(7), nullptr);
}

TEST(LandmarkMap, RejectsAnIdThatOccursTwice) {
  try {
    const LandmarkMap map({disc(6), disc(0), disc(6)});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("id 6 occurs twice"));
  }
}

TEST(Landmark, OnAWallHasItsNormalOutwardsAndItsPictureUpright) {
  // Seen by a viewer who stands in the normal's direction, x is to the right and y is up.
  const Eigen::Isometry3d wMl = wall_mount({1.0, 2.0, 1.5}, from_deg(90.0));
  EXPECT_LT((wMl.linear().col(2) - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((wMl.linear().col(1) - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((wMl.linear().col(0) + Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_NEAR(wMl.linear().determinant(), 1.0, 1e-15);
}

TEST(Landmark, TellsTheRadiusOfItsDisc) {
  EXPECT_EQ(disc_radius(disc(1)), 0.12);
}

TEST(Landmark, ItsExtentHoldsAllOfItsFeatures) {
  EXPECT_EQ(extent_radius(disc(1)), 0.12);
  Landmark other = disc(1);
  other.shape = PatternShape{};
  EXPECT_NEAR(extent_radius(other), 0.113 + 0.012, 1e-12);
  other.shape = TagShape{3, 0.2};
  EXPECT_NEAR(extent_radius(other), 0.1 * std::sqrt(2.0), 1e-12);
}

TEST(Observation, OfTheInnerRingAloneShowsTheWholePatternsExtent) {
  Landmark landmark = disc(1);
  landmark.shape = PatternShape{};
  PointsObservation seen;
  constexpr double kPxPerM = 1000.0;
  for (const PatternDot& dot : pattern_dots({}))
    if (dot.label > kDotsPerRing)
      seen.points.push_back({dot.label, Eigen::Vector2d(300.0, 200.0) + kPxPerM * dot.centre_l,
                             Eigen::Matrix2d::Identity()});
  const ImageExtent extent = image_extent(seen, &landmark);
  EXPECT_NEAR((extent.centre - Eigen::Vector2d(300.0, 200.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(extent.radius_px, kPxPerM * extent_radius(landmark), 1e-9);
}

TEST(Observation, GivesTheShotThatShowsIt) {
  EllipseObservation seen;
  seen.shot.look = 7;
  EXPECT_EQ(shot_of(seen).look, 7);
}

TEST(Belief, ItsPositionSigmaIsTheLongestAxisOfTheEllipse) {
  Belief belief;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.7).toRotationMatrix();
  belief.covariance.topLeftCorner<2, 2>() =
      turn * Eigen::Vector2d(0.09, 0.01).asDiagonal() * turn.transpose();
  EXPECT_NEAR(belief.position_sigma(), 0.3, 1e-15);
}

}  // namespace
}  // namespace vigia
