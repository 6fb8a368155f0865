#include "vigia/planner/look_trigger.hpp"

#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

Belief with_sigma(double sigma) {
  Belief belief;
  belief.covariance(0, 0) = sigma * sigma;
  return belief;
}

LookTriggerParams by(LookTriggerParams::Kind kind) {
  LookTriggerParams params;
  params.kind = kind;
  return params;
}

TEST(LookTrigger, ByDistanceLooksAtTheStartAndThenOnceAMetre) {
  LookTrigger trigger(by(LookTriggerParams::Kind::distance));
  EXPECT_EQ(trigger.demand(with_sigma(0.5), 0.0, 10.0), LookDemand::in_motion);
  trigger.looked(0.2);
  EXPECT_EQ(trigger.demand(with_sigma(0.5), 1.19, 10.0), LookDemand::none);
  EXPECT_EQ(trigger.demand(with_sigma(0.0), 1.2, 10.0), LookDemand::in_motion);
  EXPECT_EQ(trigger.demand(with_sigma(0.0), 1.5, 10.0), LookDemand::in_motion);
  trigger.looked(1.5);
  EXPECT_EQ(trigger.demand(with_sigma(0.0), 2.4, 10.0), LookDemand::none);
}

TEST(LookTrigger, ByUncertaintyLooksInMotionAboveTheFirstLimitOnly) {
  LookTrigger trigger(by(LookTriggerParams::Kind::uncertainty));
  EXPECT_EQ(trigger.demand(with_sigma(0.049), 50.0, 10.0), LookDemand::none);
  EXPECT_EQ(trigger.demand(with_sigma(0.051), 50.0, 10.0), LookDemand::in_motion);
  EXPECT_EQ(trigger.demand(with_sigma(0.049), 50.0, 10.0), LookDemand::none);
}

TEST(LookTrigger, AboveTheSecondLimitStopsUntilBelowTheFirst) {
  LookTrigger trigger(by(LookTriggerParams::Kind::uncertainty));
  EXPECT_EQ(trigger.demand(with_sigma(0.099), 0.0, 10.0), LookDemand::in_motion);
  EXPECT_EQ(trigger.demand(with_sigma(0.101), 0.0, 10.0), LookDemand::stopped);
  EXPECT_EQ(trigger.demand(with_sigma(0.06), 0.0, 10.0), LookDemand::stopped);
  EXPECT_EQ(trigger.demand(with_sigma(0.04), 0.0, 10.0), LookDemand::none);
  EXPECT_EQ(trigger.demand(with_sigma(0.06), 0.0, 10.0), LookDemand::in_motion);
}

TEST(LookTrigger, OnTheLastStretchTheGoalsLimitHolds) {
  LookTriggerParams params = by(LookTriggerParams::Kind::uncertainty);
  params.goal_m = 2.0;
  params.goal_limit_m = 0.02;
  LookTrigger trigger(params);
  EXPECT_EQ(trigger.demand(with_sigma(0.03), 5.0, 2.5), LookDemand::none);
  EXPECT_EQ(trigger.demand(with_sigma(0.03), 5.0, 1.9), LookDemand::in_motion);
  EXPECT_EQ(trigger.demand(with_sigma(0.019), 5.0, 1.9), LookDemand::none);
  EXPECT_EQ(trigger.demand(with_sigma(0.101), 5.0, 1.9), LookDemand::stopped);
}

}  // namespace
}  // namespace vigia::planner
