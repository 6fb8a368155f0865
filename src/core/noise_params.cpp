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

}  // namespace vigia
