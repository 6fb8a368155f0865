#include "vigia/planner/look_policy.hpp"

#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

using ::testing::ElementsAre;

class NoInformation final : public InformationModel {
 public:
  std::optional<Eigen::Matrix3d> look_information(const Landmark&, const Pose2&) const override {
    return std::nullopt;
  }
};

/// A room with three discs in sight (ids 1, 2, 3 at growing range) and one hidden by a wall (4).
class LookPolicyTest : public ::testing::Test {
 protected:
  LookPolicyTest()
      : plan_({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8,
              {{{2.0, 2.5}, {2.0, 4.5}, 2.8}}, {}),
        visibility_(plan_, HeadGeometry{}, HeadLimits{}, VisibilityParams{}),
        path_({{3.0, 3.5}, {9.0, 3.5}}),
        landmarks_({{1, wall_mount({4.0, 7.0, 1.6}, -0.5 * kPi), DiscShape{0.1}},
                    {2, wall_mount({6.0, 0.0, 1.6}, 0.5 * kPi), DiscShape{0.1}},
                    {3, wall_mount({12.0, 3.5, 1.6}, kPi), DiscShape{0.1}},
                    {4, wall_mount({0.0, 3.5, 1.6}, 0.0), DiscShape{0.1}}}) {
    belief_.pose = {4.0, 3.5, 0.0};
  }

  std::optional<LandmarkId> choose(LookPolicy& policy) {
    return policy.choose(
        {Stamp{}, belief_, head_, 0.0, path_, landmarks_, visibility_, information_, excluded_});
  }

  FloorPlan plan_;
  Visibility visibility_;
  Path path_;
  LandmarkMap landmarks_;
  Belief belief_;
  HeadReading head_;
  NoInformation information_;
  std::vector<LandmarkId> excluded_;
};

TEST_F(LookPolicyTest, EveryNameMakesThePolicyOfThatName) {
  EXPECT_THAT(look_policy_names(), ElementsAre("fixed", "random", "nearest", "pattern"));
  for (const std::string& name : look_policy_names())
    EXPECT_EQ(make_look_policy(name, 1, RandomStream(1, "look"))->name(), name);
  EXPECT_EQ(make_look_policy("clever", 1, RandomStream(1, "look")), nullptr);
}

TEST_F(LookPolicyTest, NearestTakesTheNearestVisibleOne) {
  const auto policy = make_look_policy("nearest", std::nullopt, RandomStream(1, "look"));
  EXPECT_EQ(choose(*policy), 1);
  belief_.pose.x = 6.5;
  EXPECT_EQ(choose(*policy), 2);
}

TEST_F(LookPolicyTest, NearestPassesOverTheExcludedAndTheHidden) {
  const auto policy = make_look_policy("nearest", std::nullopt, RandomStream(1, "look"));
  excluded_ = {1, 2};
  EXPECT_EQ(choose(*policy), 3);
  excluded_ = {1, 2, 3};
  EXPECT_EQ(choose(*policy), std::nullopt);
}

TEST_F(LookPolicyTest, FixedLooksAtItsLandmarkOrAtNothing) {
  const auto policy = make_look_policy("fixed", 3, RandomStream(1, "look"));
  EXPECT_EQ(choose(*policy), 3);
  excluded_ = {3};
  EXPECT_EQ(choose(*policy), std::nullopt);
  EXPECT_EQ(choose(*make_look_policy("fixed", 4, RandomStream(1, "look"))), std::nullopt);
  EXPECT_EQ(choose(*make_look_policy("fixed", 77, RandomStream(1, "look"))), std::nullopt);
  EXPECT_EQ(choose(*make_look_policy("fixed", std::nullopt, RandomStream(1, "look"))),
            std::nullopt);
}

TEST_F(LookPolicyTest, RandomDrawsTheVisibleOnesEquallyOften) {
  const auto policy = make_look_policy("random", std::nullopt, RandomStream(1, "look"));
  std::map<LandmarkId, int> counts;
  constexpr int kDraws = 3000;
  for (int i = 0; i < kDraws; ++i) ++counts[choose(*policy).value()];
  EXPECT_EQ(counts.size(), 3U);
  // k = 4 standard errors of a binomial count with p = 1/3.
  const double standard_error = std::sqrt(kDraws * (1.0 / 3.0) * (2.0 / 3.0));
  for (const LandmarkId id : {1, 2, 3}) EXPECT_NEAR(counts[id], kDraws / 3.0, 4.0 * standard_error);
}

TEST_F(LookPolicyTest, RandomRepeatsItselfUnderTheSameSeed) {
  const auto first = make_look_policy("random", std::nullopt, RandomStream(5, "look"));
  const auto second = make_look_policy("random", std::nullopt, RandomStream(5, "look"));
  for (int i = 0; i < 50; ++i) EXPECT_EQ(choose(*first), choose(*second));
}

TEST_F(LookPolicyTest, RandomChoosesNothingWhenNothingIsVisible) {
  const auto policy = make_look_policy("random", std::nullopt, RandomStream(5, "look"));
  excluded_ = {1, 2, 3};
  EXPECT_EQ(choose(*policy), std::nullopt);
}

}  // namespace
}  // namespace vigia::planner
