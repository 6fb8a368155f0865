#include "vigia/localization/params.hpp"

#include "vigia/core/noise_params.hpp"

namespace vigia::localization {
namespace {

constexpr const char* kFromNoise = "that of `localization.noise`";

// What filters of looks have in common, whatever they learn from them.

template <typename Params>
void describe_noise(ParamVisitor& v, Params& p) {
  v.map("odometry", p.odometry,
        About("the odometry's noise that this localizer assumes").otherwise(kFromNoise));
  v.map("sensor", p.sensor,
        About("the head's and the zoom's noise that it assumes").otherwise(kFromNoise));
}

template <typename Params>
void describe_association(ParamVisitor& v, Params& p) {
  v.number("gate_probability", p.gate_probability, {0.5, 0.999999},
           "share of right measurements that pass a gate");
  v.number("ambiguity_ratio", p.ambiguity_ratio, {1.0, 1e9},
           "how many times likelier than the next the best landmark must be");
}

template <typename Params>
void describe_loss(ParamVisitor& v, Params& p) {
  v.number("history_s", p.history_s, {0.0, 60.0}, "how late an observation may come");
  v.number("lost_sigma_m", p.lost_sigma_m, {0.01, 100.0},
           "lost while √λ_max of the position covariance is above this");
  v.integer("lost_rejections", p.lost_rejections, {1, 100000},
            "lost after so many unexplained images in a row, …");
  v.integer("lost_looks", p.lost_looks, {1, 1000},
            "… in at least so many looks, or seconds of a fixed camera");
}

}  // namespace

void describe(ParamVisitor& v, EkfParams& p) {
  describe_noise(v, p);
  describe_association(v, p);
  v.number("centre_floor_px", p.centre_floor_px, {0.0, 10.0},
           About("σ of what the model of a disc's centre, or of a point, leaves out")
               .otherwise(kFromNoise));
  v.number("size_floor", p.size_floor, {0.0, 1.0},
           About("relative σ of what the model of a disc's size leaves out").otherwise(kFromNoise));
  v.boolean("use_size", p.use_size,
            "measure the disc's apparent size; `false`: its direction only, as Armingol (the size "
            "still tells discs apart)");
  v.integer("iterations", p.iterations, {1, 20}, "of the joint linearisation of a look, at most");
  v.integer("look_images", p.look_images, {1, 10000},
            "images of a look that are linearised anew at each update, at most; of more only every "
            "second, fourth … is used, but for those of a fixed camera, which are used for good");
  v.number("converged", p.converged, {1e-12, 1.0},
           About("the linearisation ends with a step of less").in("m, rad"));
  describe_loss(v, p);
  v.integer("nis_looks", p.nis_looks, {1, 1000},
            "lost when the NIS of so many looks' first frames …");
  v.number("nis_probability", p.nis_probability, {1e-12, 0.5},
           "… adds up to what chance exceeds with this probability");
}

void describe(ParamVisitor& v, BearingOnlyParams& p) {
  describe_noise(v, p);
  v.angle("bearing_floor_deg", p.bearing_floor, {0.0, 10.0},
          "σ of what a bearing leaves out, white per image");
  describe_association(v, p);
  describe_loss(v, p);
  v.integer("search_looks", p.search_looks, {3, 100},
            "looks whose bearings a lost robot remembers");
  v.integer("min_looks", p.min_looks, {3, bound_of("search_looks", p.search_looks)},
            "of them that one pose must explain");
  v.number("found_weight", p.found_weight, {0.5, 1.0},
           "found when one pose has at least this share of the weight");
  v.number("clutter_cost", p.clutter_cost, {0.0, 100.0},
           "−ln of how likely a look is at no landmark");
  v.number("max_range_m", p.max_range_m, {0.1, 1000.0}, "to a landmark that a lost robot may see");
  v.integer("max_tries", p.max_tries, {1, 10000000},
            "triples of landmarks that a search tries, at most");
}

void describe(ParamVisitor& v, CeilingFilterParams& p) {
  v.map("odometry", p.odometry,
        About("the odometry's noise that this localizer assumes").otherwise(kFromNoise));
  v.angle("tilt_sigma_deg", p.tilt_sigma, {0.0, 20.0},
          "σ of the camera's tilt about either axis, constant, that its calibration leaves");
  v.number("height_sigma", p.height_sigma, {0.0, 0.5},
           About("σ of the camera's distance to the ceiling, constant").in("of it"));
  v.number("mount_sigma_m", p.mount_sigma_m, {0.0, 1.0},
           "σ of the camera's place on the robot, in x and in y, constant: no patch tells it");
  v.angle("mount_yaw_sigma_deg", p.mount_yaw_sigma, {0.0, 20.0},
          "σ of its turn about the vertical, as well");
  v.number("gate", p.gate, {1.0, 1000.0},
           About("of a patch's three numbers, and of flow against odometry").in("χ²"));
  v.number("flow_floor", p.flow_floor, {0.0, 0.1},
           About("σ of a frame's shift by the flow beside what its match claims")
               .in("distances to the ceiling"));
  v.number("sure", p.sure, {0.5, 0.999999},
           "a shift by whole cells is believed alone from this weight on; below, `ambiguous`");
  v.number("spurious", p.spurious, {1e-6, 0.5}, "chance of a patch where the grid has none");
  v.number("missing", p.missing, {1e-6, 0.5},
           "chance that a patch of the grid in plain sight is not found");
  v.integer("max_gated", p.max_gated, {1, 1000},
            "frames in a row that contradict the prediction, until it is doubted");
}

}  // namespace vigia::localization
