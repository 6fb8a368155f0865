#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "vigia/core/noise_params.hpp"
#include "vigia/sim/params.hpp"

namespace vigia::sim {
namespace {

void describe_base(ParamVisitor& v, RobotParams& robot) {
  v.number("radius_m", robot.radius_m, {0.01, 5.0}, "of the robot's hull");
  v.number("speed_mps", robot.base.speed, {0.001, 10.0}, "at most");
  v.number("acceleration_mps2", robot.base.acceleration, {0.001, 100.0}, "at most");
  v.angle("turn_rate_deg_s", robot.base.turn_rate, {0.1, 3600.0}, "at most");
  v.angle("turn_acceleration_deg_s2", robot.base.turn_acceleration, {0.1, 36000.0}, "at most");
}

/// A pair [low, high] in degrees, inside ±@p bound and holding more than one angle.
void describe_range(ParamVisitor& v, const char* key, double bound, double& low, double& high,
                    const About& about) {
  Eigen::Vector2d range(written_degrees(low), written_degrees(high));
  v.vector(key, range, {-bound, bound}, about);
  v.require(range.x() < range.y(), key, "the first of the two angles must be less than the second");
  low = from_deg(range.x());
  high = from_deg(range.y());
}

void describe_head(ParamVisitor& v, RobotParams& robot) {
  v.vector("mount_m", robot.head.mount_r, {-10.0, 10.0},
           "where the axes of pan and tilt cross, from the base's centre on the floor");
  v.require(robot.head.mount_r.z() > 0.0, "mount_m",
            "the third coordinate, the height above the floor, must be > 0");
  v.angle("mount_yaw_deg", robot.head.mount_yaw, {-180.0, 180.0}, "direction of pan 0 on the base");
  v.vector("camera_offset_m", robot.head.camera_offset_h, {-1.0, 1.0},
           "the optical centre from the crossing of the axes, turned with the head");
  HeadLimits& limits = robot.head_limits;
  describe_range(v, "pan_range_deg", 180.0, limits.pan_min, limits.pan_max,
                 "least and greatest pan");
  describe_range(v, "tilt_range_deg", 90.0, limits.tilt_min, limits.tilt_max,
                 "least and greatest tilt");
  v.angle("rate_deg_s", limits.rate, {0.1, 3600.0}, "of pan and of tilt, at most");
  v.angle("acceleration_deg_s2", limits.acceleration, {0.1, 100000.0},
          "of pan and of tilt, at most");
  v.number("zoom_rate_mm_s", limits.zoom_rate_mm_s, {0.0, 1000.0}, "of the zoom, at most");
}

struct Sensor {
  int width = 640;
  int height = 480;
  double u0 = 0.0;
  double v0 = 0.0;
};

void describe_camera(ParamVisitor& v, Sensor& sensor, ImagingParams& imaging) {
  v.integer("width_px", sensor.width, {16, 8192}, "of the image");
  v.integer("height_px", sensor.height, {16, 8192}, "of the image");
  sensor.u0 = 0.5 * (sensor.width - 1);
  sensor.v0 = 0.5 * (sensor.height - 1);
  v.number("u0_px", sensor.u0, {0.0, bound_of("width_px", sensor.width, -1.0)},
           About("of the principal point").otherwise("the middle"));
  v.number("v0_px", sensor.v0, {0.0, bound_of("height_px", sensor.height, -1.0)},
           About("of the principal point").otherwise("the middle"));
  v.number("noise_sigma", imaging.noise_sigma, {0.0, 100.0},
           About("σ of a pixel's noise").in("grey levels"));
  v.number("blur_px", imaging.blur_px, {0.0, 10.0}, "σ of the optical blur");
  v.boolean("colour", imaging.colour, "whether it sees colours");
}

/// Radius in normalised image coordinates beyond which the distortion folds the image over must
/// lie outside the picture.
bool folds_inside(const ZoomSample& row, const Sensor& sensor) {
  if (row.kdu >= 0.0) return false;
  const double du = std::max(sensor.u0, sensor.width - 1 - sensor.u0) / row.px;
  const double dv = std::max(sensor.v0, sensor.height - 1 - sensor.v0) / row.px;
  return 1.0 + 3.0 * row.kdu * (du * du + dv * dv) <= 0.05;
}

void describe_sample(ParamVisitor& v, const Sensor& sensor, std::vector<ZoomSample>& table) {
  ZoomSample sample;
  v.number("zoom_mm", sample.zoom_mm, {0.1, 10000.0},
           About("nominal focal length; increases from row to row").required());
  v.number("focal_px", sample.px, {1.0, 1e6},
           About("focal length; increases from row to row").required());
  v.number("kdu", sample.kdu, {-10.0, 10.0}, "radial distortion, as ViSP's");
  v.require(!folds_inside(sample, sensor), "kdu",
            "this distortion folds the picture over inside the image");
  v.require(table.empty() || (sample.zoom_mm > table.back().zoom_mm && sample.px > table.back().px),
            "zoom_mm", "zoom_mm and focal_px must both increase from row to row");
  table.push_back(sample);
}

void describe_zoom(ParamVisitor& v, const Sensor& sensor, RobotSetup& setup) {
  std::vector<ZoomSample> table;
  v.each("table", About("calibration, at least two rows").required(),
         [&] { describe_sample(v, sensor, table); });
  v.require(table.size() >= 2, "table",
            "a zoom table needs at least two rows {zoom_mm, focal_px, kdu}");
  setup.initial_zoom_mm = table.front().zoom_mm;
  v.number(
      "initial_mm", setup.initial_zoom_mm,
      {Bound("the table's first", table.front().zoom_mm), Bound("its last", table.back().zoom_mm)},
      About("where the zoom begins").otherwise("the table's first"));
  if (v.reader() != nullptr)
    setup.zoom =
        ZoomCalibration(sensor.width, sensor.height, sensor.u0, sensor.v0, std::move(table));
}

}  // namespace

Rig RobotSetup::rig() const {
  return head_rig(robot.head, zoom);
}

RobotParams usual_robot() {
  RobotParams robot;
  robot.base.turn_rate = from_deg(45.0);
  robot.base.turn_acceleration = from_deg(115.0);
  robot.head.mount_r = {0.15, 0.0, 1.2};
  robot.head_limits.pan_min = from_deg(-180.0);
  robot.head_limits.pan_max = from_deg(180.0);
  robot.head_limits.tilt_min = from_deg(-90.0);
  robot.head_limits.tilt_max = from_deg(90.0);
  robot.head_limits.rate = from_deg(90.0);
  robot.head_limits.acceleration = from_deg(450.0);
  robot.odometry.rot_per_sqrt_m = from_deg(0.3);
  robot.odometry.rot_per_sqrt_rad = from_deg(0.6);
  return robot;
}

void describe(ParamVisitor& v, RobotSetup& setup) {
  v.text("name", setup.name, "of the robot");
  v.map("base", "hull and drive", [&] { describe_base(v, setup.robot); });
  v.map("head", "the pan-tilt head", [&] { describe_head(v, setup.robot); });
  Sensor sensor;
  v.map("camera", "the camera's sensor", [&] { describe_camera(v, sensor, setup.imaging); });
  v.map("zoom", "the camera's lens", [&] { describe_zoom(v, sensor, setup); });
  v.map("odometry", setup.robot.odometry, "noise of the odometry");
  v.map("sensor", setup.robot.sensor, "noise of the head's and the zoom's readings");
  v.given("range_ring", [&] {
    v.map("range_ring", setup.range_ring.emplace(),
          "sonars round the base; without the key there are none");
  });
}

RobotSetup read_robot_setup(MapReader& reader) {
  RobotSetup setup;
  ParamReader visitor(reader);
  describe(visitor, setup);
  return setup;
}

}  // namespace vigia::sim
