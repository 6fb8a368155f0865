#include "config_files.hpp"
#include "mistake.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "vigia/core/config.hpp"

namespace vigia {
namespace {

/// What a program might read: every getter once.
void read_everything(const std::string& text) {
  MapReader reader(parse_config(text, "m.yaml"), "");
  reader.number("speed_m_s", {0.0, 10.0}, 0.3);
  reader.number("least", {0.0, std::numeric_limits<double>::infinity()}, 1.0);
  reader.number("most", {-std::numeric_limits<double>::infinity(), 0.0}, 0.0);
  reader.integer("seed", {0.0, 1e15}, 1);
  reader.boolean("view", false);
  reader.text("name", "mission");
  reader.choice("policy", {"fixed", "random", "nearest"}, 2);
  reader.vector2("goal_m", {-100.0, 100.0}, {0.0, 0.0});
  reader.vector3("mount_m", {-1.0, 1.0}, {0.0, 0.0, 0.0});
  if (reader.has("outline_m")) reader.points2("outline_m", {0.0, 50.0}, 3);
  MapReader planner = reader.map("planner");
  if (reader.has("planner")) planner.number("limit_m", {0.01, 1.0});
  planner.boolean("late", false);
  planner.finish();
  for (MapReader via : reader.maps("vias")) {
    via.number("x_m", {0.0, 10.0});
    via.finish();
  }
  if (reader.has("world")) reader.map_or_file("world").finish();
  reader.finish();
}

class ConfigMistake : public testing::TestWithParam<Mistake> {};

TEST_P(ConfigMistake, IsReportedWithItsPlaceAndWhatWouldBeRight) {
  const auto& [text, message] = GetParam();
  EXPECT_EQ(input_error([text = text] { read_everything(text); }), message);
}

TEST(ConfigMistake, NoneIsFoundInAGoodFile) {
  EXPECT_EQ(input_error([] {
              read_everything(
                  "version: 1\nspeed_m_s: .5\nseed: 12\nview: true\nname: a\n"
                  "policy: fixed\ngoal_m: [1, 2]\nmount_m: [0, 0, 1]\n"
                  "outline_m: [[0, 0], [1, 0], [1, 1]]\nplanner: {limit_m: 0.1}\n"
                  "vias: [{x_m: 1}, {x_m: 2}]\nworld: {}\n");
            }),
            "");
}

constexpr const char* kKnown =
    " (known: goal_m, least, most, mount_m, name, outline_m, planner, policy, seed, speed_m_s, "
    "vias, view, world)";

INSTANTIATE_TEST_SUITE_P(
    OfTheWholeFile, ConfigMistake,
    testing::Values(
        Mistake{"", "m.yaml:1:1: there is nothing in it; write 'version: 1' and keys"},
        Mistake{"# only a comment\n",
                "m.yaml:1:1: there is nothing in it; write 'version: 1' and keys"},
        Mistake{"---\n", "m.yaml:1:1: there is nothing in it; write 'version: 1' and keys"},
        Mistake{"- 1\n- 2\n", "m.yaml:1:1: the top must be a map of keys and values"},
        Mistake{"just text\n", "m.yaml:1:1: the top must be a map of keys and values"},
        Mistake{"seed: 1\n",
                "m.yaml:1:1: the key 'version' is missing; write 'version: 1' at the top"},
        Mistake{"version: 2\n",
                "m.yaml:1:10: version: found '2', must be 1, the version that this program reads"},
        Mistake{"version: '1'\n",
                "m.yaml:1:10: version: found '1', must be 1, the version that this program reads"},
        Mistake{"version: 1\n---\nversion: 1\n",
                "m.yaml:2:1: a second document begins here; one is read"},
        Mistake{"version: 1\nseed: 1\nseed: 2\n",
                "m.yaml:3:1: the key 'seed' occurs twice; it was given before at m.yaml:2:1"},
        Mistake{"version: 1\nplanner: {limit_m: 1, limit_m: 1}\n",
                "m.yaml:2:23: the key 'limit_m' occurs twice; it was given before at m.yaml:2:11"},
        Mistake{"version: 1\ngoal_m: [1, 2\n",
                "m.yaml:3:1: this is not YAML: "
                "end of sequence flow not found"},
        Mistake{"version: 1\n\tseed: 1\n",
                "m.yaml:2:1: this is not YAML: illegal tab when looking for indentation"},
        Mistake{"version: 1\nname: \"open\n",
                "m.yaml:2:7: the quote that opens here is never closed"},
        Mistake{"version: 1\nname: 'it''s\nseed: 1\n",
                "m.yaml:2:7: the quote that opens here is never closed"},
        Mistake{"version: 1\nname: &n \"open \\\" more\n",
                "m.yaml:2:7: the quote that opens here is never closed"},
        Mistake{"version: 1\nseed: *nobody\n",
                "m.yaml:2:7: this is not YAML: the referenced anchor is not defined"},
        Mistake{"version: 1\nvias: &v [1, *v]\n",
                "m.yaml:2:14: the alias refers to the anchor that it lies in: a loop"},
        Mistake{"version: 1\nplanner: &p {late: {a: *p}}\n",
                "m.yaml:2:24: the alias refers to the anchor that it lies in: a loop"},
        Mistake{"version: 1\nseed: !!int 3\n",
                "m.yaml:2:7: the tag 'tag:yaml.org,2002:int' is not understood"},
        Mistake{"version: 1\n[a, b]: 3\n",
                "m.yaml:2:1: a key must be a short text (or a bracket is left open)"},
        Mistake{"version: 1\n~: 3\n",
                "m.yaml:2:1: a key must be a short text (or a bracket is left open)"},
        Mistake{"version: 1\nname: \xC3\x28\n", "m.yaml:2:7: the text is not valid UTF-8"},
        Mistake{"version: 1\nname: a\x04z\n",
                "m.yaml:2:8: a control character (code 4) does not belong into YAML"},
        Mistake{"version: 1\nextends: [a.yaml, b.yaml]\n",
                "m.yaml:2:10: extends: must be the name of one file"},
        Mistake{"version: 1\nextends:\n", "m.yaml:2:1: extends: must be the name of one file"},
        Mistake{"version: 1\nextends: nowhere/none.yaml\n",
                "m.yaml:2:10: the file 'nowhere/none.yaml' does not exist"},
        Mistake{"version: 1\nextends: /\n", "m.yaml:2:10: the file '/' is a directory"}));

INSTANTIATE_TEST_SUITE_P(
    OfAValue, ConfigMistake,
    testing::Values(
        Mistake{"version: 1\nspeed_m_s: 12\n",
                "m.yaml:2:12: speed_m_s: found '12', must lie in [0, 10]"},
        Mistake{"version: 1\nleast: -1\n", "m.yaml:2:8: least: found '-1', must be at least 0"},
        Mistake{"version: 1\nmost: 0.5\n", "m.yaml:2:7: most: found '0.5', must be at most 0"},
        Mistake{"version: 1\nspeed_m_s: fast\n",
                "m.yaml:2:12: speed_m_s: found 'fast', must be a number"},
        Mistake{"version: 1\nspeed_m_s: 3 m\n",
                "m.yaml:2:12: speed_m_s: found '3 m', must be a number"},
        Mistake{"version: 1\nspeed_m_s: '3'\n",
                "m.yaml:2:12: speed_m_s: found the text '3', must be a number"},
        Mistake{"version: 1\nspeed_m_s: [3]\n",
                "m.yaml:2:12: speed_m_s: found a list of 1, must be a number"},
        Mistake{"version: 1\nspeed_m_s: {a: 3}\n",
                "m.yaml:2:1: speed_m_s: found a map, must be a number"},
        Mistake{"version: 1\nspeed_m_s:\n",
                "m.yaml:2:1: speed_m_s: found nothing, must be a number"},
        Mistake{"version: 1\nspeed_m_s: .inf\n",
                "m.yaml:2:12: speed_m_s: found '.inf', must be a finite number"},
        Mistake{"version: 1\nspeed_m_s: .nan\n",
                "m.yaml:2:12: speed_m_s: found '.nan', must be a finite number"},
        Mistake{"version: 1\nspeed_m_s: nan\n",
                "m.yaml:2:12: speed_m_s: found 'nan', must be a finite number"},
        Mistake{"version: 1\nspeed_m_s: 1e999\n",
                "m.yaml:2:12: speed_m_s: found '1e999', must be a number that a double can hold"},
        Mistake{"version: 1\nseed: 1.5\n", "m.yaml:2:7: seed: found '1.5', must be a whole number"},
        Mistake{"version: 1\nseed: 99999999999999999999\n",
                "m.yaml:2:7: seed: found '99999999999999999999', must fit into 64 bits"},
        Mistake{"version: 1\nseed: -1\n", "m.yaml:2:7: seed: found '-1', must lie in [0, 1e+15]"},
        Mistake{"version: 1\nview: yes\n", "m.yaml:2:7: view: found 'yes', must be true or false"},
        Mistake{"version: 1\nview: 'true'\n",
                "m.yaml:2:7: view: found the text 'true', must be true or false"},
        Mistake{"version: 1\nname: [a]\n", "m.yaml:2:7: name: found a list of 1, must be a text"},
        Mistake{"version: 1\npolicy: nearst\n",
                "m.yaml:2:9: policy: found 'nearst', must be one of fixed, random, nearest; did "
                "you mean 'nearest'?"},
        Mistake{"version: 1\ngoal_m: [1, 2, 3]\n",
                "m.yaml:2:9: goal_m: found a list of 3, must be a list of 2 numbers"},
        Mistake{"version: 1\ngoal_m: 4\n",
                "m.yaml:2:9: goal_m: found '4', must be a list of 2 numbers"},
        Mistake{"version: 1\nmount_m: [0, x, 0]\n",
                "m.yaml:2:14: mount_m[1]: found 'x', must be a number"},
        Mistake{"version: 1\noutline_m: [[0, 0], [1, 1]]\n",
                "m.yaml:2:12: outline_m: found a list of 2, must be a list of at least 3 points "
                "[x, y]"},
        Mistake{"version: 1\noutline_m: [[0, 0], [1, 1], [1, 51]]\n",
                "m.yaml:2:33: outline_m[2][1]: found '51', must lie in [0, 50]"}));

INSTANTIATE_TEST_SUITE_P(
    OfAMap, ConfigMistake,
    testing::Values(
        Mistake{"version: 1\nplanner: 3\n",
                "m.yaml:2:10: planner: found '3', must be a map of keys and values"},
        Mistake{"version: 1\nplanner:\n  late: true\n",
                "m.yaml:2:1: planner.limit_m: the key is missing"},
        Mistake{"version: 1\nplanner:\n  limti_m: 0.1\n",
                "m.yaml:3:3: planner.limit_m: the key is missing; found 'limti_m'"},
        Mistake{"version: 1\nworld: {extends: w.yaml, a: 1}\n",
                "m.yaml:2:9: 'extends' belongs to the top of a file, not into a map within one; "
                "write the name of a file instead of the map"},
        Mistake{"version: 1\nvias: [{version: 1, x_m: 1}]\n",
                "m.yaml:2:9: 'version' belongs to the top of a file, not into a map within one; "
                "write the name of a file instead of the map"},
        Mistake{"version: 1\nplanner:\n  limit_m: 0.1\n  limt_m: 0.1\n",
                "m.yaml:4:3: unknown key 'limt_m' in planner; did you mean 'limit_m'? (known: "
                "late, limit_m)"},
        Mistake{"version: 1\nplanner:\n  limit_m: 0.1\n  xyzzy: {q: 0.1}\n",
                "m.yaml:4:3: unknown key 'xyzzy' in planner (known: late, limit_m)"},
        Mistake{"version: 1\nvias: {x_m: 1}\n",
                "m.yaml:2:1: vias: found a map, must be a list of maps"},
        Mistake{"version: 1\nvias: [{x_m: 1}, 7]\n",
                "m.yaml:2:18: vias[1]: found '7', must be a map of keys and values"},
        Mistake{"version: 1\nvias:\n  - x_m: 1\n  - x_m: 11\n",
                "m.yaml:4:10: vias[1].x_m: found '11', must lie in [0, 10]"},
        Mistake{"version: 1\nvias:\n  - {}\n", "m.yaml:3:5: vias[0].x_m: the key is missing"},
        Mistake{"version: 1\nworld: nowhere/none.yaml\n",
                "m.yaml:2:8: the file 'nowhere/none.yaml' does not exist"},
        Mistake{"version: 1\nworld: ''\n",
                "m.yaml:2:8: world: found the text '', must be a map or the name of a file"},
        Mistake{"version: 1\nworld: [1]\n",
                "m.yaml:2:8: world: found a list of 1, must be a map of keys and values"}));

TEST(ConfigMistake, ANameThatNoFolderCanHaveIsRefused) {
  for (const char* name : {"''", "../../x", "..", "/tmp/x"}) {
    const std::string message = input_error([name] {
      MapReader(parse_config(std::string("version: 1\nname: ") + name + "\n", "m.yaml"), "mission")
          .folder_name("name");
    });
    EXPECT_NE(message.find("m.yaml:2:7: mission.name: found "), std::string::npos) << message;
    EXPECT_NE(message.find("must be a name that a folder can have: not empty, no '/'"),
              std::string::npos)
        << message;
  }
}

TEST(ConfigMistake, AnUnknownKeyComesWithANearOneAndAllKnownOnes) {
  EXPECT_EQ(input_error([] { read_everything("version: 1\nsped_m_s: 3\n"); }),
            std::string("m.yaml:2:1: unknown key 'sped_m_s'; did you mean 'speed_m_s'?") + kKnown);
}

TEST(ConfigMistake, OfTheCommandLineNamesTheOption) {
  const auto root = parse_config("version: 1\n", "m.yaml");
  set_config(*root, "planner.limt_m=1");
  MapReader planner = MapReader(root, "").map("planner");
  planner.number("limit_m", {0.0, 1.0}, 0.1);
  EXPECT_EQ(input_error([&] { planner.finish(); }),
            "--set planner.limt_m=1: unknown key 'limt_m' in planner; did you mean 'limit_m'? "
            "(known: limit_m)");
}

TEST(ConfigMistake, DeepNestingIsRejected) {
  const std::string message = input_error([] {
    parse_config("version: 1\na: " + std::string(80, '[') + std::string(80, ']') + "\n", "m.yaml");
  });
  EXPECT_EQ(message, "m.yaml:2:67: nested deeper than 64 levels");
}

TEST(ConfigMistake, AliasesThatMultiplyWithoutBoundAreRejected) {
  std::string text = "version: 1\na0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string below = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + below;
    for (int k = 0; k < 9; ++k) text += ", " + below;
    text += "]\n";
  }
  EXPECT_EQ(input_error([&] { parse_config(text, "m.yaml"); }).find("m.yaml:7:"), 0U);
}

TEST(ConfigMistake, ALongValueIsShortenedInTheMessage) {
  const std::string message = input_error(
      [] { read_everything("version: 1\nspeed_m_s: " + std::string(500, 'x') + "\n"); });
  EXPECT_EQ(message,
            "m.yaml:2:12: speed_m_s: found '" + std::string(60, 'x') + "…', must be a number");
}

TEST(ConfigMistake, OfTheProgramsOwnFindingIsLocatedAtItsKey) {
  MapReader reader(parse_config("version: 1\ngoal_m: [1, 2]\n", "m.yaml"), "mission");
  EXPECT_STREQ(reader.error("goal_m", "lies in a wall").what(),
               "m.yaml:2:9: mission.goal_m: lies in a wall");
  EXPECT_STREQ(reader.error("start_m", "is not given").what(),
               "m.yaml:1:1: mission.start_m: is not given");
}

}  // namespace
}  // namespace vigia
