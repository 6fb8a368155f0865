#include "vigia/core/config.hpp"

#include "config_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vigia {
namespace {

using testing::HasSubstr;

constexpr Range kAny{-1e9, 1e9};

class ConfigFile : public ConfigFiles {};

TEST(Config, EveryValueKnowsItsLineAndColumn) {
  const auto root = parse_config("version: 1\na:\n  b: 3\n  c: [4, 5]\n", "x.yaml");
  const ConfigNode* b = root->find("a")->find("b");
  EXPECT_EQ(to_string(b->where), "x.yaml:3:6");
  EXPECT_EQ(to_string(b->key_where), "x.yaml:3:3");
  EXPECT_EQ(to_string(root->find("a")->find("c")->items[1]->where), "x.yaml:4:10");
}

TEST(Config, TheVersionIsTakenOutOfTheTree) {
  const auto root = parse_config("version: 1\na: 2\n", "x.yaml");
  EXPECT_EQ(root->find("version"), nullptr);
  EXPECT_EQ(root->entries.size(), 1U);
}

TEST_F(ConfigFile, ExtendsMergesMapsAndReplacesLists) {
  write("base.yaml", "version: 1\nkept: 1\nmap: {a: 1, b: {c: 2, d: 3}}\nlist: [1, 2, 3]\n");
  const auto file =
      write("top.yaml", "version: 1\nextends: base.yaml\nmap: {b: {d: 4}, e: 5}\nlist: [9]\n");
  const auto root = load_config(file);
  EXPECT_EQ(dump_config(*root),
            "version: 1\nkept: 1\nmap:\n  a: 1\n  b:\n    c: 2\n    d: 4\n  e: 5\nlist: [9]\n");
}

TEST_F(ConfigFile, AfterMergingEachValueStillKnowsItsFile) {
  const auto base = write("sub/base.yaml", "version: 1\na: 1\nb: 2\n");
  const auto file = write("top.yaml", "version: 1\nextends: sub/base.yaml\nb: 3\n");
  const auto root = load_config(file);
  EXPECT_EQ(to_string(root->find("a")->where), base.string() + ":2:4");
  EXPECT_EQ(to_string(root->find("b")->where), file.string() + ":3:4");
}

TEST_F(ConfigFile, AnEmptyMapLeavesTheExtendedOneAsItIs) {
  write("base.yaml", "version: 1\nmap: {a: 1}\n");
  const auto root = load_config(write("top.yaml", "version: 1\nextends: base.yaml\nmap:\n"));
  EXPECT_NE(root->find("map")->find("a"), nullptr);
}

TEST_F(ConfigFile, ExtendsReachesThroughSeveralFiles) {
  write("a.yaml", "version: 1\nx: 1\ny: 1\nz: 1\n");
  write("b.yaml", "version: 1\nextends: a.yaml\ny: 2\nz: 2\n");
  const auto root = load_config(write("c.yaml", "version: 1\nextends: b.yaml\nz: 3\n"));
  EXPECT_EQ(dump_config(*root), "version: 1\nx: 1\ny: 2\nz: 3\n");
}

TEST_F(ConfigFile, TwoFilesMayExtendTheSameOne) {
  write("base.yaml", "version: 1\nx: 1\n");
  write("left.yaml", "version: 1\nextends: base.yaml\n");
  const auto root = load_config(write("top.yaml", "version: 1\nextends: left.yaml\n"));
  EXPECT_EQ(root->find("x")->scalar, "1");
}

TEST_F(ConfigFile, ACycleOfExtendsIsNamed) {
  const auto a = write("a.yaml", "version: 1\nextends: b.yaml\n");
  const auto b = write("b.yaml", "version: 1\nextends: a.yaml\n");
  const std::string message = input_error([&] { load_config(a); });
  EXPECT_THAT(message, HasSubstr(b.string() + ":2:10: extends: the files extend each other: "));
  EXPECT_THAT(message, HasSubstr("a.yaml → "));
  EXPECT_THAT(message, HasSubstr("b.yaml → "));
}

TEST_F(ConfigFile, AFileThatExtendsItselfIsACycle) {
  const auto a = write("a.yaml", "version: 1\nextends: ./a.yaml\n");
  EXPECT_THAT(input_error([&] { load_config(a); }), HasSubstr("a.yaml:2:10: extends: the files"));
}

TEST_F(ConfigFile, AMissingFileADirectoryAndAnEmptyFileAreNamed) {
  const std::string missing = path("none.yaml").string();
  EXPECT_EQ(input_error([&] { load_config(missing); }), missing + ": the file does not exist");
  const std::string folder = path("").string();
  EXPECT_EQ(input_error([&] { load_config(folder); }), folder + ": the file is a directory");
  const std::string empty = write("empty.yaml", "").string();
  EXPECT_EQ(input_error([&] { load_config(empty); }),
            empty + ":1:1: there is nothing in it; write 'version: 1' and keys");
  EXPECT_THAT(input_error([] { load_config("/dev/null"); }), HasSubstr("not a regular file"));
}

TEST_F(ConfigFile, AMissingFileOfExtendsIsReportedWhereItIsAskedFor) {
  const auto file = write("top.yaml", "version: 1\nextends: none.yaml\n");
  EXPECT_EQ(input_error([&] { load_config(file); }),
            file.string() + ":2:10: the file '" + path("none.yaml").string() + "' does not exist");
}

TEST_F(ConfigFile, AMistakeInAnExtendedFileIsReportedThere) {
  const auto base = write("base.yaml", "version: 1\na: [1, 2\n");
  const auto file = write("top.yaml", "version: 1\nextends: base.yaml\n");
  EXPECT_THAT(input_error([&] { load_config(file); }), HasSubstr(base.string() + ":3:1: "));
}

TEST(Config, AliasesAreCopiesThatRememberWhereTheyStand) {
  const auto root = parse_config("version: 1\na: &x {k: 1}\nb: *x\n", "x.yaml");
  EXPECT_EQ(root->find("b")->find("k")->scalar, "1");
  EXPECT_EQ(to_string(root->find("b")->where), "x.yaml:3:4");
  set_config(*root, "b.k=2");
  EXPECT_EQ(root->find("a")->find("k")->scalar, "1");
}

class SetConfigFiles : public ConfigFiles {};

TEST(SetConfig, ReplacesAValueAtADottedPath) {
  const auto root = parse_config("version: 1\nplanner: {policy: fuzzy, limit_m: 1}\n", "x.yaml");
  set_config(*root, "planner.policy=nearest");
  EXPECT_EQ(root->find("planner")->find("policy")->scalar, "nearest");
  EXPECT_EQ(root->find("planner")->find("limit_m")->scalar, "1");
  EXPECT_EQ(to_string(root->find("planner")->find("policy")->where),
            "--set planner.policy=nearest");
}

TEST(SetConfig, MakesTheMapsOnItsWay) {
  const auto root = parse_config("version: 1\nnull_map:\n", "x.yaml");
  set_config(*root, "a.b.c=[1, 2]");
  set_config(*root, "null_map.x=1");
  EXPECT_EQ(dump_config(*root), "version: 1\nnull_map:\n  x: 1\na:\n  b:\n    c: [1, 2]\n");
}

TEST(SetConfig, TakesAKeyAwayByNull) {
  const auto root = parse_config("version: 1\na: {b: 1, c: {d: 2}}\n", "x.yaml");
  set_config(*root, "a.c=null");
  EXPECT_EQ(dump_config(*root), "version: 1\na:\n  b: 1\n");
  EXPECT_THAT(input_error([&] { set_config(*root, "a.c=null"); }),
              HasSubstr("--set a.c=null: 'c' is not there to be removed"));
}

TEST_F(SetConfigFiles, StepsIntoTheFileThatAValueNames) {
  write("robots/r.yaml", "version: 1\nhead: {rate: 1}\nname: r\n");
  const auto root = load_config(write("missions/m.yaml", "version: 1\nrobot: ../robots/r.yaml\n"));
  set_config(*root, "robot.head.rate=2");
  EXPECT_EQ(dump_config(*root), "version: 1\nrobot:\n  head:\n    rate: 2\n  name: r\n");
}

TEST_F(SetConfigFiles, ReportsAFileOnItsWayThatIsMissing) {
  const auto root = load_config(write("m.yaml", "version: 1\nrobot: none.yaml\n"));
  EXPECT_THAT(input_error([&] { set_config(*root, "robot.head=2"); }), HasSubstr("none.yaml"));
}

TEST(SetConfig, TakesWholeMapsAndKeepsWhatStandsAfterTheFirstEqualsSign) {
  const auto root = parse_config("version: 1\n", "x.yaml");
  set_config(*root, "a={b: 1, c: two}");
  set_config(*root, "d=e=f");
  EXPECT_EQ(root->find("a")->find("c")->scalar, "two");
  EXPECT_EQ(root->find("d")->scalar, "e=f");
}

TEST(SetConfig, ReachesTheItemsOfAList) {
  const auto root = parse_config(
      "version: 1\nrobot: {cameras: [{focal_px: 400}, {focal_px: 500}]}\ngrid: [[1, 2], [3, 4]]\n",
      "x.yaml");
  set_config(*root, "robot.cameras[1].period_s=0.5");
  const ConfigNode& cameras = *root->find("robot")->find("cameras");
  EXPECT_EQ(cameras.items[1]->find("period_s")->scalar, "0.5");
  EXPECT_EQ(cameras.items[1]->find("focal_px")->scalar, "500");
  EXPECT_EQ(cameras.items[0]->find("period_s"), nullptr);
  set_config(*root, "grid[1][0]=7");
  EXPECT_EQ(root->find("grid")->items[1]->items[0]->scalar, "7");
  EXPECT_EQ(root->find("grid")->items[1]->items[1]->scalar, "4");
  set_config(*root, "robot.cameras[0]=null");
  ASSERT_EQ(cameras.items.size(), 1U);
  EXPECT_EQ(cameras.items[0]->find("focal_px")->scalar, "500");
}

TEST(SetConfig, SaysWhatIsWrongWithAPlaceInAList) {
  const auto root = parse_config("version: 1\nlist: [1]\nmap: {a: 1}\n", "x.yaml");
  const auto error = [&](const std::string& assignment) {
    return input_error([&] { set_config(*root, assignment); });
  };
  EXPECT_EQ(error("list[1]=2"),
            "--set list[1]=2: 'list' has 1 item (x.yaml:2:7), counted from 0: there is no [1]");
  EXPECT_EQ(error("list[0].a=2"),
            "--set list[0].a=2: 'list' is a value (x.yaml:2:8), not a map with keys");
  EXPECT_EQ(error("map[0]=2"), "--set map[0]=2: 'map' is a map (x.yaml:3:6), not a list");
  EXPECT_EQ(error("none[0]=2"), "--set none[0]=2: there is no list 'none'");
  for (const std::string path : {"list[]", "list[a]", "list[0", "list[0]a", "list[-1]"})
    EXPECT_THAT(error(path + "=2"),
                HasSubstr("a place in a list is written key[0], counted from 0, found '" + path));
}

TEST(SetConfig, SaysWhatIsWrongWithAnAssignment) {
  const auto root = parse_config("version: 1\nlist: [1]\nscalar: 2\n", "x.yaml");
  const auto error = [&](const std::string& assignment) {
    return input_error([&] { set_config(*root, assignment); });
  };
  EXPECT_EQ(error("novalue"), "--set novalue: must read key=value");
  EXPECT_EQ(error("a..b=1"), "--set a..b=1: the key must be names joined by single dots");
  EXPECT_EQ(error("=1"), "--set =1: the key must be names joined by single dots");
  EXPECT_EQ(error("list.a=1"),
            "--set list.a=1: 'list' is a list (x.yaml:2:7), not a map with keys");
  EXPECT_EQ(error("scalar.a=1"),
            "--set scalar.a=1: 'scalar' is a value (x.yaml:3:9), not a map with keys");
  EXPECT_THAT(error("a=[1"), HasSubstr("--set a=[1: "));
  EXPECT_EQ(error("version=2"), "--set version=2: 'version' belongs to a file and cannot be set");
}

void expect_round_trip(const ConfigNode& root) {
  const std::string dumped = dump_config(root);
  const auto again = parse_config(dumped, "dump.yaml");
  EXPECT_TRUE(same_tree(root, *again)) << dumped;
  EXPECT_EQ(dump_config(*again), dumped);
}

TEST(DumpConfig, ReadsBackToTheSameTree) {
  const auto root = parse_config(R"(version: 1
plain: some text
quoted: "3"
single: 'it''s'
number: 1.50
empty:
tilde: ~
empty_text: ""
colon: "a: b # c"
tabs: "a\tb\nc\x01\x7F \" \\"
unicode: "übung → 你"
folded: >
  two
  lines
literal: |
  # not a comment
   indented
flow: {a: [1, [2, 3], "x, y"], b: {}, c: []}
"odd key: #": 1
"": 2
null_text: "null"
comma: a, b ] c
list:
  - name: x
    points: [[0, 1], [2, 3]]
  - - nested
    - {deep: 1}
  - text with spaces
  -
)",
                                 "x.yaml");
  expect_round_trip(*root);
}

TEST(DumpConfig, QuotesAPlainScalarThatWouldReadBackAsSomethingElse) {
  const auto root = parse_config("version: 1\nlist: [a b, -]\n", "x.yaml");
  EXPECT_EQ(dump_config(*root), "version: 1\nlist:\n  - a b\n  - \"-\"\n");
}

TEST(DumpConfig, KeepsNumbersAsTheyWereWritten) {
  const auto root = parse_config("version: 1\na: 1.50\nb: 1e3\nc: +7\n", "x.yaml");
  EXPECT_EQ(dump_config(*root), "version: 1\na: 1.50\nb: 1e3\nc: +7\n");
}

TEST(DumpConfig, WritesDefaultsInTheirShortestForm) {
  const auto root = parse_config("version: 1\n", "x.yaml");
  MapReader reader(root, "");
  reader.number("tenth", kAny, 0.1);
  reader.number("third", kAny, 1.0 / 3.0);
  reader.number("three", kAny, 3.0);
  reader.integer("count", kAny, -4);
  reader.boolean("flag", true);
  reader.text("text", "yes: no");
  reader.text("empty", "");
  reader.choice("kind", {"a", "b"}, 1);
  reader.vector2("v2", kAny, {0.5, -1.0});
  reader.vector3("v3", kAny, {0.0, 1e-7, 2.0});
  reader.map("sub").map("below").number("x", kAny, 2.5);
  reader.map("unused");
  EXPECT_EQ(dump_config(*root),
            "version: 1\ntenth: 0.1\nthird: 0.3333333333333333\nthree: 3\ncount: -4\nflag: true\n"
            "text: \"yes: no\"\nempty: \"\"\nkind: b\nv2: [0.5, -1]\nv3: [0, 1e-07, 2]\n"
            "sub:\n  below:\n    x: 2.5\n");
}

TEST(DumpConfig, OfAResolvedTreeResolvesToItself) {
  const auto read = [](const std::shared_ptr<ConfigNode>& root) {
    MapReader reader(root, "");
    reader.number("x", kAny, 0.30000000000000004);
    reader.map("m").text("t", "#");
    reader.finish();
  };
  const auto root = parse_config("version: 1\n", "x.yaml");
  read(root);
  const std::string dumped = dump_config(*root);
  const auto again = parse_config(dumped, "dump.yaml");
  read(again);
  EXPECT_EQ(dump_config(*again), dumped);
}

TEST_F(ConfigFile, ANamedFileTakesThePlaceOfItsName) {
  write("worlds/room.yaml", "version: 1\nname: room\nnested: {a: 1}\n");
  const auto file = write("missions/m.yaml", "version: 1\nworld: ../worlds/room.yaml\n");
  const auto root = load_config(file);
  MapReader reader(root, "");
  MapReader world = reader.map_or_file("world");
  EXPECT_EQ(world.text("name"), "room");
  EXPECT_EQ(dump_config(*root), "version: 1\nworld:\n  name: room\n  nested:\n    a: 1\n");
  expect_round_trip(*root);

  const auto again = parse_config(dump_config(*root), "elsewhere/dump.yaml");
  EXPECT_EQ(MapReader(again, "").map_or_file("world").text("name"), "room");
}

TEST_F(ConfigFile, AFileNameIsRelativeToTheFileThatItIsWrittenIn) {
  write("base/worlds/room.yaml", "version: 1\nname: room\n");
  write("base/base.yaml", "version: 1\nworld: worlds/room.yaml\n");
  const auto file = write("top.yaml", "version: 1\nextends: base/base.yaml\n");
  EXPECT_EQ(MapReader(load_config(file), "").map_or_file("world").text("name"), "room");
}

TEST_F(ConfigFile, AFileNameOfTheCommandLineIsRelativeToTheWorkingDirectory) {
  const auto room = write("room.yaml", "version: 1\nname: room\n");
  const auto root = load_config(write("deep/m.yaml", "version: 1\n"));
  set_config(*root, "world=" + std::filesystem::relative(room).string());
  EXPECT_EQ(MapReader(root, "").map_or_file("world").text("name"), "room");
}

TEST_F(ConfigFile, AMistakeInANamedFileIsReportedThere) {
  const auto room = write("room.yaml", "version: 1\nname: room\nsize: big\n");
  const auto root = load_config(write("m.yaml", "version: 1\nworld: room.yaml\n"));
  MapReader reader(root, "");
  MapReader world = reader.map_or_file("world");
  EXPECT_EQ(input_error([&] { world.number("size", kAny); }),
            room.string() + ":3:7: world.size: found 'big', must be a number");
}

TEST_F(ConfigFile, ANamedFileThatIsMissingIsReportedWhereItIsNamed) {
  const auto file = write("m.yaml", "version: 1\nworld: none.yaml\n");
  MapReader reader(load_config(file), "");
  EXPECT_EQ(input_error([&] { reader.map_or_file("world"); }),
            file.string() + ":2:8: the file '" + path("none.yaml").string() + "' does not exist");
}

}  // namespace
}  // namespace vigia
