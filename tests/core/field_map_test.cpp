#include "vigia/core/field_map.hpp"

#include "mistake.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia {
namespace {

FieldMap field(const std::string& name) {
  MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/fields/" + name + ".yaml"), "file");
  FieldMap map = read_field_map(reader.map("field"));
  reader.finish();
  return map;
}

FieldMap parse_field(const std::string& text) {
  MapReader reader(parse_config("version: 1\n" + text, "f.yaml"), "file");
  FieldMap map = read_field_map(reader.map("field"));
  reader.finish();
  return map;
}

Eigen::Vector2d random_point(const FieldMap& map, RandomStream& random) {
  const double x = random.uniform(-0.5 * map.length_m - 1.0, 0.5 * map.length_m + 1.0);
  return {x, random.uniform(-0.5 * map.width_m - 1.0, 0.5 * map.width_m + 1.0)};
}

TEST(FieldMap, ThePapersFieldHasItsMeasuresGoalsAndPosts) {
  const FieldMap map = field("12x8");
  EXPECT_EQ(map.length_m, 12.0);
  EXPECT_EQ(map.width_m, 8.0);
  EXPECT_EQ(map.lines.size(), 18U);
  EXPECT_EQ(map.posts.size(), 4U);
  for (const FieldLine& line : map.lines) EXPECT_EQ(line.width_m, 0.125);
  ASSERT_NE(map.goal(FieldColour::yellow), nullptr);
  EXPECT_TRUE(map.goal(FieldColour::yellow)->centre().isApprox(Eigen::Vector2d(-6.0, 0.0)));
  EXPECT_EQ(map.goal(FieldColour::white), nullptr);
}

TEST(FieldMap, OnlyColouredGoalsAndPostsTellTheHalvesApart) {
  EXPECT_TRUE(field("12x8").half_turn_symmetric(false));
  EXPECT_FALSE(field("12x8").half_turn_symmetric());
  EXPECT_FALSE(field("16x10").half_turn_symmetric());
  EXPECT_TRUE(field("msl-22x14").half_turn_symmetric());
}

TEST(FieldMap, ALineOnOneSideAloneBreaksTheSymmetry) {
  FieldMap map = field("msl-22x14");
  map.lines.push_back(FieldLine::segment({1.0, 1.0}, {2.0, 1.0}, 0.125));
  EXPECT_FALSE(map.half_turn_symmetric());
}

TEST(FieldLine, DistanceBeyondAnEndIsToTheEnd) {
  const FieldLine line = FieldLine::segment({0.0, 0.0}, {2.0, 0.0}, 0.1);
  EXPECT_DOUBLE_EQ(distance_to_line(line, {1.0, -0.5}), 0.5);
  EXPECT_DOUBLE_EQ(distance_to_line(line, {5.0, 4.0}), 5.0);
  const FieldLine quarter = FieldLine::arc({0.0, 0.0}, 1.0, 0.0, 0.5 * kPi, 0.1);
  EXPECT_NEAR(distance_to_line(quarter, {2.0, 2.0}), 2.0 * std::sqrt(2.0) - 1.0, 1e-12);
  EXPECT_NEAR(distance_to_line(quarter, {1.0, -0.3}), 0.3, 1e-12);
  EXPECT_NEAR(distance_to_line(quarter, {-0.2, 1.0}), 0.2, 1e-12);
}

TEST(FieldLine, OffsetsNormalIsTheGradientOfTheDistance) {
  const FieldMap map = field("msl-22x14");
  RandomStream random(1, "offsets");
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d p = random_point(map, random);
    for (const FieldLine& line : map.lines) {
      const LineOffset at = line_offset(line, p);
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d d = kStep * Eigen::Vector2d::Unit(axis);
        const double slope =
            (line_offset(line, p + d).distance_m - line_offset(line, p - d).distance_m) /
            (2.0 * kStep);
        EXPECT_NEAR(at.normal[axis], slope, 1e-6);
      }
    }
  }
}

TEST(FieldLine, CrossingsLieOnTheLineAndOnTheRay) {
  const FieldMap map = field("msl-22x14");
  RandomStream random(2, "crossings");
  int crossings = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d p = random_point(map, random);
    const Eigen::Vector2d u = unit_vector(random.uniform(-kPi, kPi));
    for (const FieldLine& line : map.lines) {
      std::vector<LineCrossing> found;
      cross_line(line, p, u, 8.0, found);
      for (const LineCrossing& crossing : found) {
        ++crossings;
        EXPECT_GT(crossing.range_m, 0.0);
        EXPECT_LE(crossing.range_m, 8.0);
        EXPECT_NEAR(distance_to_line(line, p + crossing.range_m * u), 0.0, 1e-9);
      }
    }
  }
  EXPECT_GT(crossings, 100);
}

TEST(FieldDistance, IsTheNearestOfAllLinesWithinReach) {
  for (const char* name : {"12x8", "16x10", "msl-22x14"}) {
    const FieldMap map = field(name);
    const FieldDistance distance(map, 0.6);
    RandomStream random(3, name);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector2d p = random_point(map, random);
      double nearest = 0.6;
      for (const FieldLine& line : map.lines)
        nearest = std::min(nearest, distance_to_line(line, p));
      EXPECT_DOUBLE_EQ(distance.distance(p), nearest);
    }
  }
}

TEST(FieldDistance, FarOutsideThereIsNothing) {
  const FieldDistance distance(field("12x8"), 0.6);
  EXPECT_EQ(distance.distance({1e9, 0.0}), 0.6);
  EXPECT_EQ(distance.distance({std::numeric_limits<double>::quiet_NaN(), 0.0}), 0.6);
}

class FieldMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(FieldMistakes, AreNamedWithTheirPlace) {
  try {
    parse_field(GetParam().text);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, FieldMistakes,
    ::testing::Values(
        Mistake{"field: {length_m: 12, width_m: 8}\n",
                "lines: a field needs at least one line or arc"},
        Mistake{"field: {width_m: 8}\n", "length_m"},
        Mistake{"field:\n  length_m: 12\n  width_m: 8\n  lines: [{points_m: [[0, 0], [0, 0]]}]\n",
                "f.yaml:5:"},
        Mistake{"field: {length_m: 12, width_m: 8, lines: [{points_m: [[0, 0], [0, 9]]}]}\n",
                "points_m: it lies outside the field and its margin"},
        Mistake{"field: {length_m: 12, width_m: 8, lines: [{points_m: [[0, 0], [2, 0]]}, "
                "{points_m: [[1, 0], [3, 0]]}]}\n",
                "points_m: a piece of it runs on an earlier line"},
        Mistake{"field: {length_m: 12, width_m: 8, arcs: [{centre_m: [5, 0], radius_m: 3}]}\n",
                "radius_m: it lies outside the field and its margin"},
        Mistake{"field: {length_m: 12, width_m: 8, lines: [{points_m: [[0, 0], [2, 0]]}], "
                "goals: [{colour: red, from_m: [-6, -1], to_m: [-6, 1]}]}\n",
                "must be one of white, yellow, blue"},
        Mistake{"field: {length_m: 12, width_m: 8, lines: [{points_m: [[0, 0], [2, 0]]}], "
                "goals: [{colour: blue, from_m: [-6, 1], to_m: [-6, 1]}]}\n",
                "to_m: the goal's mouth must be at least 0.2 m wide"},
        Mistake{"field: {length_m: 12, width_m: 8, lines: [{points_m: [[0, 0], [2, 0]]}], "
                "posts: [{at_m: [-6, 1], outer: white}]}\n",
                "must be one of yellow, blue"}));

}  // namespace
}  // namespace vigia
