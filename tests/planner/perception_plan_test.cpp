#include "vigia/planner/perception_plan.hpp"

#include "armingol.hpp"
#include "zoom_schedule.hpp"

#include <array>
#include <set>

#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

class PlanOfArmingol : public ::testing::Test {
 protected:
  PlanOfArmingol()
      : visibility_(armingol_.visibility()),
        supervisors_(FuzzyRules{}),
        plan_(plan_perception(armingol_.path, armingol_.world.landmarks, visibility_,
                              armingol_.head, supervisors_, {})) {}

  test::Armingol armingol_;
  Visibility visibility_;
  FuzzySupervisors supervisors_;
  PerceptionPlan plan_;
};

TEST_F(PlanOfArmingol, ListsTheVisibleLandmarksOfTable1) {
  const std::vector<std::set<LandmarkId>> table1{{0, 4, 6}, {4}, {1, 2, 3}, {1, 2, 3},
                                                 {2, 3, 4}, {4}, {0, 6}};
  ASSERT_EQ(plan_.areas.size(), table1.size());
  for (std::size_t i = 0; i < table1.size(); ++i) {
    std::set<LandmarkId> visible;
    for (const LandmarkStudy& study : plan_.areas[i].visible) visible.insert(study.id);
    EXPECT_EQ(visible, table1[i]) << "area " << i;
  }
}

TEST_F(PlanOfArmingol, ChoosesTheLandmarksOfTable1) {
  const std::vector<LandmarkId> table1{6, 4, 2, 3, 2, 4, 0};
  for (std::size_t i = 0; i < table1.size(); ++i)
    EXPECT_EQ(plan_.areas[i].chosen, table1[i]) << "area " << i;
}

TEST_F(PlanOfArmingol, GivesTheSuitabilityOfTable1WithinFivePoints) {
  // A fit: the rule base was searched for this.
  const std::vector<double> table1{0.76, 0.63, 0.93, 0.93, 0.97, 0.35, 0.41};
  for (std::size_t i = 0; i < table1.size(); ++i)
    EXPECT_NEAR(plan_.areas[i].find(*plan_.areas[i].chosen)->suitability, table1[i], 0.05)
        << "area " << i;
}

TEST_F(PlanOfArmingol, PreselectsOnlyLandmarksThatAreVisibleAndSuitable) {
  for (const AreaPlan& area : plan_.areas) {
    ASSERT_FALSE(area.preselected.empty());
    EXPECT_EQ(area.preselected.front(), *area.chosen);
    for (const LandmarkId id : area.preselected) {
      ASSERT_NE(area.find(id), nullptr);
      EXPECT_GE(area.find(id)->suitability, PerceptionParams{}.reject);
    }
  }
}

TEST_F(PlanOfArmingol, HasOneZoomAGroupAndALongerOneForFartherLandmarks) {
  for (std::size_t g = 1; g < supervisors_.zoom_group_count(); ++g)
    EXPECT_GT(supervisors_.zoom_distance(g), supervisors_.zoom_distance(g - 1));
  for (const AreaPlan& a : plan_.areas)
    for (const AreaPlan& b : plan_.areas) EXPECT_EQ(a.group == b.group, a.zoom_mm == b.zoom_mm);
}

TEST_F(PlanOfArmingol, EveryStationHasItsArea) {
  EXPECT_EQ(plan_.at(0.0), &plan_.areas.front());
  EXPECT_EQ(plan_.at(4.0), &plan_.areas[1]);
  EXPECT_EQ(plan_.at(1e3), &plan_.areas.back());
}

/// Where one term of the view angle has the whole say. Between them the centroid of clipped terms
/// ripples.
constexpr std::array<double, 4> kCores{15.0, 25.75, 50.0, 80.0};

TEST(SuitabilitySupervisor, IsNeverBetterUnderALargerViewAngle) {
  FuzzySupervisors supervisors{FuzzyRules{}};
  for (double d = 0.6; d <= 9.0; d += 0.1)
    for (std::size_t i = 1; i < kCores.size(); ++i)
      EXPECT_LE(supervisors.suitability(d, from_deg(kCores[i])),
                supervisors.suitability(d, from_deg(kCores[i - 1])) + 1e-9)
          << d << " m, " << kCores[i] << "°";
}

TEST(SuitabilitySupervisor, IsBestAtMiddleDistances) {
  FuzzySupervisors supervisors{FuzzyRules{}};
  for (const double angle : {0.0, 15.0, 40.0, 55.0}) {
    EXPECT_LT(supervisors.suitability(1.0, from_deg(angle)),
              supervisors.suitability(3.0, from_deg(angle)));
    EXPECT_LT(supervisors.suitability(8.5, from_deg(angle)),
              supervisors.suitability(3.0, from_deg(angle)));
  }
}

TEST(SuitabilitySupervisor, ReachesTheHighestValueOfTable1) {
  FuzzySupervisors supervisors{FuzzyRules{}};
  EXPECT_GT(supervisors.suitability(3.0, 0.0), 0.92);
  EXPECT_LT(supervisors.suitability(9.0, from_deg(60.0)), 0.02);
}

TEST(ChoiceSupervisor, PrefersWhatLiesAheadToWhatLiesBehindWhileThePositionAcrossIsUncertain) {
  FuzzySupervisors supervisors{FuzzyRules{}};
  const Eigen::Matrix2d across = Eigen::Vector2d(0.01 * 0.01, 0.06 * 0.06).asDiagonal();
  EXPECT_GT(supervisors.choice({1.0, 0.1}, across), supervisors.choice({-1.0, 0.1}, across) + 0.3);
  EXPECT_GT(supervisors.choice({0.0, 1.0}, across), supervisors.choice({-1.0, 0.1}, across) + 0.3);
  EXPECT_EQ(supervisors.choice({1.0, 0.5}, across), supervisors.choice({1.0, -0.5}, across));
}

TEST(ChoiceSupervisor, PrefersTheSightLineAlongTheHeadingWhileThatAxisIsUncertain) {
  FuzzySupervisors supervisors{FuzzyRules{}};
  const Eigen::Matrix2d along = Eigen::Vector2d(0.06 * 0.06, 0.01 * 0.01).asDiagonal();
  EXPECT_GT(supervisors.choice({1.0, 0.0}, along), supervisors.choice({0.0, 1.0}, along) + 0.3);
  EXPECT_GT(supervisors.choice({-1.0, 0.0}, along), supervisors.choice({0.0, 1.0}, along) + 0.3);
}

TEST(FuzzySupervisors, RefuseARuleBaseWithOtherInputs) {
  FuzzyRules rules;
  rules.choice = rules.suitability;
  try {
    const FuzzySupervisors supervisors(rules);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "config/fuzzy/suitability.fll:1:1: the inputs must be bearing_deg, "
                 "sigma_along_cm, sigma_across_cm, in this order");
  }
}

TEST(ZoomSchedule, ChangesTheGroupAsRarelyAsCanBe) {
  // The middle area's better option is another group.
  const auto taken =
      schedule_zoom({{{0, 8.0, 0.5}}, {{0, 8.0, 0.3}, {1, 13.0, 0.9}}, {{0, 8.0, 0.5}}}, 0.0);
  EXPECT_EQ(taken[1], 0U);
}

TEST(ZoomSchedule, TakesTheMoreSuitableOfTwoWithAsManyChangesLessTheTravel) {
  const std::vector<std::vector<ZoomOption>> areas{
      {{1, 13.0, 0.5}}, {{0, 8.0, 0.80}, {2, 20.0, 0.85}}, {{1, 13.0, 0.5}}};
  EXPECT_EQ(schedule_zoom(areas, 0.0)[1], 1U);
  EXPECT_EQ(schedule_zoom(areas, 0.02)[1], 0U);
}

TEST(ZoomSchedule, AnAreaWithoutAnOptionIsPassed) {
  const auto taken =
      schedule_zoom({{}, {{1, 13.0, 0.5}}, {}, {{0, 8.0, 0.9}, {1, 13.0, 0.2}}}, 0.0);
  EXPECT_EQ(taken[0], std::nullopt);
  EXPECT_EQ(taken[2], std::nullopt);
  EXPECT_EQ(taken[3], 1U);
  EXPECT_EQ(schedule_zoom({{}, {}}, 0.0).size(), 2U);
}

}  // namespace
}  // namespace vigia::planner
