#include "vigia/pilot/contact_risk.hpp"

#include "hall.hpp"

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"

namespace vigia::pilot {
namespace {

constexpr double kRadius_m = 0.3;
constexpr double kHorizon_m = 20.0;

Belief between(std::vector<PoseHypothesis> hypotheses) {
  Belief belief;
  belief.status = BeliefStatus::ambiguous;
  belief.pose = hypotheses.front().pose;
  belief.hypotheses = std::move(hypotheses);
  return belief;
}

PoseHypothesis at(double x, double y, double theta, double weight, double sigma_m = 0.0) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.diagonal().head<2>().setConstant(sigma_m * sigma_m);
  return {{x, y, theta}, covariance, weight};
}

TEST(ContactRisk, WithoutHypothesesThePoseCounts) {
  const FloorPlan plan = hall();
  const ContactRisk risk(plan, kRadius_m, 0.01);
  Belief belief;
  belief.pose = {4.0, 3.0, 0.0};
  EXPECT_NEAR(risk.free_m(belief, 0.0, kHorizon_m), 5.7, 1e-9);
  EXPECT_NEAR(risk.free_m(belief, 0.5 * kPi, kHorizon_m), 2.7, 1e-9);
  EXPECT_NEAR(risk.free_m(belief, kPi, kHorizon_m), 3.7, 1e-9);
  EXPECT_DOUBLE_EQ(risk.free_m(belief, 0.0, 1.0), 1.0);
}

TEST(ContactRisk, ObliqueTheSideOfTheBaseTouchesFirst) {
  const FloorPlan plan = hall();
  const ContactRisk risk(plan, kRadius_m, 0.01);
  Belief belief;
  belief.pose = {8.0, 3.0, from_deg(30.0)};
  // The wall x = 10: 1.7 m until the disc touches, by cos 30°; the corner is farther.
  EXPECT_NEAR(risk.free_m(belief, 0.0, kHorizon_m), 1.7 / std::cos(from_deg(30.0)), 1e-9);
}

TEST(ContactRisk, ACornerBesideTheWayIsTouched) {
  const FloorPlan plan({{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}}, 2.8, {},
                       {{{{5.0, 3.2}, {6.0, 3.2}, {6.0, 5.0}, {5.0, 5.0}}, 1.0}});
  const ContactRisk risk(plan, kRadius_m, 0.01);
  Belief belief;
  belief.pose = {1.0, 3.0, 0.0};
  EXPECT_NEAR(risk.free_m(belief, 0.0, kHorizon_m), 4.0 - std::sqrt(0.09 - 0.04), 1e-9);
  belief.pose.y = 2.85;  // passes by
  EXPECT_NEAR(risk.free_m(belief, 0.0, kHorizon_m), 8.7, 1e-9);
}

TEST(ContactRisk, AHypothesisCountsByItsWeight) {
  const FloorPlan plan = hall();
  const Belief belief = between({at(2.0, 3.0, 0.0, 0.95), at(8.0, 3.0, 0.0, 0.05)});
  EXPECT_NEAR(ContactRisk(plan, kRadius_m, 0.01).free_m(belief, 0.0, kHorizon_m), 1.7, 1e-9);
  EXPECT_NEAR(ContactRisk(plan, kRadius_m, 0.10).free_m(belief, 0.0, kHorizon_m), 7.7, 1e-9);
}

TEST(ContactRisk, ManySlightOnesAddUp) {
  const FloorPlan plan = hall();
  std::vector<PoseHypothesis> row;
  for (int i = 0; i < 200; ++i) row.push_back(at(0.5 + 0.045 * i, 3.0, 0.0, 1.0 / 200));
  // More than 1 % of the weight: the three that are foremost.
  const double third = 0.5 + 0.045 * 197;
  EXPECT_NEAR(ContactRisk(plan, kRadius_m, 0.0101).free_m(between(row), 0.0, kHorizon_m),
              9.7 - third, 1e-9);
}

TEST(ContactRisk, SigmaBringsThingsNearer) {
  const FloorPlan plan = hall();
  const Belief belief = between({at(2.0, 3.0, 0.0, 1.0, 0.2)});
  EXPECT_NEAR(ContactRisk(plan, kRadius_m, 0.01).free_m(belief, 0.0, kHorizon_m), 7.1, 1e-9);
}

TEST(ContactRisk, OneThatIsOutsideOfTheBuildingIsNone) {
  const FloorPlan plan = hall();
  const Belief belief = between({at(2.0, 3.0, 0.0, 0.5), at(-1.0, 3.0, 0.0, 0.5)});
  EXPECT_NEAR(ContactRisk(plan, kRadius_m, 0.01).free_m(belief, 0.0, kHorizon_m), 7.7, 1e-9);
}

TEST(ContactRisk, OneThatTouchesMayGoAway) {
  const FloorPlan plan = hall();
  const ContactRisk risk(plan, kRadius_m, 0.01);
  const Belief belief = between({at(9.8, 3.0, 0.0, 1.0)});
  EXPECT_DOUBLE_EQ(risk.free_m(belief, 0.0, kHorizon_m), 0.0);
  EXPECT_NEAR(risk.free_m(belief, kPi, kHorizon_m), 9.5, 1e-9);
}

}  // namespace
}  // namespace vigia::pilot
