#include "sim/room.hpp"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/sim/simulator.hpp"

namespace vigia::sim {
namespace {

using testing::HasSubstr;

RobotSetup setup_from(const std::string& text) {
  MapReader reader(parse_config("version: 1\n" + text, "robot.yaml"), "robot");
  RobotSetup setup = read_robot_setup(reader);
  reader.finish();
  return setup;
}

const std::string kTable =
    "zoom: {table: [{zoom_mm: 8, focal_px: 580}, {zoom_mm: 48, focal_px: 3490}]}\n";

template <typename Read>
std::string error_of(Read read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RobotSetup, TheB21IsAsArmingolDescribesIt) {
  const std::filesystem::path dir = std::filesystem::path(VIGIA_SOURCE_DIR) / "config/robots";
  MapReader reader(load_config(dir / "b21.yaml"), "robot");
  const RobotSetup setup = read_robot_setup(reader);
  reader.finish();
  EXPECT_EQ(setup.name, "b21");
  EXPECT_DOUBLE_EQ(setup.robot.base.speed, 0.3);
  EXPECT_DOUBLE_EQ(setup.robot.head.mount_r.x(), 0.15);
  EXPECT_DOUBLE_EQ(setup.robot.head_limits.pan_max, kPi);
  EXPECT_EQ(setup.zoom.samples().size(), 6U);
  EXPECT_NEAR(setup.zoom.at(8).px, 8.0 / 0.01375, 0.1);
  EXPECT_NEAR(setup.zoom.at(48).px, 48.0 / 0.01375, 0.1);
  EXPECT_DOUBLE_EQ(setup.robot.sensor.look_angle, from_deg(0.3));

  MapReader small_reader(load_config(dir / "b21-qvga.yaml"), "robot");
  const RobotSetup small = read_robot_setup(small_reader);
  small_reader.finish();
  EXPECT_EQ(small.zoom.at(8).width, 320);
  EXPECT_NEAR(small.zoom.at(8).px, 0.5 * setup.zoom.at(8).px, 0.1);
}

TEST(RobotSetup, SaysWhereAndWhatIsWrong) {
  EXPECT_THAT(error_of([] { setup_from("zoom: {table: [{zoom_mm: 8, focal_px: 580}]}\n"); }),
              HasSubstr("at least two rows"));
  EXPECT_THAT(
      error_of([] {
        setup_from("zoom: {table: [{zoom_mm: 8, focal_px: 580}, {zoom_mm: 7, focal_px: 600}]}\n");
      }),
      AllOf(HasSubstr("robot.yaml:2:"), HasSubstr("increase")));
  EXPECT_THAT(error_of([] { setup_from(kTable + "head: {pan_range_deg: [90, -90]}\n"); }),
              AllOf(HasSubstr("robot.yaml:3:"), HasSubstr("less than")));
  EXPECT_THAT(error_of([] { setup_from(kTable + "head: {pan_range_deg: [-190, 180]}\n"); }),
              HasSubstr("robot.yaml:3:"));
  EXPECT_THAT(error_of([] { setup_from(kTable + "base: {speed_mps: -1}\n"); }),
              HasSubstr("speed_mps"));
  EXPECT_THAT(error_of([] { setup_from(kTable + "base: {spead_mps: 1}\n"); }),
              HasSubstr("spead_mps"));
  EXPECT_THAT(error_of([] {
                setup_from(
                    "zoom: {table: [{zoom_mm: 8, focal_px: 580, kdu: -1}, "
                    "{zoom_mm: 48, focal_px: 3490}]}\n");
              }),
              HasSubstr("folds"));
}

TEST(Appearance, ClutterOffEveryFaceIsAnError) {
  const WorldMap world = test_room();
  const auto read = [&](const std::string& clutter) {
    MapReader reader(parse_config("version: 1\nclutter:\n  - " + clutter + "\n", "world.yaml"),
                     "world");
    return read_appearance(reader, world);
  };
  EXPECT_THAT(error_of([&] { read("{kind: ring, centre_m: [3, 3, 1], normal_deg: 0}"); }),
              AllOf(HasSubstr("world.yaml:3:"), HasSubstr("on a face")));
  EXPECT_THAT(error_of([&] { read("{kind: star, centre_m: [12, 3, 1], normal_deg: 180}"); }),
              HasSubstr("half_disc"));
  EXPECT_THAT(error_of([&] { read("{kind: ring, centre_m: [3, 3, 1], on_floor: true}"); }),
              HasSubstr("height 0"));
  EXPECT_NO_THROW(read("{kind: ring, centre_m: [12, 3, 1], normal_deg: 180, size_m: 0.1}"));
}

TEST(Appearance, RandomClutterKeepsAwayFromTheLandmarks) {
  const WorldMap world = test_room();
  const auto look = appearance_of(world, "clutter_per_m2: 5");
  ASSERT_GT(look->clutter.size(), 300U);
  for (const Clutter& mark : look->clutter)
    for (const Landmark& landmark : world.landmarks.all())
      EXPECT_GT((mark.centre_w - landmark.centre_w()).norm(), 0.16 * std::sqrt(2.0) + mark.size_m);
}

TEST(Simulator, ExposesWithTheTrueFocalLengthOfTheLook) {
  RobotSetup setup = setup_from(kTable);
  setup.robot.sensor = {0.0, 0.0, 0.01};
  const WorldMap world = test_room();
  Simulator simulator(setup, world, appearance_of(world, ""), {2, 3, 0}, 9);
  EXPECT_DOUBLE_EQ(simulator.true_intrinsics().px, 580.0);
  simulator.robot().begin_look();
  const double error = simulator.robot().truth().look_log_focal_error;
  EXPECT_NE(error, 0.0);
  EXPECT_DOUBLE_EQ(simulator.true_intrinsics().px, 580.0 * std::exp(error));
  EXPECT_DOUBLE_EQ(simulator.true_intrinsics().py, 580.0 * std::exp(error));
  EXPECT_EQ(simulator.expose()->width(), 640);
}

TEST(Simulator, MeasuresClearanceFromTheHull) {
  RobotSetup setup = setup_from(kTable + "base: {radius_m: 0.25}\n");
  const WorldMap world = test_room();
  const Simulator simulator(setup, world, appearance_of(world, ""), {1, 3, 0}, 9);
  EXPECT_NEAR(simulator.clearance(), 0.75, 1e-12);
}

TEST(Simulator, TwoOfOneSeedGiveTheSameBytes) {
  const RobotSetup setup = setup_from(kTable);
  const WorldMap world = test_room();
  const auto look = appearance_of(world, "");
  Simulator a(setup, world, look, {2, 3, 0}, 9);
  Simulator b(setup, world, look, {2, 3, 0}, 9);
  for (Simulator* simulator : {&a, &b}) {
    simulator->robot().command({0.3, 0.2}, {{0.3, 0.1}, 4.0});
    simulator->robot().begin_look();
    simulator->robot().advance(Duration::from_seconds(1.0));
  }
  EXPECT_TRUE(imaging::grey_image(*a.expose()) == imaging::grey_image(*b.expose()));
  EXPECT_EQ(a.robot().read_odometry().trans, b.robot().read_odometry().trans);
}

}  // namespace
}  // namespace vigia::sim
