#include "armingol.hpp"
#include "look_room.hpp"

#include <gtest/gtest.h>

namespace vigia::planner {
namespace {

/// The fuzzy policy on the paper's mission, asked where a test puts the robot.
class FuzzyPolicyTest : public ::testing::Test {
 protected:
  FuzzyPolicyTest()
      : visibility_(armingol_.visibility()),
        parts_{{},          RandomStream(1, "look"), armingol_.world.landmarks,
               visibility_, armingol_.head,          {},
               {}},
        supervisors_(parts_.rules),
        plan_(plan_perception(armingol_.path, armingol_.world.landmarks, visibility_,
                              armingol_.head, supervisors_, {})),
        policy_(make_look_policy("fuzzy", parts_)) {
    policy_->follow(armingol_.path);
    belief_.covariance = Eigen::Vector3d(0.05 * 0.05, 0.05 * 0.05, 1e-4).asDiagonal();
  }

  std::optional<LookChoice> choose_at(double station_m, bool standing = false) {
    belief_.pose = pose_on_path(armingol_.path, station_m);
    return policy_->choose({Stamp{}, belief_, head_, station_m, armingol_.path,
                            armingol_.world.landmarks, visibility_, information_, excluded_,
                            armingol_.head, standing ? 0.0 : 0.3, standing, odometry_});
  }

  test::Armingol armingol_;
  Visibility visibility_;
  LookPolicyParts parts_;
  FuzzySupervisors supervisors_;
  PerceptionPlan plan_;
  std::unique_ptr<LookPolicy> policy_;
  Belief belief_;
  HeadReading head_;
  test::GivenInformation information_;
  std::vector<LandmarkId> excluded_;
  OdometryNoise odometry_;
};

TEST_F(FuzzyPolicyTest, InMotionAPreselectedLandmarkComesAtTheZoomOfItsArea) {
  int planned = 0;
  for (double station = 0.2; station < 21.0; station += 0.4) {
    const auto choice = choose_at(station);
    if (!choice || !choice->zoom_mm) continue;
    ++planned;
    const AreaPlan& area = *plan_.at(station);
    EXPECT_EQ(std::count(area.preselected.begin(), area.preselected.end(), choice->landmark), 1)
        << station;
    EXPECT_EQ(choice->zoom_mm, area.zoom_mm) << station;
    EXPECT_GE(*choice->suitability, PerceptionParams{}.reject) << station;
  }
  EXPECT_GE(planned, 20);
}

TEST_F(FuzzyPolicyTest, AloneOfThePoliciesItWaitsWhereItWouldLook) {
  for (const std::string& name : names_of(look_policies()))
    EXPECT_EQ(make_look_policy(name, parts_)->prepares(), name == "fuzzy");
}

TEST_F(FuzzyPolicyTest, WithoutAUsablePreselectedOneTakesAnyThatIsVisible) {
  excluded_ = plan_.at(7.0)->preselected;
  const auto choice = choose_at(7.0);
  ASSERT_TRUE(choice);
  EXPECT_EQ(std::count(excluded_.begin(), excluded_.end(), choice->landmark), 0);
  EXPECT_EQ(choice->zoom_mm, std::nullopt);
  excluded_ = {0, 1, 2, 3, 4, 6};
  EXPECT_EQ(choose_at(7.0), std::nullopt);
}

TEST_F(FuzzyPolicyTest, StandingItTakesLandmarksAlongBothAxesInTurn) {
  const auto along_x = [&](LandmarkId id) {
    const Eigen::Vector2d sight =
        armingol_.world.landmarks.find(id)->centre_w().head<2>() - belief_.pose.position();
    return std::abs(sight.x()) >= std::abs(sight.y());
  };
  belief_.covariance = Eigen::Vector3d(0.12 * 0.12, 0.12 * 0.12, 1e-3).asDiagonal();
  const auto first = choose_at(10.5, true);
  const auto second = choose_at(10.5, true);
  const auto third = choose_at(10.5, true);
  ASSERT_TRUE(first && second && third);
  EXPECT_NE(along_x(first->landmark), along_x(second->landmark));
  EXPECT_EQ(first->landmark, third->landmark);
  EXPECT_EQ(first->zoom_mm, std::nullopt);
}

TEST_F(FuzzyPolicyTest, StandingWithOneUncertainAxisItKeepsToTheBestZoom) {
  belief_.covariance = Eigen::Vector3d(0.12 * 0.12, 0.02 * 0.02, 1e-3).asDiagonal();
  const auto first = choose_at(10.5, true);
  const auto second = choose_at(10.5, true);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->landmark, second->landmark);
}

}  // namespace
}  // namespace vigia::planner
