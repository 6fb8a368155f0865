#include "vigia/core/renamed_keys.hpp"

#include "config_files.hpp"

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/config.hpp"

namespace vigia {
namespace {

using ::testing::HasSubstr;

TEST(RenamedKeys, AnEarlierNameIsAnErrorThatGivesThePresentOne) {
  MapReader mission(
      parse_config("version: 1\nplanner:\n  fuzzy:\n    least_value: 0.5\n", "m.yaml"), "mission");
  EXPECT_EQ(input_error([&] {
              MapReader fuzzy = mission.map("planner").map("fuzzy");
              fuzzy.number("min_value", {0.0, 1.0}, 0.9);
              fuzzy.finish();
            }),
            "m.yaml:4:5: the key 'planner.fuzzy.least_value' is now 'planner.fuzzy.min_value'");
}

TEST(RenamedKeys, AnEarlierNameIsReportedWhereThePresentOneIsRequired) {
  MapReader slip(parse_config("version: 1\nleast_m: 0.5\n", "m.yaml"), "disturbances.wheel_slip");
  EXPECT_EQ(input_error([&] {
              slip.number("min_m", {0.0, 1.0});
            }),
            "m.yaml:2:1: the key 'disturbances.wheel_slip.least_m' is now "
            "'disturbances.wheel_slip.min_m'");
}

TEST(RenamedKeys, TheSameWordElsewhereIsUnknown) {
  MapReader other(parse_config("version: 1\nleast_m: 0.5\n", "m.yaml"), "other");
  EXPECT_THAT(input_error([&] { other.finish(); }), HasSubstr("unknown key 'least_m' in other"));
}

TEST(RenamedKeys, NoneIsRenamedTwiceOrToAnEarlierName) {
  std::set<std::string> before;
  for (const RenamedKey& key : renamed_keys())
    EXPECT_TRUE(before.insert(key.before).second) << key.before;
  for (const RenamedKey& key : renamed_keys()) EXPECT_EQ(before.count(key.now), 0U) << key.now;
}

TEST(RenamedKeys, StandInTheChangelog) {
  std::ifstream file(VIGIA_SOURCE_DIR "/CHANGELOG.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const RenamedKey& key : renamed_keys())
    EXPECT_THAT(text, HasSubstr("| `" + key.before + "` | `" + key.now + "` |"));
}

}  // namespace
}  // namespace vigia
