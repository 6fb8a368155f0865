#include "sim/room.hpp"

#include <gtest/gtest.h>

#include "vigia/core/line_of_sight.hpp"
#include "vigia/sim/robot.hpp"

namespace vigia::sim {
namespace {

/// A room of 6 × 4 m, a ramp of 0.1 along x, 5 m long, as wide as the room, and a room above; dark
/// squares on the ramp, on its wall and on its ceiling.
constexpr const char* kRampWorld =
    "version: 1\nroom: {width_m: 16, depth_m: 4, height_m: 2.6}\n"
    "ground:\n"
    "  - {polygon_m: [[0, 0], [6, 0], [6, 4], [0, 4]]}\n"
    "  - {polygon_m: [[6, 0], [11, 0], [11, 4], [6, 4]], grade: 0.1, uphill_deg: 0}\n"
    "  - {polygon_m: [[11, 0], [16, 0], [16, 4], [11, 4]]}\n"
    "appearance: {contrast: 0}\n"
    "clutter:\n"
    "  - {kind: square, on_floor: true, centre_m: [8, 2, 0], size_m: 0.2, grey: 20}\n"
    "  - {kind: square, centre_m: [9, 4, 1.5], normal_deg: -90, size_m: 0.2, grey: 20}\n"
    "  - {kind: square, on_ceiling: true, centre_m: [8.5, 2, 2.6], size_m: 0.2, grey: 20}\n";

struct RampWorld {
  RampWorld() {
    MapReader reader(parse_config(kRampWorld, "ramp"), "world");
    world = read_world_map(reader);
    appearance = read_appearance(reader, world);
    reader.finish();
  }
  WorldMap world;
  std::shared_ptr<const Appearance> appearance;
};

int grey_at(const imaging::Frame& frame, const Eigen::Vector2d& uv) {
  unsigned char grey = 0;
  frame.read_grey(
      {static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y())), 1, 1}, &grey,
      1);
  return grey;
}

TEST(FoldedBuilding, ShowsWhatIsOnFloorWallAndCeilingOfARampWhereTheGroundHasIt) {
  const RampWorld ramp;
  const Scene scene(ramp.world, ramp.appearance, 1);
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  const Intrinsics intrinsics = camera(600);
  const Eigen::Isometry3d wMc = camera_at(3.0, 2.0, 0.0);
  const auto frame = scene.expose(wMc, intrinsics, {}, clean);
  const Eigen::Vector2d places[] = {{8.0, 2.0}, {9.0, 4.0}, {8.5, 2.0}};
  const double heights[] = {0.0, 1.5, 2.6};
  for (int i = 0; i < 3; ++i) {
    const auto shown = [&](double ahead) {
      const Eigen::Vector2d p = places[i] + Eigen::Vector2d(ahead, 0.0);
      const auto uv = project(
          intrinsics, Eigen::Vector3d(wMc.inverse() * ramp.world.ground.lift(p, heights[i])));
      return grey_at(*frame, *uv);
    };
    EXPECT_LT(shown(0.0), 60) << i;
    EXPECT_LT(shown(0.08), 60) << i;
    EXPECT_LT(shown(-0.08), 60) << i;
    EXPECT_GT(shown(0.3), 80) << i;
    EXPECT_GT(shown(-0.3), 80) << i;
  }
}

TEST(FoldedBuilding, HasNoHoleNearItsFolds) {
  const RampWorld ramp;
  const Scene scene(ramp.world, ramp.appearance, 1);
  ImagingParams clean;
  clean.noise_sigma = 0.0;
  const auto frame = scene.expose(camera_at(3.0, 2.0, 0.0), camera(300), {}, clean);
  const auto image = imaging::grey_image(*frame);
  for (unsigned v = 0; v < image.getHeight(); ++v)
    for (unsigned u = 0; u < image.getWidth(); ++u) ASSERT_GT(image[v][u], 0) << u << ", " << v;
}

TEST(RobotOnARamp, HasItsCameraRaisedAndPitchedWithItsWheels) {
  const RampWorld ramp;
  RobotParams params;
  params.wheels = WheelStance{0.6, 0.4};
  Robot robot(params, {5.0, 2.0, 0.0}, 8.0, 1, ramp.world.ground.under(params.stance()));
  const double slope = std::atan(0.1);
  robot.place({8.0, 2.0, 0.0}, {});
  EXPECT_NEAR(robot.wMr().translation().z(), 2.0 * std::sin(slope), 1e-12);
  const Eigen::Isometry3d rMc = mounted_camera(params.head, {});
  EXPECT_TRUE(robot.camera_pose().isApprox(robot.wMr() * rMc, 1e-12));
  // Its front axle at the fold it is level yet; 60 cm on it has the whole slope.
  robot.place({5.7, 2.0, 0.0}, {});
  EXPECT_NEAR(robot.wMr().linear()(2, 0), 0.0, 1e-12);
  robot.place({6.3, 2.0, 0.0}, {});
  EXPECT_NEAR(robot.wMr().linear()(2, 0), std::sin(slope), 1e-12);
}

}  // namespace
}  // namespace vigia::sim
