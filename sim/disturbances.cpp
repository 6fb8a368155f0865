#include "vigia/sim/disturbances.hpp"

#include <string>

namespace vigia::sim {
namespace {

double degrees(MapReader& reader, const std::string& key, Range range, double fallback) {
  return from_deg(reader.number(key, range, to_deg(fallback)));
}

void read(MapReader& r, MotionBlurParams& p) {
  p.exposure_s = r.number("exposure_s", {0.0, 1.0}, p.exposure_s);
  p.most_instants = static_cast<int>(r.integer("most_instants", {1, 256}, p.most_instants));
}

void read(MapReader& r, LatencyParams& p) {
  p.latency_s = r.number("latency_s", {0.0, 10.0}, p.latency_s);
}

void read(MapReader& r, LightParams& p) {
  p.room = r.number("room", {0.0, 0.9}, p.room);
  p.drift = r.number("drift", {0.0, 0.9}, p.drift);
  p.drift_period_s = r.number("drift_period_s", {1.0, 1e5}, p.drift_period_s);
  p.lamp_step = r.number("lamp_step", {0.0, 1.0}, p.lamp_step);
  p.step_every_s = r.number("step_every_s", {0.0, 1e5}, p.step_every_s);
}

void read(MapReader& r, MountingParams& p) {
  p.angle = degrees(r, "angle_deg", {0.0, 10.0}, p.angle);
  p.offset_m = r.number("offset_m", {0.0, 0.5}, p.offset_m);
  p.camera_offset_m = r.number("camera_offset_m", {0.0, 0.5}, p.camera_offset_m);
}

void read(MapReader& r, ZoomCalibrationParams& p) {
  p.sigma = r.number("sigma", {0.0, 0.2}, p.sigma);
}

void read(MapReader& r, PrincipalPointParams& p) {
  p.drift_px = r.number("drift_px", {0.0, 100.0}, p.drift_px);
}

void read(MapReader& r, BacklashParams& p) {
  p.width = degrees(r, "width_deg", {0.0, 10.0}, p.width);
}

void read(MapReader& r, WheelSlipParams& p) {
  p.per_m = r.number("per_m", {0.0, 100.0}, p.per_m);
  p.least_m = r.number("least_m", {0.0, 10.0}, p.least_m);
  p.most_m = r.number("most_m", {p.least_m, 10.0}, p.most_m);
  p.least_loss = r.number("least_loss", {0.0, 1.0}, p.least_loss);
  p.most_loss = r.number("most_loss", {p.least_loss, 1.0}, p.most_loss);
  p.skew_per_m = degrees(r, "skew_deg_per_m", {0.0, 90.0}, p.skew_per_m);
  p.diameter = r.number("diameter", {0.0, 0.2}, p.diameter);
  p.base = r.number("base", {0.0, 0.2}, p.base);
}

void read(MapReader& r, MapErrorParams& p) {
  p.sigma_m = r.number("sigma_m", {0.0, 0.5}, p.sigma_m);
  p.turn = degrees(r, "turn_deg", {0.0, 20.0}, p.turn);
}

void read(MapReader& r, MissingLandmarksParams& p) {
  p.probability = r.number("probability", {0.0, 1.0}, p.probability);
  p.at_most_one_in = static_cast<int>(r.integer("at_most_one_in", {1, 1000}, p.at_most_one_in));
}

void read(MapReader& r, PeopleParams& p) {
  p.count = static_cast<int>(r.integer("count", {0, 50}, p.count));
  p.radius_m = r.number("radius_m", {0.1, 0.6}, p.radius_m);
  p.height_m = r.number("height_m", {0.5, 2.5}, p.height_m);
  p.speed_mps = r.number("speed_mps", {0.0, 3.0}, p.speed_mps);
  p.pause_probability = r.number("pause_probability", {0.0, 1.0}, p.pause_probability);
  p.longest_pause_s = r.number("longest_pause_s", {0.0, 600.0}, p.longest_pause_s);
  p.distance_m = r.number("distance_m", {0.0, 3.0}, p.distance_m);
}

void read(MapReader& r, ClutterParams& p) {
  p.marks = static_cast<int>(r.integer("marks", {0, 1000}, p.marks));
  p.plates = static_cast<int>(r.integer("plates", {0, 1000}, p.plates));
}

void read(MapReader& r, KidnappingParams& p) {
  p.earliest_s = r.number("earliest_s", {0.0, 1e5}, p.earliest_s);
  p.latest_s = r.number("latest_s", {p.earliest_s, 1e5}, p.latest_s);
  p.least_m = r.number("least_m", {0.0, 100.0}, p.least_m);
}

/// off, realistic, or a map.
template <typename Params>
void read_switch(MapReader& reader, const std::string& key, bool on,
                 std::optional<Params>& params) {
  if (reader.holds_map(key)) {
    params.emplace();
    MapReader detail = reader.map(key);
    read(detail, *params);
    detail.finish();
  } else if (reader.choice(key, {"off", "realistic"}, on ? 1 : 0) == 1) {
    params.emplace();
  }
}

}  // namespace

DisturbanceParams read_disturbances(MapReader reader) {
  DisturbanceParams params;
  const bool all = reader.choice("all", {"off", "realistic"}, 0) == 1;
  read_switch(reader, "motion_blur", all, params.motion_blur);
  read_switch(reader, "latency", all, params.latency);
  read_switch(reader, "light", all, params.light);
  read_switch(reader, "mounting", all, params.mounting);
  read_switch(reader, "zoom_calibration", all, params.zoom_calibration);
  read_switch(reader, "principal_point", all, params.principal_point);
  read_switch(reader, "backlash", all, params.backlash);
  read_switch(reader, "wheel_slip", all, params.wheel_slip);
  read_switch(reader, "map_error", all, params.map_error);
  read_switch(reader, "missing_landmarks", all, params.missing_landmarks);
  read_switch(reader, "people", all, params.people);
  read_switch(reader, "clutter", all, params.clutter);
  read_switch(reader, "kidnapping", false, params.kidnapping);
  reader.finish();
  return params;
}

}  // namespace vigia::sim
