#include "head_travel.hpp"
#include "look_room.hpp"

#include <gtest/gtest.h>

#include "vigia/planner/apparent_size.hpp"

namespace vigia::planner {
namespace {

class GreedyPolicyTest : public ::testing::Test {
 protected:
  GreedyPolicyTest() {
    room_.belief.covariance = Eigen::Vector3d(0.01, 0.0025, 1e-4).asDiagonal();
    // Landmark 1 tells x well, 2 tells y well, 3 both a little.
    room_.information.information[1] = Eigen::Vector3d(1e4, 0.0, 0.0).asDiagonal();
    room_.information.information[2] = Eigen::Vector3d(0.0, 1e4, 0.0).asDiagonal();
    room_.information.information[3] = Eigen::Vector3d(50.0, 50.0, 0.0).asDiagonal();
  }
  std::optional<LandmarkId> choose() {
    const auto choice = make_look_policy("greedy", room_.parts())->choose(room_.context());
    return choice ? std::optional(choice->landmark) : std::nullopt;
  }
  test::LookRoom room_;
};

TEST_F(GreedyPolicyTest, TakesTheLandmarkThatLeavesTheLeastTrace) {
  EXPECT_EQ(choose(), 1);
  room_.belief.covariance = Eigen::Vector3d(0.0025, 0.01, 1e-4).asDiagonal();
  EXPECT_EQ(choose(), 2);
  room_.information.information[3] = Eigen::Vector3d(1000.0, 1000.0, 0.0).asDiagonal();
  EXPECT_EQ(choose(), 3);  // 1/1400 + 1/1100 < 1/400 + 1/10100 m²
}

TEST_F(GreedyPolicyTest, PassesOverTheExcludedTheHiddenAndThoseWithoutAnImage) {
  room_.information.information[4] = Eigen::Vector3d(1e6, 1e6, 0.0).asDiagonal();
  EXPECT_EQ(choose(), 1);
  room_.excluded = {1, 3};
  EXPECT_EQ(choose(), 2);
  room_.information.information.clear();
  EXPECT_EQ(choose(), std::nullopt);
}

TEST_F(GreedyPolicyTest, JudgesWhereTheRobotWillBeWhenTheHeadHasArrived) {
  room_.speed_mps = 0.3;
  choose();
  // Landmark 3 lies straight ahead but needs a longer focal length: 8 mm a second.
  const Pose2 at = room_.information.asked_at.at(3);
  const double zoom =
      zoom_for(*room_.landmarks.find(3), room_.visibility.range(*room_.landmarks.find(3), at),
               room_.head_model);
  EXPECT_NEAR(at.x, 4.0 + 0.3 * (zoom - 8.0) / 8.0, 1e-3);
  room_.speed_mps = 0.0;
  choose();
  EXPECT_EQ(room_.information.asked_at.at(3).x, 4.0);
}

TEST_F(GreedyPolicyTest, SaysWhatItExpects) {
  const auto choice = make_look_policy("greedy", room_.parts())->choose(room_.context());
  // x: (1/0.01 + 1e4)⁻¹, y unchanged: √(0.000099 + 0.0025) m.
  EXPECT_EQ(choice->reason, "least expected error after the look: 5.1 cm");
}

TEST(HeadTravel, TheSlowestAxisCounts) {
  test::LookRoom room;
  HeadReading head;
  head.zoom_mm = 8.0;
  EXPECT_NEAR(travel_time(head, {0.0, 0.0}, 16.0, room.head_model), 1.0, 1e-12);
  // 1.5 rad/s and 8 rad/s²: 1 rad takes 1/1.5 + 1.5/8 s.
  EXPECT_NEAR(travel_time(head, {1.0, 0.1}, 8.0, room.head_model), 1.0 / 1.5 + 1.5 / 8.0, 1e-12);
}

TEST(HeadTravel, ThePanNeverGoesThroughItsStop) {
  test::LookRoom room;
  HeadReading head;
  head.angles.pan = 3.0;
  const double through = travel_time(head, {-3.0, 0.0}, 8.0, room.head_model);
  EXPECT_NEAR(through, 6.0 / 1.5 + 1.5 / 8.0, 1e-12);
  room.head_model.limits.pan_max = 2.0 * kPi;
  EXPECT_LT(travel_time(head, {-3.0, 0.0}, 8.0, room.head_model), 0.6);
}

}  // namespace
}  // namespace vigia::planner
