#include "vigia/core/noise_params.hpp"

namespace vigia {

void describe(ParamVisitor& v, OdometryNoise& p) {
  v.number("trans_per_sqrt_m", p.trans_per_sqrt_m, {0.0, 1.0},
           "random walk along the path, by the distance driven");
  v.angle("rot_per_sqrt_m_deg", p.rot_per_sqrt_m, {0.0, 90.0},
          "random walk of the heading, by the distance driven");
  v.angle("rot_per_sqrt_rad_deg", p.rot_per_sqrt_rad, {0.0, 90.0},
          "random walk of the heading, by the angle turned");
}

void describe(ParamVisitor& v, SensorNoise& p) {
  v.angle("look_angle_deg", p.look_angle, {0.0, 30.0},
          "σ of pan and of tilt, constant during a look");
  v.angle("reading_angle_deg", p.reading_angle, {0.0, 30.0},
          "σ of pan and of tilt, white per reading");
  v.number("look_focal", p.look_focal, {0.0, 0.5},
           "relative σ of the focal length, constant during a look");
}

void describe(ParamVisitor& v, StereoCalibrationNoise& p) {
  v.number("baseline", p.baseline, {0.0, 0.2}, "σ of the relative error of the baseline");
  v.angle("vergence_deg", p.vergence, {0.0, 10.0}, "σ of the angle between the cameras' axes");
  v.number("focal", p.focal, {0.0, 0.2}, "σ of the relative error of the focal length of both");
}

void describe(ParamVisitor& v, NoiseModel& p) {
  v.map("odometry", p.odometry, About("of the odometry").otherwise("the robot's"));
  v.map("sensor", p.sensor, About("of the head and the zoom").otherwise("the robot's"));
  v.number("centre_floor_px", p.centre_floor_px, {0.0, 10.0},
           "σ of what the model of a disc's centre, or of a point, leaves out");
  v.number("size_floor", p.size_floor, {0.0, 1.0},
           "relative σ of what the model of a disc's size leaves out");
  v.given("stereo", [&] {
    v.map("stereo", p.stereo, "of a stereo pair's calibration, constant along a drive");
  });
}

}  // namespace vigia
