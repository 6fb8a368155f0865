#include <utility>

#include "vigia/sim/params.hpp"

namespace vigia::sim {

// Each disturbance's keys. Their defaults are what `realistic` means.

void describe(ParamVisitor& v, MotionBlurParams& p) {
  v.number("exposure_s", p.exposure_s, {0.0, 1.0}, "how long the shutter is open");
  v.integer("max_instants", p.max_instants, {1, 256}, "of which the mean is taken, at most");
}

void describe(ParamVisitor& v, LatencyParams& p) {
  v.number("latency_s", p.latency_s, {0.0, 10.0}, "from the middle of the exposure");
  v.number(
      "processing_s", p.processing_s, {0.0, 10.0},
      "that a frame takes once it has arrived; the newest of those that arrive meanwhile is next");
}

void describe(ParamVisitor& v, LightParams& p) {
  v.number("room", p.room, {0.0, 0.9}, "± of the gain over the room");
  v.number("drift", p.drift, {0.0, 0.9}, "± of the whole light in time");
  v.number("drift_period_s", p.drift_period_s, {1.0, 1e5}, "of the drift's slowest wave");
  v.number("lamp_step", p.lamp_step, {0.0, 1.0}, "share of its light that a lamp may lose");
  v.number("step_every_s", p.step_every_s, {0.0, 1e5}, "mean time between two steps; 0: none");
}

void describe(ParamVisitor& v, MountingParams& p) {
  v.angle("angle_deg", p.angle, {0.0, 10.0}, "σ of the head's yaw, pitch and roll on the base");
  v.number("offset_m", p.offset_m, {0.0, 0.5}, "σ of its place, each coordinate");
  v.number("camera_offset_m", p.camera_offset_m, {0.0, 0.5},
           "σ of the optical centre's place in the head, each coordinate");
}

void describe(ParamVisitor& v, ZoomCalibrationParams& p) {
  v.number("sigma", p.sigma, {0.0, 0.2}, "relative rms error of the focal lengths");
}

void describe(ParamVisitor& v, PrincipalPointParams& p) {
  v.number("drift_px", p.drift_px, {0.0, 100.0}, "from one end of the zoom to the other");
}

void describe(ParamVisitor& v, MirrorParams& p) {
  v.number("scale", p.scale, {0.0, 0.2}, "σ of the relative error of its focal length");
  v.angle("tilt_deg", p.tilt, {0.0, 10.0}, "σ of its tilt about either axis of the image");
  v.number("centre_px", p.centre_px, {0.0, 50.0}, "σ of either coordinate of its middle");
}

void describe(ParamVisitor& v, StereoParams& p) {
  v.number("baseline", p.baseline, {0.0, 0.2}, "σ of the relative error of the baseline");
  v.angle("vergence_deg", p.vergence, {0.0, 10.0}, "σ of the angle between the cameras' axes");
  v.number("focal", p.focal, {0.0, 0.2}, "σ of the relative error of the focal length of both");
}

void describe(ParamVisitor& v, BacklashParams& p) {
  v.angle("width_deg", p.width, {0.0, 10.0}, "play of the encoders");
}

void describe(ParamVisitor& v, WheelSlipParams& p) {
  v.number("per_m", p.per_m, {0.0, 100.0}, "slips that begin per metre driven");
  v.number("min_m", p.min_m, {0.0, 10.0}, "length of a slip");
  v.number("max_m", p.max_m, {bound_of("min_m", p.min_m), 10.0}, "length of a slip");
  v.number("min_loss", p.min_loss, {0.0, 1.0}, "share of the distance that a slip costs");
  v.number("max_loss", p.max_loss, {bound_of("min_loss", p.min_loss), 1.0},
           "share of the distance that a slip costs");
  v.angle("skew_deg_per_m", p.skew_per_m, {0.0, 90.0}, "σ of the turn that a slip adds");
  v.number("diameter", p.diameter, {0.0, 0.2}, "σ of the relative error of the wheels' diameter");
  v.number("base", p.base, {0.0, 0.2}, "σ of the relative error of the wheel base");
}

void describe(ParamVisitor& v, MapErrorParams& p) {
  v.number("sigma_m", p.sigma_m, {0.0, 0.5},
           "σ of a landmark's place in its plane, each coordinate");
  v.angle("turn_deg", p.turn, {0.0, 20.0}, "σ of its turn about the vertical");
}

void describe(ParamVisitor& v, MissingLandmarksParams& p) {
  v.number("probability", p.probability, {0.0, 1.0}, "of each landmark");
  v.integer("at_most_one_in", p.at_most_one_in, {1, 1000}, "landmarks; a map of fewer lacks none");
}

void describe(ParamVisitor& v, PeopleParams& p) {
  v.choice("kind", p.kind, {"people", "robots"}, "what they look like");
  v.integer("count", p.count, {0, 50}, "of them");
  v.number("radius_m", p.radius_m, {0.03, 0.6}, "of a person");
  v.number("height_m", p.height_m, {0.05, 2.5}, "of a person");
  v.number("speed_mps", p.speed_mps, {0.0, 3.0}, "of the fastest; the slowest has half of it");
  v.number("pause_probability", p.pause_probability, {0.0, 1.0}, "at the end of each leg");
  v.number("longest_pause_s", p.longest_pause_s, {0.0, 600.0}, "of a pause");
  v.number("distance_m", p.distance_m, {0.0, 3.0}, "that they keep from the robot's hull");
}

void describe(ParamVisitor& v, ClutterParams& p) {
  v.integer("marks", p.marks, {0, 1000}, "dark and round");
  v.integer("plates", p.plates, {0, 1000}, "light, with a dark mark on them");
}

void describe(ParamVisitor& v, KidnappingParams& p) {
  v.number("earliest_s", p.earliest_s, {0.0, 1e5}, "of the random time");
  v.number("latest_s", p.latest_s, {bound_of("earliest_s", p.earliest_s), 1e5},
           "of the random time");
  v.number("min_m", p.min_m, {0.0, 100.0}, "from where it was");
}

void describe(ParamVisitor& v, RampErrorParams& p) {
  v.angle("steeper_deg", p.steeper, {-10.0, 10.0},
          "by which they are steeper; what they lead to is higher");
}

void describe(ParamVisitor& v, DisturbanceParams& p) {
  enum class All { off, realistic };
  auto all = All::off;
  v.choice("all", all, {"off", "realistic"},
           "of every key that is absent, but `kidnapping` and `stereo`");
  const bool on = all == All::realistic;
  v.toggle("motion_blur", p.motion_blur, on,
           "a frame is the mean over the camera's motion while the shutter is open");
  v.toggle("latency", p.latency, on, "a frame arrives late, and takes time to process");
  v.toggle("light", p.light, on, "the light's gain varies over the room and in time");
  v.toggle("mounting", p.mounting, on, "the head sits a little askew on the base");
  v.toggle("zoom_calibration", p.zoom_calibration, on,
           "the table of focal lengths is a little wrong, smoothly over the zoom");
  v.toggle("principal_point", p.principal_point, on, "the optical axis wanders as the lens zooms");
  v.toggle("mirror", p.mirror, on, "an omnidirectional camera is not quite as calibrated");
  v.given("stereo",
          [&] { v.toggle("stereo", p.stereo, false, "a stereo pair is not quite as calibrated"); });
  v.toggle("backlash", p.backlash, on, "pan and tilt encoders follow the axes with play");
  v.toggle("wheel_slip", p.wheel_slip, on, "the wheels do not report what the base does");
  v.toggle("map_error", p.map_error, on, "landmarks hang a little off the place that the map has");
  v.toggle("missing_landmarks", p.missing_landmarks, on,
           "landmarks of the map that the room lacks");
  v.toggle("people", p.people, on,
           "walk about, hide what is behind them, keep a distance from the robot");
  v.toggle("clutter", p.clutter, on, "marks on the walls that resemble landmarks");
  v.toggle("kidnapping", p.kidnapping, false,
           "at a random time the robot is put elsewhere; odometry does not notice");
}

DisturbanceParams read_disturbances(MapReader reader) {
  DisturbanceParams params;
  read_params(std::move(reader), params);
  return params;
}

}  // namespace vigia::sim
