#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "vigia/sim/simulator.hpp"

namespace vigia::sim {
namespace {

void read_base(MapReader base, RobotParams& robot) {
  robot.radius_m = base.number("radius_m", {0.01, 5.0}, 0.3);
  robot.base.speed = base.number("speed_mps", {0.001, 10.0}, 0.3);
  robot.base.acceleration = base.number("acceleration_mps2", {0.001, 100.0}, 0.5);
  robot.base.turn_rate = from_deg(base.number("turn_rate_deg_s", {0.1, 3600.0}, 45.0));
  robot.base.turn_acceleration =
      from_deg(base.number("turn_acceleration_deg_s2", {0.1, 36000.0}, 115.0));
  base.finish();
}

/// A pair [low, high] in degrees, inside ±@p bound and holding more than one angle.
std::pair<double, double> read_range(MapReader& reader, const std::string& key, double bound) {
  const Eigen::Vector2d range =
      reader.vector2(key, {-bound, bound}, Eigen::Vector2d(-bound, bound));
  if (range.x() >= range.y())
    throw reader.error(key, "the first of the two angles must be less than the second");
  return {from_deg(range.x()), from_deg(range.y())};
}

void read_head(MapReader head, RobotParams& robot) {
  robot.head.mount_r = head.vector3("mount_m", {-10.0, 10.0}, {0.15, 0.0, 1.2});
  if (robot.head.mount_r.z() <= 0.0)
    throw head.error("mount_m", "the third coordinate, the height above the floor, must be > 0");
  robot.head.mount_yaw = from_deg(head.number("mount_yaw_deg", {-180.0, 180.0}, 0.0));
  robot.head.camera_offset_h =
      head.vector3("camera_offset_m", {-1.0, 1.0}, Eigen::Vector3d::Zero());
  HeadLimits& limits = robot.head_limits;
  std::tie(limits.pan_min, limits.pan_max) = read_range(head, "pan_range_deg", 180.0);
  std::tie(limits.tilt_min, limits.tilt_max) = read_range(head, "tilt_range_deg", 90.0);
  limits.rate = from_deg(head.number("rate_deg_s", {0.1, 3600.0}, 90.0));
  limits.acceleration = from_deg(head.number("acceleration_deg_s2", {0.1, 100000.0}, 450.0));
  limits.zoom_rate_mm_s = head.number("zoom_rate_mm_s", {0.0, 1000.0}, 8.0);
  head.finish();
}

struct Sensor {
  int width;
  int height;
  double u0;
  double v0;
};

Sensor read_camera(MapReader camera, ImagingParams& imaging) {
  Sensor sensor{};
  sensor.width = static_cast<int>(camera.integer("width_px", {16, 8192}, 640));
  sensor.height = static_cast<int>(camera.integer("height_px", {16, 8192}, 480));
  sensor.u0 = camera.number("u0_px", {0.0, sensor.width - 1.0}, 0.5 * (sensor.width - 1));
  sensor.v0 = camera.number("v0_px", {0.0, sensor.height - 1.0}, 0.5 * (sensor.height - 1));
  imaging.noise_sigma = camera.number("noise_sigma", {0.0, 100.0}, 4.0);
  imaging.blur_px = camera.number("blur_px", {0.0, 10.0}, 0.7);
  imaging.colour = camera.boolean("colour", false);
  camera.finish();
  return sensor;
}

/// Radius in normalised image coordinates beyond which the distortion folds the image over must
/// lie outside the picture.
bool folds_inside(const ZoomSample& row, const Sensor& sensor) {
  if (row.kdu >= 0.0) return false;
  const double du = std::max(sensor.u0, sensor.width - 1 - sensor.u0) / row.px;
  const double dv = std::max(sensor.v0, sensor.height - 1 - sensor.v0) / row.px;
  return 1.0 + 3.0 * row.kdu * (du * du + dv * dv) <= 0.05;
}

void read_zoom(MapReader zoom, const Sensor& sensor, RobotSetup& setup) {
  std::vector<ZoomSample> table;
  for (MapReader& row : zoom.maps("table")) {
    ZoomSample sample;
    sample.zoom_mm = row.number("zoom_mm", {0.1, 10000.0});
    sample.px = row.number("focal_px", {1.0, 1e6});
    sample.kdu = row.number("kdu", {-10.0, 10.0}, 0.0);
    if (folds_inside(sample, sensor))
      throw row.error("kdu", "this distortion folds the picture over inside the image");
    if (!table.empty() && (sample.zoom_mm <= table.back().zoom_mm || sample.px <= table.back().px))
      throw row.error("zoom_mm", "zoom_mm and focal_px must both increase from row to row");
    table.push_back(sample);
    row.finish();
  }
  if (table.size() < 2)
    throw zoom.error("table", "a zoom table needs at least two rows {zoom_mm, focal_px, kdu}");
  const Range range{table.front().zoom_mm, table.back().zoom_mm};
  setup.initial_zoom_mm = zoom.number("initial_mm", range, range.low);
  setup.zoom = ZoomCalibration(sensor.width, sensor.height, sensor.u0, sensor.v0, std::move(table));
  zoom.finish();
}

void read_odometry(MapReader odometry, OdometryNoise& noise) {
  noise.trans_per_sqrt_m = odometry.number("trans_per_sqrt_m", {0.0, 1.0}, 0.01);
  noise.rot_per_sqrt_m = from_deg(odometry.number("rot_per_sqrt_m_deg", {0.0, 90.0}, 0.3));
  noise.rot_per_sqrt_rad = from_deg(odometry.number("rot_per_sqrt_rad_deg", {0.0, 90.0}, 0.6));
  odometry.finish();
}

void read_sensor(MapReader sensor, SensorNoise& noise) {
  noise.look_angle = from_deg(sensor.number("look_angle_deg", {0.0, 30.0}, 0.3));
  noise.reading_angle = from_deg(sensor.number("reading_angle_deg", {0.0, 30.0}, 0.0));
  noise.look_focal = sensor.number("look_focal", {0.0, 0.5}, 0.004);
  sensor.finish();
}

}  // namespace

Rig RobotSetup::rig() const {
  return head_rig(robot.head, zoom);
}

RobotSetup read_robot_setup(MapReader& reader) {
  RobotSetup setup;
  setup.name = reader.text("name", "robot");
  read_base(reader.map("base"), setup.robot);
  read_head(reader.map("head"), setup.robot);
  const Sensor sensor = read_camera(reader.map("camera"), setup.imaging);
  read_zoom(reader.map("zoom"), sensor, setup);
  read_odometry(reader.map("odometry"), setup.robot.odometry);
  read_sensor(reader.map("sensor"), setup.robot.sensor);
  if (reader.has("range_ring")) setup.range_ring = read_range_ring(reader.map("range_ring"));
  return setup;
}

}  // namespace vigia::sim
