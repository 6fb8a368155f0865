#include "room_to_move.hpp"

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"

namespace vigia::planner {
namespace {

using Eigen::Vector2d;

TEST(SegmentDistance, IsZeroForSegmentsThatCrossOrTouch) {
  EXPECT_EQ(segment_distance({0, 0}, {2, 2}, {0, 2}, {2, 0}), 0.0);
  EXPECT_EQ(segment_distance({0, 0}, {2, 0}, {1, 0}, {1, 3}), 0.0);
  EXPECT_EQ(segment_distance({0, 0}, {2, 0}, {1, 0}, {3, 0}), 0.0);
}

TEST(SegmentDistance, EqualsTheLeastDistanceOfDenselySampledPoints) {
  RandomStream stream(1, "segments");
  const auto point = [&stream] {
    const double x = stream.uniform(-1.0, 1.0);
    return Vector2d(x, stream.uniform(-1.0, 1.0));
  };
  for (int trial = 0; trial < 100; ++trial) {
    const Vector2d a0 = point();
    const Vector2d a1 = point();
    const Vector2d b0 = point();
    const Vector2d b1 = point();
    constexpr int kSamples = 200;
    double least = 1e9;
    for (int i = 0; i <= kSamples; ++i) {
      for (int j = 0; j <= kSamples; ++j) {
        const Vector2d p = a0 + (a1 - a0) * i / kSamples;
        const Vector2d q = b0 + (b1 - b0) * j / kSamples;
        least = std::min(least, (p - q).norm());
      }
    }
    const double exact = segment_distance(a0, a1, b0, b1);
    EXPECT_LE(exact, least + 1e-12);
    // Neighbouring samples of one segment are at most 2√2/200 apart; half of that on each.
    EXPECT_GE(exact, least - 2.0 * std::sqrt(2.0) / kSamples);
  }
}

TEST(RoomToMove, ADiscPassesADoorThatIsWideEnoughAndNoOther) {
  const FloorPlan plan({{0, 0}, {6, 0}, {6, 4}, {0, 4}}, 2.8,
                       {{{3, 0}, {3, 1.6}, 2.8}, {{3, 2.4}, {3, 4}, 2.8}}, {});
  EXPECT_TRUE(RoomToMove(plan, 0.39).passes({1, 2}, {5, 2}));
  EXPECT_FALSE(RoomToMove(plan, 0.41).passes({1, 2}, {5, 2}));
  EXPECT_FALSE(RoomToMove(plan, 0.1).passes({1, 1}, {5, 1}));
}

TEST(RoomToMove, RetreatsFromAWallToTheNearestPlaceWhereItFits) {
  const FloorPlan plan({{0, 0}, {6, 0}, {6, 4}, {0, 4}}, 2.8, {}, {});
  const RoomToMove room(plan, 0.45);
  EXPECT_EQ(room.retreat({3.0, 2.0}), Vector2d(3.0, 2.0));
  const auto place = room.retreat({3.0, 0.35});
  ASSERT_TRUE(place);
  EXPECT_TRUE(room.fits(*place));
  EXPECT_LT((*place - Vector2d(3.0, 0.35)).norm(), 0.1 + 0.051);
}

}  // namespace
}  // namespace vigia::planner
