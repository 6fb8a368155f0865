#include "vigia/core/params.hpp"

#include "config_files.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/key_reference.hpp"

namespace vigia {
namespace {

enum class Gait { walk, trot };

struct Legs {
  double stride_m = 0.5;
  double max_stride_m = 1.0;
};

struct Creature {
  std::string name = "horse";
  double age_s = 3.0;
  double tilt = from_deg(45.0);
  int count = 4;
  bool tame = true;
  Gait gait = Gait::trot;
  std::string food = "hay";
  Eigen::Vector2d place_m{1.0, 2.0};
  Eigen::Vector3d mount_m{0.0, 0.0, 1.5};
  std::optional<int> rider;
  std::vector<Eigen::Vector2d> trail;
  Legs legs;
  std::optional<Legs> ghost;
  std::vector<Legs> foals;
};

void describe(ParamVisitor& v, Legs& legs) {
  v.number("stride_m", legs.stride_m, {0.0, 5.0}, "of one step");
  v.number("max_stride_m", legs.max_stride_m, {bound_of("stride_m", legs.stride_m, 0.1), 5.0},
           "of the longest step");
}

void describe(ParamVisitor& v, Creature& c) {
  static const std::vector<std::string> foods{"hay", "oats"};
  v.text("name", c.name, "what it is called");
  v.number("age_s", c.age_s, {0.0, 1e9}, About("since birth").required());
  v.angle("tilt_deg", c.tilt, {-90.0, 90.0}, "of the head");
  v.integer("count", c.count, {1, 8}, "of legs");
  v.boolean("tame", c.tame, "comes when called");
  v.choice("gait", c.gait, {"walk", "trot"}, "how it goes");
  v.name("food", c.food, foods, About("what it eats").otherwise("what there is"));
  v.vector("place_m", c.place_m, {-10.0, 10.0}, "where it stands");
  v.vector("mount_m", c.mount_m, {-10.0, 10.0}, "where the saddle is");
  v.require(c.mount_m.z() > 0.0, "mount_m", "a saddle lies above the ground");
  v.given("rider", [&] {
    int rider = c.rider.value_or(0);
    v.integer("rider", rider, {0, 100}, About("who sits on it").required());
    c.rider = rider;
  });
  v.given("trail_m", [&] {
    v.points("trail_m", c.trail, {-10.0, 10.0}, 2, About("where it came along").required());
  });
  v.map("legs", c.legs, "what it stands on");
  v.toggle("ghost", c.ghost, !c.tame, "the other one");
  v.where(c.tame, "tame: true",
          [&] { v.each("foals", "its young", [&] { describe(v, c.foals.emplace_back()); }); });
}

Creature read(const std::string& text) {
  Creature creature;
  read_params(MapReader(parse_config("version: 1\n" + text, "c.yaml"), "creature"), creature);
  return creature;
}

std::string mistake(const std::string& text) {
  return input_error([&text] { read(text); });
}

KeyRow row(const std::string& key) {
  for (const KeyRow& row : key_reference<Creature>("creature."))
    if (row.key == key) return row;
  ADD_FAILURE() << key;
  return {};
}

TEST(Params, TakeEveryKindOfValueFromAFile) {
  const Creature c = read(
      "name: cow\nage_s: 7\ntilt_deg: -30\ncount: 8\ntame: true\ngait: walk\nfood: oats\n"
      "place_m: [3, 4]\nmount_m: [0, 1, 2]\nrider: 12\ntrail_m: [[0, 1], [2, 3]]\n"
      "legs: {stride_m: 2, max_stride_m: 3}\nghost: {stride_m: 0.1}\n"
      "foals: [{stride_m: 0.2}, {}]\n");
  EXPECT_EQ(c.name, "cow");
  EXPECT_EQ(c.age_s, 7.0);
  EXPECT_EQ(c.tilt, from_deg(-30.0));
  EXPECT_EQ(c.count, 8);
  EXPECT_EQ(c.gait, Gait::walk);
  EXPECT_EQ(c.food, "oats");
  EXPECT_EQ(c.place_m, Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(c.mount_m, Eigen::Vector3d(0.0, 1.0, 2.0));
  EXPECT_EQ(c.rider, 12);
  EXPECT_EQ(c.trail.size(), 2U);
  EXPECT_EQ(c.legs.max_stride_m, 3.0);
  ASSERT_TRUE(c.ghost);
  EXPECT_EQ(c.ghost->stride_m, 0.1);
  ASSERT_EQ(c.foals.size(), 2U);
  EXPECT_EQ(c.foals[1].stride_m, 0.5);
}

TEST(Params, AreWrittenBackInTheirOrderWithDefaults) {
  const auto root = parse_config("version: 1\nage_s: 7\n", "c.yaml");
  Creature creature;
  read_params(MapReader(root, "creature"), creature);
  EXPECT_EQ(dump_config(*root),
            "version: 1\nage_s: 7\nname: horse\ntilt_deg: 45\ncount: 4\ntame: true\ngait: trot\n"
            "food: hay\nplace_m: [1, 2]\nmount_m: [0, 0, 1.5]\n"
            "legs:\n  stride_m: 0.5\n  max_stride_m: 1\nghost: off\n");
}

TEST(Params, ThatAreLeftOutKeepTheValueThatTheFieldHas) {
  const Creature c = read("age_s: 7\n");
  EXPECT_EQ(c.name, "horse");
  EXPECT_EQ(c.tilt, from_deg(45.0));
  EXPECT_FALSE(c.rider);
  EXPECT_FALSE(c.ghost);
}

TEST(Params, OfASwitchAreRealisticOffOrAMap) {
  EXPECT_TRUE(read("age_s: 7\nghost: realistic\n").ghost);
  EXPECT_FALSE(read("age_s: 7\nghost: off\ntame: false\n").ghost);
  EXPECT_TRUE(read("age_s: 7\ntame: false\n").ghost);
  EXPECT_EQ(
      mistake("age_s: 7\nghost: on\n"),
      "c.yaml:3:8: creature.ghost: found 'on', must be one of off, realistic; did you mean 'off'?");
}

TEST(Params, AreRejectedWithTheirPlace) {
  EXPECT_EQ(mistake("name: cow\n"), "c.yaml:1:1: creature.age_s: the key is missing");
  EXPECT_EQ(mistake("age_s: 7\nlegs: {stride_m: 2, max_stride_m: 2}\n"),
            "c.yaml:3:35: creature.legs.max_stride_m: found '2', must lie in [2.1, 5]");
  EXPECT_EQ(mistake("age_s: 7\nfoals:\n  - {stride: 2}\n"),
            "c.yaml:4:6: unknown key 'stride' in creature.foals[0]; did you mean 'stride_m'? "
            "(known: max_stride_m, stride_m)");
  EXPECT_EQ(mistake("age_s: 7\nmount_m: [0, 0, -1]\n"),
            "c.yaml:3:10: creature.mount_m: a saddle lies above the ground");
  EXPECT_THAT(
      mistake("age_s: 7\ntame: false\nfoals: []\n"),
      ::testing::HasSubstr("c.yaml:4:1: the key 'foals' in creature counts only where tame: true"));
}

TEST(KeyReference, GivesUnitRangeDefaultAndMeaning) {
  const KeyRow tilt = row("creature.tilt_deg");
  EXPECT_EQ(tilt.kind, "number");
  EXPECT_EQ(tilt.unit, "°");
  EXPECT_EQ(tilt.range, "-90 … 90");
  EXPECT_EQ(tilt.usual, "45");
  EXPECT_EQ(tilt.meaning, "of the head");
  EXPECT_EQ(row("creature.gait").range, "walk, trot");
  EXPECT_EQ(row("creature.mount_m").usual, "[0, 0, 1.5]");
}

TEST(KeyReference, SaysWhereADefaultOrABoundComesFrom) {
  EXPECT_EQ(row("creature.food").usual, "what there is");
  EXPECT_EQ(row("creature.legs.max_stride_m").range, "stride_m + 0.1 … 5");
}

TEST(KeyReference, SaysWhatMustBeGivenAndWhatMayBeLeftOut) {
  EXPECT_TRUE(row("creature.age_s").required);
  EXPECT_EQ(row("creature.age_s").usual, "");
  EXPECT_FALSE(row("creature.rider").required);
  EXPECT_EQ(row("creature.rider").usual, "");
}

TEST(KeyReference, ReachesMapsSwitchesListsAndConditionalKeys) {
  EXPECT_EQ(row("creature.legs.stride_m").usual, "0.5");
  EXPECT_EQ(row("creature.ghost").usual, "off");
  EXPECT_EQ(row("creature.ghost.stride_m").usual, "0.5");
  EXPECT_EQ(row("creature.foals[].stride_m").usual, "0.5");
  EXPECT_EQ(row("creature.foals").where, "tame: true");
}

TEST(KeyReference, ReadsUnitsOffTheEndingsOfKeys) {
  EXPECT_EQ(unit_of_key("turn_acceleration_deg_s2"), "°/s²");
  EXPECT_EQ(unit_of_key("rot_per_sqrt_rad_deg"), "°/√rad");
  EXPECT_EQ(unit_of_key("clutter_per_m2"), "1/m²");
  EXPECT_EQ(unit_of_key("zoom_rate_mm_s"), "mm/s");
  EXPECT_EQ(unit_of_key("gain"), "");
}

TEST(WrittenDegrees, AreTheFigureThatThePersonWrote) {
  for (const double degrees : {0.0, 0.1, 0.3, 3.0, 6.0, 15.0, 30.0, 115.0, -450.0})
    EXPECT_EQ(written_degrees(from_deg(degrees)), degrees);
}

TEST(WrittenDegrees, ReadBackAsTheSameAngle) {
  for (const double radians : {1.0, 0.005, 1.5})
    EXPECT_EQ(from_deg(written_degrees(radians)), radians);
}

}  // namespace
}  // namespace vigia
