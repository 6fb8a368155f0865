#include "code_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace vigia::tracking::testing {
namespace {

constexpr double kMinConfidence = 0.999;
const PatternCode kShown{7, 42, 5};

/// Linear reflectances of the inks on paper, by DotColour.
using InkTable = std::array<Eigen::Array3d, 4>;
const InkTable kInks{Eigen::Array3d(0.05, 0.05, 0.05), Eigen::Array3d(0.70, 0.08, 0.09),
                     Eigen::Array3d(0.08, 0.45, 0.17), Eigen::Array3d(0.08, 0.15, 0.60)};

double encoded(double linear, double gamma) {
  return 200.0 * std::pow(linear, 1.0 / gamma);
}

/// What a camera with a response of @p gamma measures of a dot of which blur leaves @p share, the
/// rest being paper.
ColourLevels seen(const Eigen::Array3d& ink, double share, double gamma,
                  const Eigen::Array3d& light = Eigen::Array3d::Ones()) {
  ColourLevels levels;
  for (int c = 0; c < 3; ++c) {
    levels.ground[c] = encoded(light[c], gamma);
    levels.dot[c] = encoded(light[c] * (share * ink[c] + 1.0 - share), gamma);
  }
  levels.dot_sigma.setConstant(1.0);
  return levels;
}

struct Blur {
  double small;   ///< share of the ring's dots
  double centre;  ///< of the larger centre-point
};

DotLevels pattern_levels(const PatternCode& code, const Blur& blur, double gamma,
                         const InkTable& inks = kInks) {
  const PatternColours colours = encode(code);
  DotLevels dots;
  dots[0] = seen(inks[static_cast<std::size_t>(colours.centre)], blur.centre, gamma);
  for (std::size_t i = 0; i < kDotsPerRing; ++i) {
    const auto& ink = inks[static_cast<std::size_t>(colours.ring[i])];
    dots[1 + i] = dots[1 + kDotsPerRing + i] = seen(ink, blur.small, gamma);
  }
  return dots;
}

TEST(CodeReader, ReadsEveryColourOfTheCentreUnderBlurBeforeGamma) {
  for (const int floor : {1, 4, 7, 10})  // black, red, green, blue
    for (const double gamma : {1.0, 1.8, 2.4})
      for (const Blur& blur : {Blur{1.0, 1.0}, Blur{0.6, 0.95}, Blur{0.35, 0.7}}) {
        const PatternCode code{floor, 42, 5};
        const CodeReading reading = read_code(pattern_levels(code, blur, gamma), kMinConfidence);
        ASSERT_EQ(reading.status, ReadStatus::read) << floor << ", γ " << gamma;
        EXPECT_EQ(reading.code, code) << floor << ", γ " << gamma << ", share " << blur.small;
      }
}

TEST(CodeReader, TheTintOfGlareUnderColouredLightIsTakenOut) {
  DotLevels dots = pattern_levels(kShown, {1.0, 1.0}, 1.0);
  for (auto& dot : dots) {
    const Eigen::Array3d glare(10.0, 20.0, 35.0);
    dot->dot += glare;
    dot->ground += glare;
  }
  const CodeReading reading = read_code(dots, kMinConfidence);
  ASSERT_EQ(reading.status, ReadStatus::read);
  EXPECT_EQ(reading.code, kShown);
}

TEST(CodeReader, AGreyPointLighterThanTheColouredOnesIsNotTheBlackOne) {
  DotLevels dots = pattern_levels(kShown, {1.0, 1.0}, 1.0);
  const ColourLevels grey = seen({0.45, 0.45, 0.45}, 1.0, 1.0);
  dots[1] = grey;
  dots[1 + kDotsPerRing] = grey;
  EXPECT_EQ(read_code(dots, kMinConfidence).status, ReadStatus::doubtful);
}

TEST(CodeReader, ASecondBlackPointIsDoubtful) {
  DotLevels dots = pattern_levels(kShown, {1.0, 1.0}, 1.0);
  dots[3] = dots[1];
  dots[3 + kDotsPerRing] = dots[1];
  EXPECT_EQ(read_code(dots, kMinConfidence).status, ReadStatus::doubtful);
}

TEST(CodeReader, RingsThatDisagreeAreDoubtful) {
  DotLevels dots = pattern_levels(kShown, {1.0, 1.0}, 1.0);
  std::swap(dots[2], dots[4]);
  const PatternColours colours = encode(kShown);
  ASSERT_NE(colours.ring[1], colours.ring[3]);
  EXPECT_EQ(read_code(dots, kMinConfidence).status, ReadStatus::doubtful);
}

TEST(CodeReader, AColourBetweenTwoIsDoubtfulAndItsConfidenceLow) {
  DotLevels dots = pattern_levels(kShown, {1.0, 1.0}, 1.0);
  // Red's and blue's least channels are 0.3 apart: 0.03 is a tenth of it, 0.01 next to nothing.
  for (const auto& [blue, most] : {std::pair{0.47, kMinConfidence}, {0.49, 0.9}}) {
    dots[2] = dots[2 + kDotsPerRing] = seen({0.5, 0.08, blue}, 1.0, 1.0);
    const CodeReading reading = read_code(dots, kMinConfidence);
    EXPECT_EQ(reading.status, ReadStatus::doubtful);
    EXPECT_LT(reading.confidence, most);
  }
}

TEST(CodeReader, DarkGreenIsNeitherBlackNorBlue) {
  // Of what a small picture's mosaic and compression leave: green absorbs 0.8 of red's share of
  // blue, and 0.69 of green.
  InkTable inks = kInks;
  inks[static_cast<std::size_t>(DotColour::green)] = {0.10, 0.38, 0.26};
  for (const int floor : {1, 7}) {  // a black centre, a green one
    const PatternCode code{floor, 42, 5};
    const CodeReading reading =
        read_code(pattern_levels(code, {1.0, 1.0}, 1.0, inks), kMinConfidence);
    ASSERT_EQ(reading.status, ReadStatus::read) << floor;
    EXPECT_EQ(reading.code, code);
  }
}

TEST(CodeReader, TwinsThatDifferLowerTheConfidence) {
  DotLevels alike = pattern_levels(kShown, {1.0, 1.0}, 1.0);
  DotLevels different = alike;
  for (std::size_t i = 1; i <= kDotsPerRing; ++i) different[i]->dot[1] += i % 2 == 0 ? 25.0 : -25.0;
  EXPECT_LT(read_code(different, 0.0).confidence, read_code(alike, 0.0).confidence);
}

TEST(CodeReader, DotsThatBlurHasAllButWipedOutAreDoubtful) {
  EXPECT_EQ(read_code(pattern_levels(kShown, {0.08, 0.3}, 1.0), kMinConfidence).status,
            ReadStatus::doubtful);
}

}  // namespace
}  // namespace vigia::tracking::testing
