#include "vigia/core/world_map.hpp"

#include "config_files.hpp"
#include "mistake.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/path.hpp"

namespace vigia {
namespace {

WorldMap read_world(const std::string& text) {
  MapReader reader(parse_config(text, "w.yaml"), "");
  WorldMap world = read_world_map(reader);
  reader.finish();
  return world;
}

constexpr const char* kRoom =
    "version: 1\nroom: {width_m: 10, depth_m: 6, height_m: 3}\n"
    "walls: [{from_m: [5, 0], to_m: [5, 4]}]\n"
    "obstacles: [{polygon_m: [[7, 2], [8, 2], [8, 3], [7, 3]], height_m: 2}]\n"
    "landmarks:\n";

TEST(WorldMap, IsReadWithRoomWallsObstaclesAndLandmarks) {
  const WorldMap world =
      read_world(std::string(kRoom) +
                 "  - {id: 4, kind: disc, centre_m: [0, 3, 1.5], normal_deg: 0, radius_m: 0.1}\n"
                 "  - {id: 2, kind: disc, centre_m: [7.5, 3, 1.5], normal_deg: 90, radius_m: 0.2}\n"
                 "name: hall\n");
  EXPECT_EQ(world.name, "hall");
  EXPECT_EQ(world.plan.max_corner(), Eigen::Vector2d(10.0, 6.0));
  EXPECT_EQ(world.plan.ceiling_m(), 3.0);
  ASSERT_EQ(world.plan.partitions().size(), 1U);
  EXPECT_EQ(world.plan.partitions()[0].height_m, 3.0);
  ASSERT_EQ(world.plan.obstacles().size(), 1U);
  ASSERT_EQ(world.landmarks.all().size(), 2U);
  const Landmark* landmark = world.landmarks.find(2);
  ASSERT_NE(landmark, nullptr);
  EXPECT_EQ(disc_radius(*landmark), 0.2);
  EXPECT_EQ(landmark->centre_w(), Eigen::Vector3d(7.5, 3.0, 1.5));
  EXPECT_LT((landmark->normal_w() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
}

TEST(WorldMap, HasARoomOfAnyOutline) {
  const WorldMap world = read_world(
      "version: 1\nroom: {outline_m: [[0, 0], [4, 0], [4, 4], [2, 4], [2, 2], [0, 2]]}\n"
      "walls: [{from_m: [4, 2], to_m: [2, 2], height_m: 1.2}]\n");
  EXPECT_EQ(world.plan.outline().size(), 6U);
  EXPECT_EQ(world.plan.ceiling_m(), 2.8);
  EXPECT_EQ(world.plan.partitions()[0].height_m, 1.2);
}

TEST(WorldMap, LeavesOtherKeysToOtherReaders) {
  MapReader reader(
      parse_config("version: 1\nroom: {width_m: 4, depth_m: 4}\nclutter: 3\n", "w.yaml"), "");
  read_world_map(reader);
  EXPECT_EQ(reader.integer("clutter", {0.0, 10.0}), 3);
  reader.finish();
}

TEST(WorldMap, OnePartitionMayCarryLandmarksOnBothSides) {
  const WorldMap world = read_world(
      std::string(kRoom) +
      "  - {id: 1, kind: disc, centre_m: [5, 3, 1.5], normal_deg: 0, radius_m: 0.1}\n"
      "  - {id: 2, kind: disc, centre_m: [5, 3, 1.5], normal_deg: 180, radius_m: 0.1}\n");
  EXPECT_EQ(world.landmarks.all().size(), 2U);
}

TEST(WorldMap, AFreeStandingLandmarkNeedsNoWall) {
  const WorldMap world = read_world(std::string(kRoom) +
                                    "  - {id: 1, kind: disc, centre_m: [2, 3, 1.5], normal_deg: 0, "
                                    "radius_m: 0.1, free_standing: true}\n");
  EXPECT_EQ(world.landmarks.all().size(), 1U);
}

constexpr const char* kHall = "version: 1\nroom: {width_m: 20, depth_m: 20}\nceiling:\n";

TEST(WorldMap, ACeilingHasPatchesButInItsGaps) {
  const WorldMap world = read_world(std::string(kHall) +
                                    "  gaps:\n"
                                    "    - {min_m: [2.5, 2.5], max_m: [4.2, 3.4]}\n"
                                    "    - {min_m: [7, 1], max_m: [7, 1]}\n");
  ASSERT_TRUE(world.ceiling);
  EXPECT_FALSE(is_endless(*world.ceiling));
  std::set<std::pair<std::int64_t, std::int64_t>> missing;
  for (std::int64_t i = 0; i <= 20; ++i)
    for (std::int64_t j = 0; j <= 20; ++j)
      if (!has_patch(*world.ceiling, {i, j})) missing.insert({i, j});
  const std::set<std::pair<std::int64_t, std::int64_t>> expected{{3, 3}, {4, 3}, {7, 1}};
  EXPECT_EQ(missing, expected);
  // Whatever the last digits of the pitch's multiples.
  for (const char* pitch : {"0.3", "0.7", "0.4", "1.1"}) {
    const double at = 3.0 * std::stod(pitch);
    const std::string corner = "[" + std::to_string(at) + ", " + std::to_string(at) + "]";
    const WorldMap fine =
        read_world(std::string(kHall) + "  pitch_m: " + pitch + "\n  gaps: [{min_m: " + corner +
                   ", max_m: " + corner + "}]\n");
    EXPECT_FALSE(has_patch(*fine.ceiling, {3, 3})) << pitch;
    EXPECT_TRUE(has_patch(*fine.ceiling, {3, 2})) << pitch;
  }
  EXPECT_TRUE(is_endless(*read_world(std::string(kHall) + "  pitch_m: 2\n").ceiling));
}

TEST(WorldMap, ResolvedAndWrittenItReadsBackTheSame) {
  const auto root = parse_config(std::string(kRoom) + "  []\n", "w.yaml");
  MapReader reader(root, "");
  read_world_map(reader);
  const auto again = parse_config(dump_config(*root), "dump.yaml");
  MapReader second(again, "");
  read_world_map(second);
  second.finish();
  EXPECT_TRUE(same_tree(*root, *again));
}

/// Two rooms of 4 × 3 m and a ramp of 0.1 between them, 5 m long and 1 m wide.
constexpr const char* kRamp =
    "version: 1\nroom:\n  outline_m: [[0, 0], [4, 0], [4, 1], [9, 1], [9, 0], [13, 0], [13, 3], "
    "[9, "
    "3], [9, 2], [4, 2], [4, 3], [0, 3]]\nground:\n"
    "  - {polygon_m: [[0, 0], [4, 0], [4, 3], [0, 3]]}\n"
    "  - {polygon_m: [[4, 1], [9, 1], [9, 2], [4, 2]], grade: 0.1, uphill_deg: 0}\n"
    "  - {polygon_m: [[9, 0], [13, 0], [13, 3], [9, 3]]}\n";

TEST(WorldMap, HasGroundOfPiecesThatRampsJoinAndLandmarksThatHangAboveIt) {
  const WorldMap world = read_world(
      std::string(kRamp) +
      "landmarks:\n"
      "  - {id: 1, kind: disc, centre_m: [6.5, 1, 2.1], normal_deg: 90, radius_m: 0.1}\n"
      "  - {id: 2, kind: disc, centre_m: [13, 2, 2.1], normal_deg: 180, radius_m: 0.1}\n");
  const double slope = std::atan(0.1);
  ASSERT_EQ(world.ground.patches().size(), 3U);
  EXPECT_NEAR(world.ground.place({11.0, 2.0, 0.0}).translation().z(), 5.0 * std::sin(slope), 1e-12);
  const Eigen::Vector3d on_ramp = world.landmarks.find(1)->centre_w();
  EXPECT_NEAR(on_ramp.x(), 4.0 + 2.5 * std::cos(slope), 1e-12);
  EXPECT_NEAR(on_ramp.z(), 2.1 + 2.5 * std::sin(slope), 1e-12);
  EXPECT_LT((world.in_plan(*world.landmarks.find(1)) - Eigen::Vector2d(6.5, 1.0)).norm(), 1e-9);
  EXPECT_LT((world.in_plan(*world.landmarks.find(2)) - Eigen::Vector2d(13.0, 2.0)).norm(), 1e-9);
  EXPECT_NEAR(world.landmarks.find(2)->normal_w().x(), -1.0, 1e-12);
}

class WorldMistake : public testing::TestWithParam<Mistake> {};

TEST_P(WorldMistake, IsReportedWithItsPlace) {
  EXPECT_EQ(input_error([] { read_world(GetParam().text); }), GetParam().message);
}

Mistake room(const std::string& room, const std::string& message) {
  return {"version: 1\nroom: " + room + "\n", "w.yaml:2:" + message};
}

Mistake wall(const std::string& wall, const std::string& message) {
  return {"version: 1\nroom: {width_m: 10, depth_m: 6, height_m: 3}\nwalls:\n  - " + wall + "\n",
          "w.yaml:4:" + message};
}

Mistake obstacle(const std::string& polygon, const std::string& height,
                 const std::string& message) {
  return {"version: 1\nroom: {width_m: 10, depth_m: 6, height_m: 3}\nobstacles:\n  - polygon_m: " +
              polygon + "\n    height_m: " + height + "\n",
          "w.yaml:" + message};
}

Mistake disc(const std::string& centre, const std::string& normal, const std::string& radius,
             const std::string& message) {
  return {std::string(kRoom) + "  - id: 1\n    kind: disc\n    centre_m: " + centre +
              "\n    normal_deg: " + normal + "\n    radius_m: " + radius + "\n",
          "w.yaml:" + message};
}

INSTANTIATE_TEST_SUITE_P(
    OfTheCeiling, WorldMistake,
    testing::Values(
        Mistake{std::string(kHall) + "  gaps: [{min_m: [1, 1], max_m: [0, 1]}]\n",
                "w.yaml:4:33: ceiling.gaps[0].max_m: the gap ends before it begins"},
        Mistake{std::string(kHall) + "  gaps: [{min_m: [1.2, 1], max_m: [1.9, 1]}]\n",
                "w.yaml:4:35: ceiling.gaps[0].max_m: no patch's place lies in this gap: they are "
                "at the multiples of pitch_m"},
        Mistake{std::string(kHall) + "  gaps: [{min_m: [1, 1]}]\n",
                "w.yaml:4:10: ceiling.gaps[0].max_m: the key is missing"},
        Mistake{std::string(kHall) + "  max_m: [9, 9]\n",
                "w.yaml:4:10: ceiling.max_m: the grid ends and does not begin: min_m is missing "
                "beside it"},
        Mistake{std::string(kHall) + "  min_m: [0.2, 0.2]\n  max_m: [0.8, 0.8]\n",
                "w.yaml:5:10: ceiling.max_m: no patch hangs in this grid: they are at the "
                "multiples of pitch_m"},
        Mistake{std::string(kHall) + "  min_m: [300, 300]\n  max_m: [400, 400]\n",
                "w.yaml:3:1: ceiling: the grid lies outside of the room: see its min_m and max_m"},
        Mistake{std::string(kHall) + "  min_m: [1, 1]\n  max_m: [9, 9]\n"
                                     "  gaps: [{min_m: [12, 12], max_m: [13, 13]}]\n",
                "w.yaml:6:35: ceiling.gaps[0].max_m: the gap lies outside of the grid, which ends "
                "at min_m and max_m of the ceiling"},
        Mistake{std::string(kHall) + "  min_m: [1, 1]\n  max_m: [9, 9]\n"
                                     "  gaps: [{min_m: [0, 0], max_m: [20, 20]}]\n",
                "w.yaml:6:33: ceiling.gaps[0].max_m: the gap leaves no patch of the grid"}));

INSTANTIATE_TEST_SUITE_P(
    OfTheRoom, WorldMistake,
    testing::Values(
        Mistake{"version: 1\nname: x\n", "w.yaml:1:1: room.width_m: the key is missing"},
        room("{width_m: 10}", "1: room.depth_m: the key is missing"),
        room("{width_m: 0, depth_m: 6}", "17: room.width_m: found '0', must lie in [0.5, 1000]"),
        room("{outline_m: [[0, 0], [2, 2], [2, 0], [0, 2]]}",
             "19: room.outline_m: the polygon crosses itself: side 1 meets side 3"),
        room("{outline_m: [[0, 0], [2, 0], [2, 0], [0, 2]]}",
             "19: room.outline_m: corner 2 is repeated"),
        room("{outline_m: [[0, 0], [2, 0], [1, 0]]}",
             "19: room.outline_m: the polygon crosses itself: side 1 meets side 2"),
        room("{outline_m: [[0, 0], [2, 0], [2, 2]], width_m: 3}",
             "45: unknown key 'width_m' in room (known: height_m, outline_m)")));

/// kRamp with a piece of its text replaced.
Mistake ramp(const std::string& from, const std::string& to, const std::string& message) {
  std::string text = kRamp;
  text.replace(text.find(from), from.size(), to);
  return {text, "w.yaml:" + message};
}

INSTANTIATE_TEST_SUITE_P(
    OfTheGround, WorldMistake,
    testing::Values(
        ramp(
            "[[9, 0], [13, 0], [13, 3], [9, 3]]", "[[9, 0], [13, 0], [13, 2], [9, 2]]",
            "5:3: ground: the pieces must cover the room once: they have 25.000000 m² and the room "
            "29.000000 m²"),
        ramp("uphill_deg: 0", "uphill_deg: 90",
             "5:3: ground: piece 2 of the ground shares no level edge with an earlier one to be "
             "hinged along"),
        ramp("[4, 1], [9, 1], [9, 2], [4, 2]]", "[4, 1], [9, 1], [9, 2], [6, 1.2]]",
             "5:3: ground: piece 2 of the ground is not convex"),
        ramp("ground:",
             "obstacles:\n  - {polygon_m: [[3.5, 1.2], [4.5, 1.2], [4.5, 1.6], [3.5, "
             "1.6]], height_m: 1}\nground:",
             "7:3: ground: obstacle 1 stands across a fold"),
        ramp("grade: 0.1,", "grade: 0.5,",
             "6:58: ground[1].grade: found '0.5', must lie in [0, 0.25]"),
        Mistake{"version: 1\nroom: {width_m: 4, depth_m: 4}\nground:\n"
                "  - {polygon_m: [[0, 0], [4, 0], [4, 2], [0, 2]]}\n"
                "  - {polygon_m: [[0, 2], [2, 2], [2, 4], [0, 4]], grade: 0.1, uphill_deg: 90}\n"
                "  - {polygon_m: [[2, 2], [4, 2], [4, 4], [2, 4]]}\n",
                "w.yaml:4:3: ground: a step of 0.009950 m at [2, 2.1] has no wall along it"}));

INSTANTIATE_TEST_SUITE_P(
    OfAWallOrObstacle, WorldMistake,
    testing::Values(
        wall("{from_m: [2, 2], to_m: [2, 2]}",
             "28: walls[0].to_m: the wall has no length: it ends where it begins"),
        wall("{from_m: [2, 2], to_m: [2, 7]}",
             "28: walls[0].to_m: it reaches outside the room at [2.000 m, 6.500 m]"),
        wall("{from_m: [2, 2]}", "5: walls[0].to_m: the key is missing"),
        wall("{from_m: [2, 2], to_m: [2, 3], height_m: 3.5}",
             "46: walls[0].height_m: found 3.500 m, higher than the room's 3.000 m"),
        obstacle("[[1, 1], [2, 1], [2, 2]]", "4",
                 "5:15: obstacles[0].height_m: found 4.000 m, higher than the room's 3.000 m"),
        obstacle("[[1, 1], [2, 1]]", "1",
                 "4:16: obstacles[0].polygon_m: found a list of 2, must be a list of at least 3 "
                 "points [x, y]"),
        obstacle("[[1, 1], [2, 2], [2, 1], [1, 2]]", "1",
                 "4:16: obstacles[0].polygon_m: the polygon crosses itself: side 1 meets side 3"),
        obstacle(
            "[[9, 1], [11, 1], [11, 2]]", "1",
            "4:16: obstacles[0].polygon_m: it reaches outside the room at [10.500 m, 1.000 m]"),
        Mistake{
            "version: 1\n"
            "room: {outline_m: [[0, 0], [4, 0], [4, 4], [3, 4], [3, 1], [1, 1], [1, 4], [0, 4]]}\n"
            "walls: [{from_m: [0.5, 3], to_m: [3.5, 3]}]\n",
            "w.yaml:3:34: walls[0].to_m: it reaches outside the room at [2.000 m, 3.000 m]"}));

INSTANTIATE_TEST_SUITE_P(
    OfALandmark, WorldMistake,
    testing::Values(
        disc("[11, 3, 1.5]", "180", "0.1",
             "8:15: landmarks[0].centre_m: the landmark lies outside the room"),
        disc("[7.5, 2.5, 1.5]", "180", "0.1",
             "8:15: landmarks[0].centre_m: the landmark lies inside an obstacle"),
        disc("[2, 3, 1.5]", "180", "0.1",
             "8:15: landmarks[0].centre_m: the landmark is mounted on no wall: none that "
             "normal_deg is square to lies within 0.020 m (write 'free_standing: true' for one "
             "that needs none)"),
        disc("[0.021, 3, 1.5]", "0", "0.1",
             "8:15: landmarks[0].centre_m: the landmark is mounted on no wall: none that "
             "normal_deg is square to lies within 0.020 m (write 'free_standing: true' for one "
             "that needs none)"),
        disc("[0, 3, 1.5]", "45", "0.1",
             "8:15: landmarks[0].centre_m: the landmark is mounted on no wall: none that "
             "normal_deg is square to lies within 0.020 m (write 'free_standing: true' for one "
             "that needs none)"),
        disc("[0, 3, 1.5]", "180", "0.1",
             "9:17: landmarks[0].normal_deg: the landmark looks into the wall that it is mounted "
             "on"),
        disc("[7, 2.5, 1.5]", "0", "0.1",
             "9:17: landmarks[0].normal_deg: the landmark looks into the wall that it is mounted "
             "on"),
        disc("[5.01, 2.5, 1.5]", "180", "0.1",
             "9:17: landmarks[0].normal_deg: the landmark looks into the wall that it is mounted "
             "on"),
        disc("[7, 2.5, 1.95]", "180", "0.1",
             "8:15: landmarks[0].centre_m: the disc sticks out above its wall, which is 2.000 m "
             "high"),
        disc("[0, 3, 2.95]", "0", "0.1",
             "8:15: landmarks[0].centre_m: the disc reaches above the ceiling at 3.000 m"),
        disc("[0, 3, 0.05]", "0", "0.1",
             "8:15: landmarks[0].centre_m: the disc reaches below the floor"),
        disc("[7, 2.05, 1]", "180", "0.1",
             "8:15: landmarks[0].centre_m: the disc sticks out at the side of its wall, which is "
             "1.000 m long"),
        disc("[0, 3, 1.5]", "0", "-0.1",
             "10:15: landmarks[0].radius_m: found '-0.1', must lie in [0.005, 2]"),
        disc("[0, 3, 1.5]", "north", "0.1",
             "9:17: landmarks[0].normal_deg: found 'north', must be a number"),
        Mistake{
            std::string(kRoom) +
                "  - {id: 1, kind: disk, centre_m: [0, 3, 1.5], normal_deg: 0, radius_m: 0.1}\n",
            "w.yaml:6:19: landmarks[0].kind: found 'disk', must be one of disc, pattern, tag; did "
            "you mean 'disc'?"},
        Mistake{
            std::string(kRoom) +
                "  - {id: 1, kind: disc, centre_m: [0, 3, 1.5], normal_deg: 0, radius_m: 0.1}\n"
                "  - {id: 1, kind: disc, centre_m: [0, 2, 1.5], normal_deg: 0, radius_m: 0.1}\n",
            "w.yaml:7:10: landmarks[1].id: the id 1 occurs twice; it was given before at "
            "w.yaml:6:10"},
        Mistake{std::string(kRoom) +
                    "  - {id: 1, kind: disc, centre_m: [0, 3, 1.5], normal_deg: 0, radius_m: 0.1}\n"
                    "  - {id: 2, kind: disc, centre_m: [0, 3.1, 1.4], normal_deg: 0, radius_m: "
                    "0.1}\n",
                "w.yaml:7:35: landmarks[1].centre_m: the landmark overlaps landmark 1"},
        Mistake{std::string(kRoom) +
                    "  - {id: 1, kind: disc, centre_m: [0, 3, 1.5], normal_deg: 0, radius_m: 0.1, "
                    "colour: red}\n",
                "w.yaml:6:78: unknown key 'colour' in landmarks[0] (known: centre_m, "
                "free_standing, id, kind, normal_deg, radius_m)"}));

TEST(WorldMap, HoldsPatternsAndTags) {
  const WorldMap world = read_world(
      std::string(kRoom) +
      "  - {id: 1, kind: pattern, centre_m: [0, 3, 2.15], normal_deg: 0, floor: 2, room: 40,\n"
      "     pattern: 5, inner_radius_m: 0.07}\n"
      "  - {id: 2, kind: tag, centre_m: [0, 2, 1.5], normal_deg: 0, tag: 586, side_m: 0.2}\n");
  const auto& pattern = std::get<PatternShape>(world.landmarks.find(1)->shape);
  EXPECT_EQ(pattern.code, (PatternCode{2, 40, 5}));
  EXPECT_EQ(pattern.inner_radius_m, 0.07);
  EXPECT_EQ(pattern.outer_radius_m, PatternShape{}.outer_radius_m);
  EXPECT_EQ(half_width(*world.landmarks.find(1)), 0.15);
  EXPECT_EQ(std::get<TagShape>(world.landmarks.find(2)->shape).tag, 586);
  EXPECT_NEAR(half_width(*world.landmarks.find(2)), 0.15, 1e-12);
}

TEST(WorldMap, SheetsAndDiscsMayTouchAtTheirTrueExtent) {
  // The disc lies beyond the corner of the sheet: nearer than half widths added, yet apart.
  const WorldMap world = read_world(
      std::string(kRoom) +
      "  - {id: 1, kind: pattern, centre_m: [0, 3, 1.5], normal_deg: 0, floor: 0, room: 0,\n"
      "     pattern: 0}\n"
      "  - {id: 2, kind: disc, centre_m: [0, 3.23, 1.73], normal_deg: 0, radius_m: 0.1}\n"
      "  - {id: 3, kind: tag, centre_m: [0, 2.699, 1.5], normal_deg: 0, tag: 0, side_m: 0.2}\n");
  EXPECT_EQ(world.landmarks.all().size(), 3U);
}

Mistake pattern(const std::string& centre, const std::string& keys, const std::string& message) {
  return {std::string(kRoom) + "  - {id: 1, kind: pattern, centre_m: " + centre +
              ", normal_deg: 0,\n     floor: 1, room: 2" + keys + "}\n",
          "w.yaml:" + message};
}

Mistake pair(const std::string& first, const std::string& second, const std::string& message) {
  return {std::string(kRoom) + "  - {id: 1, centre_m: [0, 3, 1.5], normal_deg: 0, " + first +
              "}\n  - {id: 2, normal_deg: 0, " + second + "}\n",
          "w.yaml:7:" + message};
}

INSTANTIATE_TEST_SUITE_P(
    OfAPatternOrTag, WorldMistake,
    testing::Values(
        pattern("[0, 3, 1.5]", "", "6:5: landmarks[0].pattern: the key is missing"),
        pattern("[0, 3, 1.5]", ", pattern: 9",
                "7:34: landmarks[0].pattern: found '9', must lie in [0, 8]"),
        pattern("[0, 3, 1.5]", ", pattern: 1, outer_radius_m: 0.09",
                "7:53: landmarks[0].outer_radius_m: the outer ring's dots touch the inner ring's"),
        pattern("[0, 3, 1.5]", ", pattern: 1, sheet_half_width_m: 0.12",
                "7:57: landmarks[0].sheet_half_width_m: the outer ring's dots reach over the "
                "sheet's edge"),
        pattern("[0, 3, 2.9]", ", pattern: 1",
                "6:38: landmarks[0].centre_m: the sheet reaches above the ceiling at 3.000 m"),
        pattern("[0, 3, 0.1]", ", pattern: 1",
                "6:38: landmarks[0].centre_m: the sheet reaches below the floor"),
        pattern("[0, 5.9, 1.5]", ", pattern: 1",
                "6:38: landmarks[0].centre_m: the sheet sticks out at the side of its wall, which "
                "is 6.000 m long"),
        pair("kind: tag, tag: 7, side_m: 0.2",
             "centre_m: [0, 2.71, 1.6], kind: tag, tag: 8, side_m: 0.2",
             "38: landmarks[1].centre_m: the landmark overlaps landmark 1"),
        pair("kind: tag, tag: 7, side_m: 0.2",
             "centre_m: [0, 1, 1.6], kind: tag, tag: 7, side_m: 1",
             "67: landmarks[1].tag: landmark 1 shows the same code"),
        pair("kind: tag, tag: 7, side_m: 0.2",
             "centre_m: [0, 1, 1.6], kind: tag, tag: 587, side_m: 1",
             "67: landmarks[1].tag: found '587', must lie in [0, 586]"),
        pair("kind: disc, radius_m: 0.1", "centre_m: [0, 3.2, 1.6], kind: tag, tag: 7, side_m: 0.2",
             "38: landmarks[1].centre_m: the landmark overlaps landmark 1"),
        pair("kind: pattern, floor: 1, room: 2, pattern: 3",
             "centre_m: [0, 1, 1.5], kind: pattern, floor: 1, room: 2, pattern: 3",
             "94: landmarks[1].pattern: landmark 1 shows the same code")));

TEST(WorldMap, HoldsAFieldThatLiesInTheRoom) {
  const auto read = [](const std::string& room) {
    MapReader reader(parse_config("version: 1\nroom: {outline_m: " + room +
                                      ", height_m: 4}\nfield: {length_m: 6, width_m: 4, lines: "
                                      "[{points_m: [[-3, 0], [3, 0]]}]}\n",
                                  "w.yaml"),
                     "world");
    WorldMap world = read_world_map(reader);
    reader.finish();
    return world;
  };
  const WorldMap world = read("[[-5, -4], [5, -4], [5, 4], [-5, 4]]");
  ASSERT_TRUE(world.field);
  EXPECT_EQ(world.field->lines.size(), 1U);
  try {
    read("[[-3.5, -4], [5, -4], [5, 4], [-3.5, 4]]");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("field: it reaches outside the room"),
              std::string::npos)
        << error.what();
  }
}

/// Whether the camera of a robot at @p eye sees a landmark well enough for Armingol's Table 1.
bool sees(const WorldMap& world, const Landmark& landmark, const Eigen::Vector3d& eye) {
  const Eigen::Vector3d gaze = eye - landmark.centre_w();
  const double range = gaze.norm();
  return range >= 0.6 && range <= 9.0 &&
         gaze.dot(landmark.normal_w()) >= range * std::cos(from_deg(65.0)) &&
         world.plan.line_of_sight(eye, landmark.centre_w());
}

/// The room of the mission, and the loop through the mission's waypoints.
struct ArmingolRoom : testing::Test {
  void SetUp() override {
    MapReader mission(load_config(VIGIA_SOURCE_DIR "/config/missions/armingol-room.yaml"), "");
    MapReader world_reader = mission.map_or_file("world");
    world = read_world_map(world_reader);
    constexpr Range kCoordinate{0.0, 12.0};
    MapReader route = mission.map("route");
    std::vector<Eigen::Vector2d> corners = route.points2("via_m", kCoordinate, 1);
    corners.insert(corners.begin(), mission.map("start").vector2("position_m", kCoordinate));
    corners.push_back(route.vector2("goal_m", kCoordinate));
    loop = Path(corners);
  }

  WorldMap world;
  Path loop;
};

TEST_F(ArmingolRoom, SeesWhatTable1ListsFromEachControlArea) {
  const std::vector<std::set<int>> table1{{0, 4, 6}, {4}, {1, 2, 3}, {1, 2, 3},
                                          {2, 3, 4}, {4}, {0, 6}};
  for (std::size_t area = 0; area < table1.size(); ++area) {
    for (const Landmark& landmark : world.landmarks.all()) {
      int seen = 0;
      constexpr int kSamples = 12;
      for (int i = 0; i < kSamples; ++i) {
        const double s = 3.0 * static_cast<double>(area) + 0.25 * (i + 0.5);
        const Eigen::Vector2d at = loop.at(s);
        const double heading = loop.heading(s);
        seen += sees(world, landmark,
                     {at.x() + 0.15 * std::cos(heading), at.y() + 0.15 * std::sin(heading), 1.0});
      }
      const double share = static_cast<double>(seen) / kSamples;
      if (table1[area].count(landmark.id) != 0)
        EXPECT_GE(share, 0.6) << "area " << area << ", landmark " << landmark.id;
      else
        EXPECT_LE(share, 0.25) << "area " << area << ", landmark " << landmark.id;
    }
  }
}

TEST_F(ArmingolRoom, KeepsHalfAMetreFreeAroundTheLoop) {
  const Path dense = loop.resampled(0.05);
  for (const Eigen::Vector2d& p : dense.points())
    EXPECT_GE(world.plan.clearance(p), 0.5) << p.transpose();
}

}  // namespace
}  // namespace vigia
