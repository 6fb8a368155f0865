#include "pattern_policy.hpp"

#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

class NoInformation final : public InformationModel {
 public:
  std::optional<Eigen::Matrix3d> look_information(const Landmark&, const Pose2&) const override {
    return std::nullopt;
  }
};

/// The robot stands at (4, 3.5). Pattern 1 is frontal at 3.5 m, 2 oblique at 4.3 m, tag 3 oblique
/// at 4.6 m, 5 hidden by a wall, disc 6 oblique and nearest.
class PatternPolicyTest : public ::testing::Test {
 protected:
  PatternPolicyTest()
      : plan_({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8,
              {{{2.0, 2.0}, {2.0, 5.5}, 2.8}}, {}),
        visibility_(plan_, HeadGeometry{}, HeadLimits{}, VisibilityParams{}),
        path_({{3.0, 3.5}, {9.0, 3.5}}),
        landmarks_({{1, wall_mount({4.15, 7.0, 1.2}, -0.5 * kPi), PatternShape{}},
                    {2, wall_mount({6.5, 0.0, 1.2}, 0.5 * kPi), PatternShape{}},
                    {3, wall_mount({7.2, 7.0, 1.2}, -0.5 * kPi), TagShape{}},
                    {5, wall_mount({0.0, 5.0, 1.2}, 0.0), PatternShape{}},
                    {6, wall_mount({6.0, 0.0, 1.2}, 0.5 * kPi), DiscShape{}}}) {
    belief_.pose = {4.0, 3.5, 0.0};
  }

  std::optional<LandmarkId> choose() {
    return policy_.choose(
        {Stamp{}, belief_, {}, 0.0, path_, landmarks_, visibility_, information_, excluded_});
  }

  PatternPolicy policy_;
  FloorPlan plan_;
  Visibility visibility_;
  Path path_;
  LandmarkMap landmarks_;
  Belief belief_;
  NoInformation information_;
  std::vector<LandmarkId> excluded_;
};

TEST_F(PatternPolicyTest, TakesTheNearestThatIsNotFrontal) {
  EXPECT_EQ(choose(), 2);
}

TEST_F(PatternPolicyTest, AFrontalOneWillDoForASmallerAngle) {
  policy_ = PatternPolicy(0.0);
  EXPECT_EQ(choose(), 1);
}

TEST_F(PatternPolicyTest, TakesATagWhenThePatternFailedLately) {
  excluded_ = {2};
  EXPECT_EQ(choose(), 3);
}

TEST_F(PatternPolicyTest, LooksAtNothingRatherThanAtWhatIsHiddenFrontalOrADisc) {
  excluded_ = {2, 3};
  EXPECT_EQ(choose(), std::nullopt);
}

TEST_F(PatternPolicyTest, TooFarIsTooFar) {
  VisibilityParams near;
  near.max_range_m = 4.4;
  visibility_ = Visibility(plan_, HeadGeometry{}, HeadLimits{}, near);
  excluded_ = {2};
  EXPECT_EQ(choose(), std::nullopt);
}

}  // namespace
}  // namespace vigia::planner
