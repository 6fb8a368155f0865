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
  EXPECT_EQ(trigger.demand(with_sigma(0.5), 0.0), LookDemand::in_motion);
  trigger.looked(0.2);
  EXPECT_EQ(trigger.demand(with_sigma(0.5), 1.19), LookDemand::none);
  EXPECT_EQ(trigger.demand(with_sigma(0.0), 1.2), LookDemand::in_motion);
  EXPECT_EQ(trigger.demand(with_sigma(0.0), 1.5), LookDemand::in_motion);
  trigger.looked(1.5);
  EXPECT_EQ(trigger.demand(with_sigma(0.0), 2.4), LookDemand::none);
}

TEST(LookTrigger, ByUncertaintyLooksInMotionAboveTheFirstLimitOnly) {
  LookTrigger trigger(by(LookTriggerParams::Kind::uncertainty));
  EXPECT_EQ(trigger.demand(with_sigma(0.049), 50.0), LookDemand::none);
  EXPECT_EQ(trigger.demand(with_sigma(0.051), 50.0), LookDemand::in_motion);
  EXPECT_EQ(trigger.demand(with_sigma(0.049), 50.0), LookDemand::none);
}

TEST(LookTrigger, AboveTheSecondLimitStopsUntilBelowTheFirst) {
  LookTrigger trigger(by(LookTriggerParams::Kind::uncertainty));
  EXPECT_EQ(trigger.demand(with_sigma(0.099), 0.0), LookDemand::in_motion);
  EXPECT_EQ(trigger.demand(with_sigma(0.101), 0.0), LookDemand::stopped);
  EXPECT_EQ(trigger.demand(with_sigma(0.06), 0.0), LookDemand::stopped);
  EXPECT_EQ(trigger.demand(with_sigma(0.04), 0.0), LookDemand::none);
  EXPECT_EQ(trigger.demand(with_sigma(0.06), 0.0), LookDemand::in_motion);
}

}  // namespace
}  // namespace vigia::planner
