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
  EXPECT_EQ(setup.zoom().samples().size(), 6U);
  EXPECT_NEAR(setup.zoom().at(8).px, 8.0 / 0.01375, 0.1);
  EXPECT_NEAR(setup.zoom().at(48).px, 48.0 / 0.01375, 0.1);
  EXPECT_DOUBLE_EQ(setup.robot.sensor.look_angle, from_deg(0.3));

  MapReader small_reader(load_config(dir / "b21-qvga.yaml"), "robot");
  const RobotSetup small = read_robot_setup(small_reader);
  small_reader.finish();
  EXPECT_EQ(small.zoom().at(8).width, 320);
  EXPECT_NEAR(small.zoom().at(8).px, 0.5 * setup.zoom().at(8).px, 0.1);
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

const std::string kStereo = R"(
cameras:
  - {mount: fixed, mount_m: [0.1, 0.06, 0.5], rpy_deg: [0, 20, 0], focal_px: 500, period_s: 0.1}
  - {id: 7, mount: fixed, mount_m: [0.1, -0.06, 0.5], rpy_deg: [0, 20, 0], focal_px: 500,
     period_s: 0.1, phase_s: 0.06, latency_s: 0.05}
  - {id: 3, mount: fixed, mount_m: [0, 0, 0.9], rpy_deg: [0, 90, 0], optics: omni, xi: 0.9,
     focal_px: 210, mirrored: true}
)";

TEST(RobotSetup, ReadsARigOfCamerasWithoutAHead) {
  const RobotSetup setup = setup_from(kStereo);
  const Rig rig = setup.rig();
  ASSERT_EQ(rig.cameras.size(), 3U);
  EXPECT_EQ(rig.cameras[0].id, 0);
  EXPECT_EQ(rig.cameras[1].id, 7);
  EXPECT_DOUBLE_EQ(rig.at(7).latency_s, 0.05);
  EXPECT_DOUBLE_EQ(std::get<Intrinsics>(rig.at(0).model(0.0)).px, 500.0);
  const auto mirror = std::get<UnifiedOmni>(rig.at(3).model(0.0));
  EXPECT_DOUBLE_EQ(mirror.py, -210.0);
  // It looks down: what is seen in the middle is below.
  EXPECT_LT((rig.at(3).rMc({}) * Eigen::Vector3d::UnitZ() - Eigen::Vector3d(0.0, 0.0, -0.1)).norm(),
            1e-12);
  // Twenty degrees down, ahead.
  const Eigen::Vector3d sight = rig.at(0).rMc({}).linear() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(sight.x(), std::cos(from_deg(20.0)), 1e-12);
  EXPECT_NEAR(sight.z(), -std::sin(from_deg(20.0)), 1e-12);
  EXPECT_EQ(setup.directed_camera(), nullptr);
  EXPECT_THROW(setup.zoom(), std::logic_error);
  EXPECT_EQ(setup.robot.head_limits.rate, 0.0);
  EXPECT_FALSE(setup.range_ring);
}

TEST(RobotSetup, ACameraOfTheListMayBeOnTheHeadWithAZoom) {
  const RobotSetup setup = setup_from(R"(
head: {mount_m: [0.2, 0, 1.1], mount_yaw_deg: 10}
cameras:
  - {id: 2, mount: fixed, focal_px: 400}
  - {id: 0, camera_offset_m: [0.05, 0, 0.01], optics: zoom,
     table: [{zoom_mm: 8, focal_px: 580}, {zoom_mm: 48, focal_px: 3490}]}
)");
  ASSERT_NE(setup.directed_camera(), nullptr);
  EXPECT_EQ(setup.directed_camera()->camera.id, 0);
  EXPECT_DOUBLE_EQ(setup.zoom().max_zoom_mm(), 48.0);
  EXPECT_DOUBLE_EQ(setup.robot.head.mount_r.x(), 0.2);
  EXPECT_DOUBLE_EQ(setup.robot.head.camera_offset_h.x(), 0.05);
  const Rig rig = setup.rig();
  const auto& mount = std::get<HeadGeometry>(rig.at(0).mount);
  EXPECT_DOUBLE_EQ(mount.mount_yaw, from_deg(10.0));
  EXPECT_DOUBLE_EQ(mount.camera_offset_h.z(), 0.01);
}

TEST(RobotSetup, SaysWhatIsWrongWithAListOfCameras) {
  const auto error = [](const std::string& cameras) {
    return error_of([&] { setup_from("cameras: [" + cameras + "]\n"); });
  };
  const std::string fixed = "{mount: fixed, focal_px: 400}";
  EXPECT_THAT(error(""), HasSubstr("at least one camera"));
  EXPECT_THAT(error(fixed + ", {id: 0, mount: fixed, focal_px: 400}"), HasSubstr("has this id"));
  EXPECT_THAT(error("{mount: roof, focal_px: 400}"), HasSubstr("fixed"));
  EXPECT_THAT(error("{mount: fixed}"), HasSubstr("focal_px"));
  EXPECT_THAT(error("{mount: fixed, focal_px: 400, xi: 1}"), HasSubstr("xi"));
  EXPECT_THAT(error("{focal_px: 400, mount_m: [0, 0, 1]}"), HasSubstr("mount_m"));
  EXPECT_THAT(error("{mount: fixed, focal_px: 400, kdu: -3}"), HasSubstr("folds"));
  EXPECT_THAT(error_of([&] { setup_from("cameras: [" + fixed + "]\n" + kTable); }),
              HasSubstr("zoom"));
  EXPECT_THAT(error_of([&] { setup_from("cameras: [" + fixed + "]\nhead: {}\n"); }),
              HasSubstr("head"));
}

TEST(RobotSetup, APhaseNeedsAPeriodThatItFitsInto) {
  const auto error = [](const std::string& timing) {
    return error_of(
        [&] { setup_from("cameras:\n  - {mount: fixed, focal_px: 400, " + timing + "}\n"); });
  };
  EXPECT_EQ(error("period_s: 0.2, phase_s: 0.19"), "no error");
  EXPECT_EQ(error("period_s: 0, phase_s: 0"), "no error");
  EXPECT_THAT(error("phase_s: 20"), AllOf(HasSubstr("robot.yaml:3:"), HasSubstr("phase_s"),
                                          HasSubstr("found 20"), HasSubstr("without a period_s")));
  EXPECT_THAT(error("period_s: 0.2, phase_s: 0.2"),
              AllOf(HasSubstr("robot.yaml:3:"), HasSubstr("found 0.2"),
                    HasSubstr("less than the camera's period_s, 0.2")));
}

TEST(RobotSetup, ACameraIsAboveTheFloorAndOutsideTheHull) {
  const auto error = [](const std::string& place, const std::string& base) {
    return error_of([&] {
      setup_from("cameras:\n  - {mount: fixed, focal_px: 400, mount_m: " + place + "}\n" +
                 "base: {radius_m: 0.25, " + base + "}\n");
    });
  };
  EXPECT_THAT(error("[0, 0, -0.5]", "speed_mps: 1"),
              AllOf(HasSubstr("robot.yaml:3:"), HasSubstr("must be > 0, found -0.5")));
  EXPECT_THAT(error("[0.1, 0, 0.5]", "body_height_m: 1"),
              AllOf(HasSubstr("robot.yaml:4:"), HasSubstr("camera 0 is mounted inside the hull"),
                    HasSubstr("body_height_m 1")));
  EXPECT_EQ(error("[0.1, 0, 0.5]", "body_height_m: 0"), "no error");
  EXPECT_EQ(error("[0.1, 0, 1]", "body_height_m: 1"), "no error");
  EXPECT_EQ(error("[0.25, 0, 0.5]", "body_height_m: 1"), "no error");
}

TEST(RobotSetup, ABaseMayGoSideways) {
  const RobotSetup setup =
      setup_from(kTable + "base: {speed_mps: 0.5, drive: omnidirectional, side_speed_mps: 0.4}\n");
  EXPECT_TRUE(setup.robot.base.omnidirectional());
  EXPECT_DOUBLE_EQ(setup.robot.base.side_speed, 0.4);
  EXPECT_DOUBLE_EQ(setup.robot.base.side_acceleration, 0.5);
  EXPECT_FALSE(setup_from(kTable).robot.base.omnidirectional());
  EXPECT_THAT(error_of([] { setup_from(kTable + "base: {side_speed_mps: 0.4}\n"); }),
              HasSubstr("side_speed_mps"));
}

TEST(Simulator, ExposesAnyCameraOfTheRig) {
  const RobotSetup setup = setup_from(kStereo);
  const WorldMap world = test_room();
  Simulator simulator(setup, world, appearance_of(world, ""), {2, 3, 0}, 9);
  simulator.advance(Duration::from_seconds(0.04));
  EXPECT_EQ(simulator.expose(3)->width(), 640);
  EXPECT_FALSE(imaging::grey_image(*simulator.expose(0)) ==
               imaging::grey_image(*simulator.expose(7)));
  EXPECT_THROW(simulator.expose(1), std::out_of_range);
}

TEST(Simulator, TheOpticalCentreMayBeBesideItsPlaceAndMovesNoOtherError) {
  const RobotSetup setup = setup_from(kTable);
  const WorldMap world = test_room();
  DisturbanceParams askew;
  askew.mounting.emplace();
  DisturbanceParams beside = askew;
  beside.mounting->camera_offset_m = 0.02;
  const CameraErrors without(askew, 9);
  const CameraErrors with(beside, 9);
  EXPECT_TRUE(without.mounting({0, 0, 1})->isApprox(*with.mounting({0, 0, 1}), 0.0));
  const auto offset = [&](const CameraErrors& errors) {
    return std::get<HeadGeometry>(errors.true_mount(setup.cameras.front().camera)).camera_offset_h;
  };
  EXPECT_EQ(offset(without).norm(), 0.0);
  EXPECT_GT(offset(with).norm(), 0.001);
  Simulator a(setup, world, appearance_of(world, ""), {2, 3, 0}, 9, askew);
  Simulator b(setup, world, appearance_of(world, ""), {2, 3, 0}, 9, beside);
  EXPECT_FALSE(imaging::grey_image(*a.expose()) == imaging::grey_image(*b.expose()));
}

TEST(Appearance, StripesAndMarksMayBeOnTheFloorOrTheCeiling) {
  const WorldMap world = test_room();
  const auto read = [&](const std::string& keys) {
    MapReader reader(parse_config("version: 1\n" + keys + "\n", "world.yaml"), "world");
    return read_appearance(reader, world);
  };
  const auto look = read(
      "stripes: [{from_m: [1, 1], to_m: [9, 1], on_ceiling: true}, {from_m: [1, 1], to_m: [1, "
      "6]}]\n"
      "clutter: [{kind: square, centre_m: [3, 3, 2.8], on_ceiling: true}]");
  ASSERT_EQ(look->stripes.size(), 2U);
  EXPECT_TRUE(look->stripes[0].on_ceiling);
  EXPECT_FALSE(look->stripes[1].on_ceiling);
  EXPECT_EQ(look->clutter.front().place, ClutterPlace::ceiling);
  EXPECT_THAT(error_of([&] { read("stripes: [{from_m: [1, 1], to_m: [1, 1]}]"); }),
              HasSubstr("no length"));
  EXPECT_THAT(
      error_of([&] { read("clutter: [{kind: ring, centre_m: [3, 3, 1], on_ceiling: true}]"); }),
      HasSubstr("room's height"));
  EXPECT_THAT(error_of([&] {
                read(
                    "clutter: [{kind: ring, centre_m: [3, 3, 0], on_floor: true, "
                    "on_ceiling: true}]");
              }),
              HasSubstr("not on both"));
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
  EXPECT_DOUBLE_EQ(std::get<Intrinsics>(simulator.true_model()).px, 580.0);
  simulator.robot().begin_look();
  const double error = simulator.robot().truth().look_log_focal_error;
  EXPECT_NE(error, 0.0);
  EXPECT_DOUBLE_EQ(std::get<Intrinsics>(simulator.true_model()).px, 580.0 * std::exp(error));
  EXPECT_DOUBLE_EQ(std::get<Intrinsics>(simulator.true_model()).py, 580.0 * std::exp(error));
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
