#include "vigia/servo/params.hpp"

namespace vigia::servo {

void describe(ParamVisitor& v, PanTiltServoParams& p) {
  v.number("gain", p.gain, {0.0, 50.0}, About("decay of the image error").in("1/s"));
  v.boolean("feed_forward", p.feed_forward, "compensate the base's motion");
}

void describe(ParamVisitor& v, ZoomControlParams& p) {
  v.number("gain", p.gain, {0.0, 50.0}, About("k of ḟ/f = k ln(a*/a) + Ż/Z").in("1/s"));
  v.number("dead_band", p.dead_band, {0.0, 2.0}, "|ln(a*/a)| below which the zoom rests");
}

void describe(ParamVisitor& v, GazeParams& p) {
  v.map("servo", p.servo, "pan and tilt while a landmark is tracked");
  v.map("zoom", p.zoom, "the zoom while a landmark is tracked");
  v.number("settle_deg", p.settle_deg, {0.01, 30.0}, "from the aim, where a slew has arrived");
  v.number("settle_focal", p.settle_focal, {0.001, 1.0},
           "relative distance from the wanted focal length, where a slew has arrived");
  v.number("lost_grace_s", p.lost_grace_s, {0.0, 10.0},
           "unseen this long beyond the camera's period, a target is lost");
  v.number("acquire_s", p.acquire_s, {0.0, 60.0},
           "not found for this long beyond the camera's period and latency, the search begins");
  v.number("search_s", p.search_s, {0.0, 60.0}, "how long the search lasts");
  v.number("search_step_deg", p.search_step_deg, {0.1, 60.0},
           "pitch of the search spiral at the widest zoom");
  v.number("search_radius_px", p.search_radius_px, {2.0, 200.0},
           "apparent radius down to which the zoom widens while searching");
  v.number("motion_horizon_s", p.motion_horizon_s, {0.0, 60.0},
           "how far ahead the base's motion is foreseen");
  v.angle("look_angle_deg", p.look_angle, {0.0, 10.0},
          About("σ of the head, for the zoom at which the landmark is still in the image")
              .otherwise("that of `localization.noise`"));
  v.number("aim_gain", p.aim_gain, {0.1, 50.0},
           About("of a slew's end; more than the whole error in a tick is refused")
               .in("1/s")
               .otherwise("10, or 0.8 of the error in a tick where that is less"));
}

}  // namespace vigia::servo
