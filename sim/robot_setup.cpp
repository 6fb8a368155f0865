#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/noise_params.hpp"
#include "vigia/sim/params.hpp"

namespace vigia::sim {
namespace {

void describe_base(ParamVisitor& v, RobotParams& robot) {
  v.number("radius_m", robot.radius_m, {0.01, 5.0}, "of the robot's hull");
  v.number("body_height_m", robot.body_height_m, {0.0, 5.0},
           "of the hull as the robot's own cameras see it; 0: they do not");
  v.number("speed_mps", robot.base.speed, {0.001, 10.0}, "at most");
  v.number("acceleration_mps2", robot.base.acceleration, {0.001, 100.0}, "at most");
  v.angle("turn_rate_deg_s", robot.base.turn_rate, {0.1, 3600.0}, "at most");
  v.angle("turn_acceleration_deg_s2", robot.base.turn_acceleration, {0.1, 36000.0}, "at most");
  enum class Drive { unicycle, omnidirectional };
  auto drive = Drive::unicycle;
  v.choice("drive", drive, {"unicycle", "omnidirectional"}, "whether the base can go sideways");
  v.where(drive == Drive::omnidirectional, "`drive: omnidirectional`", [&] {
    robot.base.side_speed = robot.base.speed;
    robot.base.side_acceleration = robot.base.acceleration;
    v.number("side_speed_mps", robot.base.side_speed, {0.001, 10.0},
             About("sideways, at most").otherwise("`speed_mps`"));
    v.number("side_acceleration_mps2", robot.base.side_acceleration, {0.001, 100.0},
             About("sideways, at most").otherwise("`acceleration_mps2`"));
  });
  if (drive == Drive::unicycle) robot.base.side_speed = 0.0;
  v.given("wheels", [&] {
    v.map("wheels", "where the wheels touch the ground", [&] {
      WheelStance& wheels = robot.wheels.emplace();
      v.number("base_m", wheels.base_m, {0.01, 10.0},
               About("from the front to the rear").required());
      v.number("track_m", wheels.track_m, {0.01, 10.0},
               About("from the left to the right").required());
    });
  });
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

void describe_offset(ParamVisitor& v, Eigen::Vector3d& camera_offset_h) {
  v.vector("camera_offset_m", camera_offset_h, {-1.0, 1.0},
           "the optical centre from the crossing of the axes, turned with the head");
}

void describe_head(ParamVisitor& v, RobotParams& robot, bool listed) {
  v.vector("mount_m", robot.head.mount_r, {-10.0, 10.0},
           "where the axes of pan and tilt cross, from the base's centre on the floor");
  v.require(robot.head.mount_r.z() > 0.0, "mount_m",
            "the third coordinate, the height above the floor, must be > 0");
  v.angle("mount_yaw_deg", robot.head.mount_yaw, {-180.0, 180.0}, "direction of pan 0 on the base");
  v.where(!listed, "there is no list `cameras`",
          [&] { describe_offset(v, robot.head.camera_offset_h); });
  HeadLimits& limits = robot.head_limits;
  describe_range(v, "pan_range_deg", 180.0, limits.pan_min, limits.pan_max,
                 "from the smallest to the largest pan");
  describe_range(v, "tilt_range_deg", 90.0, limits.tilt_min, limits.tilt_max,
                 "from the smallest to the largest tilt");
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
  v.given("samples", [&] {
    v.integer("samples", imaging.samples, {1, 256},
              "of which the light of a pixel's square is the mean; from 2 on blur_px blurs every "
              "outline. Without the key surfaces have sharp outlines");
  });
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

/// The calibration; the zoom begins at @p initial_mm.
ZoomCalibration describe_zoom(ParamVisitor& v, const Sensor& sensor, double& initial_mm) {
  std::vector<ZoomSample> table;
  v.each("table", About("calibration, at least two rows").required(),
         [&] { describe_sample(v, sensor, table); });
  v.require(table.size() >= 2, "table",
            "a zoom table needs at least two rows {zoom_mm, focal_px, kdu}");
  if (table.empty()) return {};  // only where the keys are noted, not read
  initial_mm = table.front().zoom_mm;
  v.number(
      "initial_mm", initial_mm,
      {Bound("the table's first", table.front().zoom_mm), Bound("its last", table.back().zoom_mm)},
      About("where the zoom begins").otherwise("the table's first"));
  if (v.reader() == nullptr) return {};
  return {sensor.width, sensor.height, sensor.u0, sensor.v0, std::move(table)};
}

Intrinsics describe_pinhole(ParamVisitor& v, const Sensor& sensor) {
  ZoomSample lens;
  v.number("focal_px", lens.px, {1.0, 1e6}, About("focal length").required());
  v.number("kdu", lens.kdu, {-10.0, 10.0}, "radial distortion, as ViSP's");
  v.require(!folds_inside(lens, sensor), "kdu",
            "this distortion folds the picture over inside the image");
  return {sensor.width, sensor.height, lens.px, lens.px, sensor.u0, sensor.v0, lens.kdu};
}

UnifiedOmni describe_omni(ParamVisitor& v, const Sensor& sensor) {
  UnifiedOmni omni{sensor.width, sensor.height, 1.0, 230.0, 230.0, sensor.u0, sensor.v0};
  bool mirrored = false;
  v.number("xi", omni.xi, {0.0, 10.0},
           "of the unified model: 0 a pinhole, 1 a parabolic mirror, below a hyperbolic one");
  v.number("focal_px", omni.px, {1.0, 1e6},
           About("a direction θ off the axis is seen focal_px · sin θ/(cos θ + xi) from the middle")
               .required());
  v.boolean("mirrored", mirrored, "whether the image is turned over, as a mirror's is");
  v.angle("max_angle_deg", omni.max_angle, {1.0, 179.0}, "off the axis, the mirror's edge");
  omni.py = mirrored ? -omni.px : omni.px;
  return omni;
}

/// A camera that looks along the base's x axis when nothing turns it.
FixedMount describe_fixed_mount(ParamVisitor& v) {
  FixedMount mount;
  Eigen::Vector3d place(0.0, 0.0, 1.0);
  Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
  v.vector("mount_m", place, {-10.0, 10.0},
           "the optical centre, from the base's centre on the floor");
  v.require(place.z() > 0.0, "mount_m",
            fmt::format("the third coordinate, the height above the floor, must be > 0, found {:g}",
                        place.z()));
  v.vector("rpy_deg", rpy_deg, {-360.0, 360.0},
           "roll, pitch and yaw about the base's x, y and z of a camera that looks ahead: pitch 90 "
           "looks down, -90 up");
  mount.rMc.translation() = place;
  mount.rMc.linear() = (Eigen::AngleAxisd(from_deg(rpy_deg.z()), Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(from_deg(rpy_deg.y()), Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(from_deg(rpy_deg.x()), Eigen::Vector3d::UnitX()))
                           .toRotationMatrix() *
                       head_from_camera();
  return mount;
}

void describe_mount(ParamVisitor& v, CameraMount& mount) {
  enum class On { head, fixed };
  auto on = On::head;
  v.choice("mount", on, {"head", "fixed"}, "turned by the head, or fixed to the base");
  v.where(on == On::head, "`mount: head`", [&] {
    HeadGeometry head;
    describe_offset(v, head.camera_offset_h);
    if (on == On::head) mount = head;
  });
  v.where(on == On::fixed, "`mount: fixed`", [&] {
    const FixedMount fixed = describe_fixed_mount(v);
    if (on == On::fixed) mount = fixed;
  });
}

void describe_optics(ParamVisitor& v, CameraSetup& setup, double& initial_zoom_mm) {
  enum class Kind { pinhole, omni, zoom };
  auto kind = Kind::pinhole;
  v.choice("optics", kind, {"pinhole", "omni", "zoom"}, "how it sees");
  Sensor sensor;
  describe_camera(v, sensor, setup.imaging);
  Optics& optics = setup.camera.optics;
  v.where(kind == Kind::pinhole, "`optics: pinhole`", [&] {
    const Intrinsics pinhole = describe_pinhole(v, sensor);
    if (kind == Kind::pinhole) optics = CameraModel(pinhole);
  });
  v.where(kind == Kind::omni, "`optics: omni`", [&] {
    const UnifiedOmni omni = describe_omni(v, sensor);
    if (kind == Kind::omni) optics = CameraModel(omni);
  });
  v.where(kind == Kind::zoom, "`optics: zoom`", [&] {
    const ZoomCalibration zoom = describe_zoom(v, sensor, initial_zoom_mm);
    if (kind == Kind::zoom) optics = zoom;
  });
}

bool has_zoom(const CameraSetup& setup) {
  return std::holds_alternative<ZoomCalibration>(setup.camera.optics);
}

void require_phase_in_period(ParamVisitor& v, const Camera& camera) {
  if (camera.period_s == 0.0)
    v.require(camera.phase_s == 0.0, "phase_s",
              fmt::format("found {:g}, but without a period_s the camera exposes in every tick: "
                          "give it one, or leave the phase out",
                          camera.phase_s));
  else
    v.require(camera.phase_s < camera.period_s, "phase_s",
              fmt::format("found {:g}, must be less than the camera's period_s, {:g}",
                          camera.phase_s, camera.period_s));
}

void describe_listed(ParamVisitor& v, RobotSetup& setup) {
  CameraSetup item;
  item.camera.id = static_cast<CameraId>(setup.cameras.size());
  v.integer("id", item.camera.id, {0, 1000},
            About("names the camera").otherwise("its place in the list, from 0"));
  const auto same_id = [&](const CameraSetup& other) { return other.camera.id == item.camera.id; };
  v.require(std::none_of(setup.cameras.begin(), setup.cameras.end(), same_id), "id",
            "another camera has this id");
  describe_mount(v, item.camera.mount);
  describe_optics(v, item, setup.initial_zoom_mm);
  const bool second_zoom =
      has_zoom(item) && std::any_of(setup.cameras.begin(), setup.cameras.end(), has_zoom);
  v.require(!second_zoom, "optics", "a robot has one zoom at most");
  v.number("period_s", item.camera.period_s, {0.0, 100.0},
           "between two exposures, each in the tick in which its time falls; 0: one in every tick");
  v.number("phase_s", item.camera.phase_s, {0.0, 100.0},
           "of the first exposure, less than `period_s`");
  require_phase_in_period(v, item.camera);
  v.number("latency_s", item.camera.latency_s, {0.0, 10.0},
           "from the middle of the exposure to the delivery");
  setup.cameras.push_back(std::move(item));
}

bool has_head(const RobotSetup& setup) {
  return std::any_of(setup.cameras.begin(), setup.cameras.end(),
                     [](const CameraSetup& listed) { return on_head(listed.camera); });
}

/// Which camera the robot's own hull would surround, if any.
const Camera* camera_in_hull(const RobotSetup& setup) {
  const RobotParams& robot = setup.robot;
  for (const CameraSetup& listed : setup.cameras) {
    const auto* head = std::get_if<HeadGeometry>(&listed.camera.mount);
    const Eigen::Vector3d place =
        head != nullptr ? head->mount_r : Eigen::Vector3d(listed.camera.rMc({}).translation());
    const double reach = head != nullptr ? head->camera_offset_h.norm() : 0.0;
    if (place.head<2>().norm() + reach < robot.radius_m && place.z() + reach < robot.body_height_m)
      return &listed.camera;
  }
  return nullptr;
}

void require_outside_hull(ParamVisitor& v, const RobotSetup& setup) {
  const Camera* inside = camera_in_hull(setup);
  if (inside == nullptr) return;
  v.require(false, "base",
            fmt::format("camera {} is mounted inside the hull (radius_m {:g}, body_height_m {:g}) "
                        "and would see nothing else: mount it outside or above, or leave "
                        "body_height_m out",
                        inside->id, setup.robot.radius_m, setup.robot.body_height_m));
}

/// Gives the cameras on the head its geometry, and a robot without such a camera no head.
void mount_on_head(RobotSetup& setup) {
  for (CameraSetup& camera : setup.cameras) {
    auto* mount = std::get_if<HeadGeometry>(&camera.camera.mount);
    if (mount == nullptr) continue;
    const Eigen::Vector3d offset = mount->camera_offset_h;
    *mount = setup.robot.head;
    mount->camera_offset_h = offset;
  }
  if (const CameraSetup* directed = setup.directed_camera()) {
    setup.robot.head = std::get<HeadGeometry>(directed->camera.mount);
    if (!has_zoom(*directed)) setup.initial_zoom_mm = setup.zoom().min_zoom_mm();
  }
  if (!has_head(setup)) setup.robot.head_limits = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
}

}  // namespace

Rig RobotSetup::rig() const {
  Rig rig{{}};
  for (const CameraSetup& camera : cameras) rig.cameras.push_back(camera.camera);
  return rig;
}

const CameraSetup* RobotSetup::directed_camera() const {
  const Rig mine = rig();
  const Camera* directed = vigia::directed_camera(mine);
  if (directed == nullptr) return nullptr;
  return &cameras[static_cast<std::size_t>(directed - mine.cameras.data())];
}

ZoomCalibration RobotSetup::zoom() const {
  const CameraSetup* directed = directed_camera();
  if (directed == nullptr) throw std::logic_error("the robot has no camera that turns");
  return *zoom_calibration(directed->camera.optics);
}

RobotSetup pan_tilt_zoom_robot(const RobotParams& robot, const ZoomCalibration& zoom,
                               const ImagingParams& imaging) {
  RobotSetup setup;
  setup.robot = robot;
  setup.cameras = {{head_rig(robot.head, zoom).cameras.front(), imaging}};
  setup.initial_zoom_mm = zoom.min_zoom_mm();
  return setup;
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
  setup.cameras.clear();
  const bool listed = v.given("cameras", [&] {
    v.each("cameras", "the robot's cameras; without the key it has one, on the head, with a zoom",
           [&] { describe_listed(v, setup); });
    v.require(!setup.cameras.empty(), "cameras", "a robot has at least one camera");
  });
  v.where(!listed || has_head(setup), "a camera is on the head", [&] {
    v.map("head", "the pan-tilt head", [&] { describe_head(v, setup.robot, listed); });
  });
  v.where(!listed, "there is no list `cameras`", [&] {
    CameraSetup only;
    Sensor sensor;
    v.map("camera", "the camera's sensor", [&] { describe_camera(v, sensor, only.imaging); });
    v.map("zoom", "the camera's lens",
          [&] { only.camera.optics = describe_zoom(v, sensor, setup.initial_zoom_mm); });
    only.camera.mount = setup.robot.head;
    if (!listed) setup.cameras.push_back(only);
  });
  if (listed) mount_on_head(setup);
  require_outside_hull(v, setup);
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
