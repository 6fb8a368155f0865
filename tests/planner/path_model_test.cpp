#include "vigia/planner/path_model.hpp"

#include "armingol.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

class PathModelTest : public ::testing::Test {
 protected:
  PathModel model(const Path& path, const PathModelParams& params = {}) const {
    const Visibility visibility(plan_, HeadGeometry{}, HeadLimits{}, VisibilityParams{});
    return model_path(path, landmarks_, visibility, params);
  }
  FloorPlan plan_{{{0.0, 0.0}, {40.0, 0.0}, {40.0, 20.0}, {0.0, 20.0}}, 2.8, {}, {}};
  LandmarkMap landmarks_;
};

TEST_F(PathModelTest, AStraightPathHasAPositionEveryMetreAndAnAreaEveryThree) {
  const PathModel straight = model(Path({{1.0, 5.0}, {13.0, 5.0}}));
  EXPECT_TRUE(straight.turn_points.empty());
  ASSERT_EQ(straight.areas.size(), 4U);
  double station = 0.5;
  for (const ControlArea& area : straight.areas) {
    EXPECT_NEAR(area.to_m - area.from_m, 3.0, 1e-9);
    ASSERT_EQ(area.positions.size(), 3U);
    for (const ControlPosition& position : area.positions) {
      EXPECT_NEAR(position.station_m, station, 1e-9);
      EXPECT_NEAR(position.pose.x, 1.0 + station, 1e-9);
      EXPECT_EQ(position.pose.theta, 0.0);
      station += 1.0;
    }
  }
}

TEST_F(PathModelTest, ACornerIsATurnPointAndTheControlPositionOnItIsLeftOut) {
  const PathModel corner = model(Path({{1.0, 5.0}, {2.5, 5.0}, {2.5, 6.5}}));
  ASSERT_EQ(corner.turn_points.size(), 1U);
  EXPECT_NEAR(corner.turn_points[0], 1.5, 0.02);
  ASSERT_EQ(corner.areas.size(), 1U);
  ASSERT_EQ(corner.areas[0].positions.size(), 2U);
  EXPECT_NEAR(corner.areas[0].positions[0].station_m, 0.5, 1e-9);
  EXPECT_NEAR(corner.areas[0].positions[1].station_m, 2.5, 1e-9);
}

TEST_F(PathModelTest, AWideBendIsNoTurnPoint) {
  std::vector<Eigen::Vector2d> bend;
  for (int i = 0; i <= 90; ++i)
    bend.emplace_back(5.0 + 3.0 * std::sin(from_deg(i)), 5.0 - 3.0 * std::cos(from_deg(i)));
  EXPECT_TRUE(model(Path(bend)).turn_points.empty());
}

TEST_F(PathModelTest, AnAreaEndsWhereTheDistanceToALandmarkHasChangedTooMuch) {
  // 4.4 m, 3.4 m and 2.4 m from the disc, then 1.4 m: less than a third of the first.
  landmarks_ = LandmarkMap({{1, wall_mount({10.0, 5.0, 1.0}, kPi), DiscShape{0.1}}});
  PathModelParams params;
  params.area_m = 10.0;
  const PathModel split = model(Path({{5.0, 5.0}, {9.0, 5.0}}), params);
  ASSERT_EQ(split.areas.size(), 2U);
  EXPECT_NEAR(split.areas[0].to_m, 3.0, 1e-9);
  params.distance_ratio = 4.0;
  EXPECT_EQ(model(Path({{5.0, 5.0}, {9.0, 5.0}}), params).areas.size(), 1U);
}

TEST_F(PathModelTest, TheAreasCoverThePathWithoutGaps) {
  const PathModel bent = model(Path({{1.0, 1.0}, {8.7, 1.0}, {8.7, 7.3}, {2.0, 9.0}}));
  EXPECT_EQ(bent.areas.front().from_m, 0.0);
  EXPECT_NEAR(bent.areas.back().to_m,
              Path({{1.0, 1.0}, {8.7, 1.0}, {8.7, 7.3}, {2.0, 9.0}}).length(), 1e-9);
  for (std::size_t i = 1; i < bent.areas.size(); ++i)
    EXPECT_EQ(bent.areas[i].from_m, bent.areas[i - 1].to_m);
  for (std::size_t i = 0; i < bent.areas.size(); ++i)
    EXPECT_EQ(bent.area_at(0.5 * (bent.areas[i].from_m + bent.areas[i].to_m)), i);
  EXPECT_EQ(bent.area_at(-1.0), 0U);
  EXPECT_EQ(bent.area_at(1e3), bent.areas.size() - 1);
}

TEST_F(PathModelTest, AShortPathHasOnePositionInItsMiddle) {
  const PathModel tiny = model(Path({{1.0, 5.0}, {1.6, 5.0}}));
  ASSERT_EQ(tiny.areas.size(), 1U);
  ASSERT_EQ(tiny.areas[0].positions.size(), 1U);
  EXPECT_NEAR(tiny.areas[0].positions[0].station_m, 0.3, 1e-9);
}

TEST(PathModelOfArmingol, HasSevenControlAreasAndFourTurnPoints) {
  const test::Armingol armingol;
  const PathModel model =
      model_path(armingol.path, armingol.world.landmarks, armingol.visibility(), {});
  ASSERT_EQ(model.turn_points.size(), 4U);
  const std::vector<double> corners{2.0, 8.5, 13.0, 19.6};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(model.turn_points[i], corners[i], 0.1);
  EXPECT_EQ(model.areas.size(), 7U);
}

}  // namespace
}  // namespace vigia::planner
