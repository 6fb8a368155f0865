#include "vigia/core/colour_pattern.hpp"

#include <set>

#include <gmock/gmock.h>

namespace vigia {
namespace {

TEST(ColourPattern, EveryCodeReadsBackAsItself) {
  for (int floor = 0; floor < kFloors; ++floor)
    for (int room = 0; room < kRooms; ++room)
      for (int pattern = 0; pattern < kPatterns; ++pattern)
        EXPECT_EQ(decode(encode({floor, room, pattern})), (PatternCode{floor, room, pattern}));
}

TEST(ColourPattern, TheFirstPointAloneIsBlackInTheRing) {
  const PatternColours colours = encode({7, 42, 5});
  EXPECT_EQ(colours.ring[0], DotColour::black);
  for (std::size_t i = 1; i < colours.ring.size(); ++i)
    EXPECT_NE(colours.ring[i], DotColour::black);
}

TEST(ColourPattern, AFirstPointThatIsNotBlackIsNoCode) {
  PatternColours colours = encode({7, 42, 5});
  colours.ring[0] = DotColour::red;
  EXPECT_THROW(decode(colours), std::invalid_argument);
}

TEST(ColourPattern, ACodeOutsideItsRangeIsNamed) {
  try {
    encode({12, 0, 0});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "floor 12 is not in 0–11");
  }
}

TEST(ColourPattern, TheFirstPointIsUpAndTheThirdToTheViewersRight) {
  const auto dots = pattern_dots({});
  ASSERT_EQ(dots.size(), static_cast<std::size_t>(kPatternDots));
  EXPECT_NEAR((dots[1].centre_l - Eigen::Vector2d(0.0, 0.113)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((dots[3].centre_l - Eigen::Vector2d(0.113, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((dots[9].centre_l - Eigen::Vector2d(0.0, 0.072)).norm(), 0.0, 1e-12);
}

TEST(ColourPattern, BothRingsSayTheSame) {
  const auto dots = pattern_dots({{3, 17, 8}});
  for (std::size_t i = 1; i <= 8; ++i) EXPECT_EQ(dots[i].colour, dots[i + 8].colour);
}

}  // namespace
}  // namespace vigia
