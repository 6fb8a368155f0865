#include "pattern_policy.hpp"

#include "look_room.hpp"

#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

/// The robot stands at (4, 3.5). Pattern 1 is frontal at 3.5 m, 2 oblique at 4.3 m, tag 3 oblique
/// at 4.6 m, 5 hidden by a wall, disc 6 oblique and nearest.
class PatternPolicyTest : public ::testing::Test {
 protected:
  PatternPolicyTest() {
    room_.plan = FloorPlan({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8,
                           {{{2.0, 2.0}, {2.0, 5.5}, 2.8}}, {});
    room_.landmarks = LandmarkMap({{1, wall_mount({4.15, 7.0, 1.2}, -0.5 * kPi), PatternShape{}},
                                   {2, wall_mount({6.5, 0.0, 1.2}, 0.5 * kPi), PatternShape{}},
                                   {3, wall_mount({7.2, 7.0, 1.2}, -0.5 * kPi), TagShape{}},
                                   {5, wall_mount({0.0, 5.0, 1.2}, 0.0), PatternShape{}},
                                   {6, wall_mount({6.0, 0.0, 1.2}, 0.5 * kPi), DiscShape{}}});
  }

  std::optional<LandmarkId> choose() {
    const auto choice = policy_.choose(room_.context());
    return choice ? std::optional(choice->landmark) : std::nullopt;
  }

  PatternPolicy policy_;
  test::LookRoom room_;
};

TEST_F(PatternPolicyTest, TakesTheNearestThatIsNotFrontal) {
  EXPECT_EQ(choose(), 2);
}

TEST_F(PatternPolicyTest, AFrontalOneWillDoForASmallerAngle) {
  policy_ = PatternPolicy(0.0);
  EXPECT_EQ(choose(), 1);
}

TEST_F(PatternPolicyTest, TakesATagWhenThePatternFailedLately) {
  room_.excluded = {2};
  EXPECT_EQ(choose(), 3);
}

TEST_F(PatternPolicyTest, LooksAtNothingRatherThanAtWhatIsHiddenFrontalOrADisc) {
  room_.excluded = {2, 3};
  EXPECT_EQ(choose(), std::nullopt);
}

TEST_F(PatternPolicyTest, TooFarIsTooFar) {
  VisibilityParams near;
  near.max_range_m = 4.4;
  room_.visibility = Visibility(room_.plan, HeadGeometry{}, HeadLimits{}, near);
  room_.excluded = {2};
  EXPECT_EQ(choose(), std::nullopt);
}

}  // namespace
}  // namespace vigia::planner
