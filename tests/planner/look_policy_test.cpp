#include "vigia/planner/look_policy.hpp"

#include "look_room.hpp"

#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

using ::testing::ElementsAre;

class LookPolicyTest : public ::testing::Test {
 protected:
  std::optional<LandmarkId> choose(LookPolicy& policy) {
    const auto choice = policy.choose(room_.context());
    return choice ? std::optional(choice->landmark) : std::nullopt;
  }
  std::unique_ptr<LookPolicy> make(const std::string& name, std::optional<LandmarkId> fixed = {},
                                   std::uint64_t seed = 1) const {
    return make_look_policy(name, room_.parts(fixed, seed));
  }

  test::LookRoom room_;
};

TEST_F(LookPolicyTest, EveryNameMakesThePolicyOfThatName) {
  EXPECT_THAT(names_of(look_policies()),
              ElementsAre("fixed", "random", "nearest", "greedy", "fuzzy", "pattern"));
  for (const std::string& name : names_of(look_policies())) EXPECT_EQ(make(name, 1)->name(), name);
  EXPECT_EQ(make("clever", 1), nullptr);
}

TEST_F(LookPolicyTest, NearestTakesTheNearestVisibleOne) {
  const auto policy = make("nearest", std::nullopt, 1);
  EXPECT_EQ(choose(*policy), 1);
  room_.belief.pose.x = 6.5;
  EXPECT_EQ(choose(*policy), 2);
}

TEST_F(LookPolicyTest, NearestPassesOverTheExcludedAndTheHidden) {
  const auto policy = make("nearest", std::nullopt, 1);
  room_.excluded = {1, 2};
  EXPECT_EQ(choose(*policy), 3);
  room_.excluded = {1, 2, 3};
  EXPECT_EQ(choose(*policy), std::nullopt);
}

TEST_F(LookPolicyTest, FixedLooksAtItsLandmarkOrAtNothing) {
  const auto policy = make("fixed", 3, 1);
  EXPECT_EQ(choose(*policy), 3);
  room_.excluded = {3};
  EXPECT_EQ(choose(*policy), std::nullopt);
  EXPECT_EQ(choose(*make("fixed", 4, 1)), std::nullopt);
  EXPECT_EQ(choose(*make("fixed", 77, 1)), std::nullopt);
  EXPECT_EQ(choose(*make("fixed", std::nullopt, 1)), std::nullopt);
}

TEST_F(LookPolicyTest, RandomDrawsTheVisibleOnesEquallyOften) {
  const auto policy = make("random", std::nullopt, 1);
  std::map<LandmarkId, int> counts;
  constexpr int kDraws = 3000;
  for (int i = 0; i < kDraws; ++i) ++counts[choose(*policy).value()];
  EXPECT_EQ(counts.size(), 3U);
  // k = 4 standard errors of a binomial count with p = 1/3.
  const double standard_error = std::sqrt(kDraws * (1.0 / 3.0) * (2.0 / 3.0));
  for (const LandmarkId id : {1, 2, 3}) EXPECT_NEAR(counts[id], kDraws / 3.0, 4.0 * standard_error);
}

TEST_F(LookPolicyTest, RandomRepeatsItselfUnderTheSameSeed) {
  const auto first = make("random", std::nullopt, 5);
  const auto second = make("random", std::nullopt, 5);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(choose(*first), choose(*second));
}

TEST_F(LookPolicyTest, RandomChoosesNothingWhenNothingIsVisible) {
  const auto policy = make("random", std::nullopt, 5);
  room_.excluded = {1, 2, 3};
  EXPECT_EQ(choose(*policy), std::nullopt);
}

}  // namespace
}  // namespace vigia::planner
