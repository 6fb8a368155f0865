#include "vigia/core/colour_pattern.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "vigia/core/angle.hpp"

namespace vigia {
namespace {

DotColour colour_of(int digit) {
  return static_cast<DotColour>(digit + 1);  // red, green, blue
}

int digit_of(DotColour colour) {
  if (colour == DotColour::black)
    throw std::invalid_argument("a point that carries the code is black");
  return static_cast<int>(colour) - 1;
}

void check(int value, int count, const char* what) {
  if (value < 0 || value >= count)
    throw std::invalid_argument(std::string(what) + " " + std::to_string(value) + " is not in 0–" +
                                std::to_string(count - 1));
}

}  // namespace

bool operator==(const PatternCode& a, const PatternCode& b) {
  return a.floor == b.floor && a.room == b.room && a.pattern == b.pattern;
}

PatternColours encode(const PatternCode& code) {
  check(code.floor, kFloors, "floor");
  check(code.room, kRooms, "room");
  check(code.pattern, kPatterns, "pattern");
  PatternColours colours;
  colours.centre = static_cast<DotColour>(code.floor / 3);
  colours.ring[0] = DotColour::black;
  colours.ring[1] = colour_of(code.room / 27);
  colours.ring[2] = colour_of(code.room / 9 % 3);
  colours.ring[3] = colour_of(code.room / 3 % 3);
  colours.ring[4] = colour_of(code.room % 3);
  colours.ring[5] = colour_of(code.pattern / 3);
  colours.ring[6] = colour_of(code.pattern % 3);
  colours.ring[7] = colour_of(code.floor % 3);
  return colours;
}

PatternCode decode(const PatternColours& colours) {
  if (colours.ring[0] != DotColour::black)
    throw std::invalid_argument("the first point is not black");
  PatternCode code;
  for (std::size_t i = 1; i <= 4; ++i) code.room = 3 * code.room + digit_of(colours.ring[i]);
  code.pattern = 3 * digit_of(colours.ring[5]) + digit_of(colours.ring[6]);
  code.floor = 3 * static_cast<int>(colours.centre) + digit_of(colours.ring[7]);
  return code;
}

PatternShape scaled(PatternShape shape, double scale) {
  shape.outer_radius_m *= scale;
  shape.inner_radius_m *= scale;
  shape.dot_radius_m *= scale;
  shape.centre_radius_m *= scale;
  shape.sheet_half_width_m *= scale;
  return shape;
}

std::vector<PatternDot> pattern_dots(const PatternShape& shape) {
  const PatternColours colours = encode(shape.code);
  std::vector<PatternDot> dots{{0, Eigen::Vector2d::Zero(), shape.centre_radius_m, colours.centre}};
  int label = 1;
  for (const double radius : {shape.outer_radius_m, shape.inner_radius_m}) {
    for (int i = 0; i < kDotsPerRing; ++i) {
      const double turn = 2.0 * kPi * i / kDotsPerRing;  // clockwise from the upward axis
      dots.push_back({label++,
                      {radius * std::sin(turn), radius * std::cos(turn)},
                      shape.dot_radius_m,
                      colours.ring[static_cast<std::size_t>(i)]});
    }
  }
  return dots;
}

}  // namespace vigia
