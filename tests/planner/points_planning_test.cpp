#include "head_travel.hpp"
#include "look_room.hpp"
#include "zoom_classes.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/planner/apparent_size.hpp"
#include "vigia/planner/perception_plan.hpp"

namespace vigia::planner {
namespace {

constexpr double kFrontal = 25.0;     // degrees, QUIXOTE's least φ
constexpr double kUnreadable = 70.0;  // degrees
const double kReject = PerceptionParams{}.reject;

/// A room of 12 × 7 m whose path runs along y = 3.5. The patterns 1 and 2 and the tag 3 hang on the
/// long walls, the pattern 4 at the path's end, where it is frontal.
struct PointsRoom : test::LookRoom {
  PointsRoom() {
    landmarks = LandmarkMap({{1, wall_mount({4.5, 7.0, 1.6}, -0.5 * kPi), PatternShape{}},
                             {2, wall_mount({6.5, 0.0, 1.6}, 0.5 * kPi), PatternShape{}},
                             {3, wall_mount({8.0, 7.0, 1.6}, -0.5 * kPi), TagShape{3, 0.2}},
                             {4, wall_mount({12.0, 3.5, 1.2}, kPi), PatternShape{}}});
    plan = FloorPlan({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8, {}, {});
  }
  PerceptionPlan perception(const PerceptionParams& params = {}) {
    FuzzySupervisors supervisors{FuzzyRules{}};
    return plan_perception(path, landmarks, visibility, head_model, supervisors, params);
  }
};

TEST(PointsSupervisor, RejectsFrontalAndGrazingViewsAtAnyDistanceAndSize) {
  FuzzySupervisors supervisors{FuzzyRules{}};
  for (double d = 0.6; d <= 9.0; d += 0.3)
    for (const double px : {6.0, 12.0, 30.0}) {
      for (double angle = 0.0; angle < kFrontal; angle += 2.5)
        EXPECT_LT(supervisors.points_suitability(d, from_deg(angle), px), kReject);
      for (double angle = kUnreadable; angle < 90.0; angle += 2.5)
        EXPECT_LT(supervisors.points_suitability(d, from_deg(angle), px), kReject);
      EXPECT_GE(supervisors.points_suitability(d, from_deg(40.0), px), kReject);
    }
}

TEST(PointsSupervisor, RejectsWhatIsTooSmallToRead) {
  FuzzySupervisors supervisors{FuzzyRules{}};
  EXPECT_LT(supervisors.points_suitability(2.0, from_deg(40.0), 2.9), kReject);
  EXPECT_GT(supervisors.points_suitability(2.0, from_deg(40.0), 10.0), 0.9);
}

TEST(PointsSupervisor, IsNeverBetterFartherAwayOrSmaller) {
  FuzzySupervisors supervisors{FuzzyRules{}};
  // Where one term has the whole say; between them the centroid of clipped terms ripples.
  for (const double angle : {40.0, 65.0}) {
    double before = 1.0;
    for (const double d : {1.0, 4.75, 9.0}) {
      const double now = supervisors.points_suitability(d, from_deg(angle), 12.0);
      EXPECT_LE(now, before + 1e-9) << d << " m, " << angle << "°";
      EXPECT_LE(supervisors.points_suitability(d, from_deg(angle), 5.5), now + 1e-9);
      before = now;
    }
  }
}

TEST(ApparentSize, ThePointsFillTheImageAndADiscHasItsRadius) {
  const PointsRoom room;
  const HeadModel& head = room.head_model;
  for (const Landmark& landmark : room.landmarks.all()) {
    const double focal = head.zoom.at(zoom_for(landmark, 1.5, head)).px;
    EXPECT_NEAR(focal * extent_radius(landmark) / 1.5, 0.8 * 240.0, 1e-6);
  }
  const Landmark disc{9, Eigen::Isometry3d::Identity(), DiscShape{0.1}};
  EXPECT_EQ(wanted_radius(disc, head), head.radius_px);
}

TEST(ApparentSize, FeaturesAreDotsAndFieldsForeshortened) {
  const PointsRoom room;
  const auto width = [](const Landmark* landmark, double angle) {
    return *feature_width(*landmark, 2.0, from_deg(angle), 1000.0);
  };
  EXPECT_NEAR(width(room.landmarks.find(1), 0.0), 1000.0 * 2.0 * 0.012 / 2.0, 1e-9);
  EXPECT_NEAR(width(room.landmarks.find(3), 60.0), 1000.0 * 0.2 / 8.0 / 2.0 * 0.5, 1e-9);
  EXPECT_FALSE(feature_width({9, Eigen::Isometry3d::Identity(), DiscShape{}}, 2.0, 0.0, 1e3));
}

TEST(ZoomClasses, DiscsShareOneAndEachSizeOfPointsHasItsOwn) {
  const LandmarkMap map({{1, Eigen::Isometry3d::Identity(), DiscShape{0.1}},
                         {2, Eigen::Isometry3d::Identity(), DiscShape{0.08}},
                         {3, Eigen::Isometry3d::Identity(), TagShape{1, 0.2}},
                         {4, Eigen::Isometry3d::Identity(), TagShape{2, 0.3}},
                         {5, Eigen::Isometry3d::Identity(), TagShape{3, 0.2}}});
  const ZoomClasses classes(map, test::LookRoom().head_model, 4.0);
  ASSERT_EQ(classes.all().size(), 3U);
  EXPECT_EQ(classes.index_of(1), classes.index_of(2));
  EXPECT_EQ(classes.of(1).radius_m, 0.08);
  EXPECT_EQ(classes.of(1).planned_px, 24.0);
  EXPECT_EQ(classes.index_of(3), classes.index_of(5));
  EXPECT_NE(classes.index_of(3), classes.index_of(4));
  EXPECT_NEAR(classes.of(3).planned_px, 0.8 * 240.0 / 2.0, 1e-9);
}

TEST(PointsPlan, ChoosesInEveryAreaWhatIsNotFrontalAndFitsIntoTheImage) {
  PointsRoom room;
  const PerceptionPlan plan = room.perception();
  ASSERT_FALSE(plan.areas.empty());
  for (const AreaPlan& area : plan.areas) {
    ASSERT_TRUE(area.chosen);
    for (const LandmarkId id : area.preselected) {
      const Landmark& landmark = *room.landmarks.find(id);
      EXPECT_GE(area.find(id)->suitability, kReject);
      EXPECT_NE(id, 4);
      if (id == *area.chosen) continue;
      const double focal = room.head_model.zoom.at(area.zoom_mm).px;
      EXPECT_LE(focal * extent_radius(landmark) / area.find(id)->nearest_m, 0.8 * 240.0 + 1e-9);
    }
  }
}

TEST(PointsPlan, ATagTooSmallForTheLongestZoomIsRejected) {
  PointsRoom room;
  room.landmarks = LandmarkMap({{3, wall_mount({8.0, 7.0, 1.6}, -0.5 * kPi), TagShape{3, 0.02}}});
  for (const AreaPlan& area : room.perception().areas) EXPECT_FALSE(area.chosen);
  room.landmarks = LandmarkMap({{3, wall_mount({8.0, 7.0, 1.6}, -0.5 * kPi), TagShape{3, 0.2}}});
  int chosen = 0;
  for (const AreaPlan& area : room.perception().areas) chosen += area.chosen ? 1 : 0;
  EXPECT_GT(chosen, 0);
}

struct FuzzyOnPoints : ::testing::Test {
  std::optional<LookChoice> choose() {
    const auto parts = room.parts();
    const auto policy = make_look_policy("fuzzy", parts);
    policy->follow(room.path);
    return policy->choose(room.context());
  }
  PointsRoom room;
};

TEST_F(FuzzyOnPoints, TakesOneThatIsNotFrontalMovingAndStanding) {
  for (const bool standing : {false, true}) {
    room.standing = standing;
    const auto choice = choose();
    ASSERT_TRUE(choice);
    const Landmark& landmark = *room.landmarks.find(choice->landmark);
    EXPECT_GE(room.visibility.view_angle(landmark, room.belief.pose), from_deg(kFrontal));
    EXPECT_GE(*choice->suitability, kReject);
  }
}

TEST_F(FuzzyOnPoints, LooksAtNothingRatherThanAtAFrontalPattern) {
  room.excluded = {1, 2, 3};
  EXPECT_FALSE(choose());
}

TEST_F(FuzzyOnPoints, TheZoomsTravelIsForeseenForTheSizeThatTheLandmarkWillHave) {
  room.standing = true;
  room.head.zoom_mm = 8.0;
  const Landmark& pattern = *room.landmarks.find(2);
  const double zoom_mm =
      zoom_for(pattern, room.visibility.range(pattern, room.belief.pose), room.head_model);
  const double seconds = (zoom_mm - 8.0) / room.head_model.limits.zoom_rate_mm_s;
  EXPECT_GT(seconds, 1.0);
  EXPECT_NEAR(foresee(pattern, std::nullopt, room.context()).seconds, seconds, 1e-9);
}

}  // namespace
}  // namespace vigia::planner
