#pragma once

#include <optional>

#include "vigia/core/angle.hpp"
#include "vigia/core/config.hpp"

namespace vigia::sim {

// What the real world does and a simulation forgets. The defaults are what `realistic` means.

/// The frame is the mean over the camera's motion while the shutter is open.
struct MotionBlurParams {
  double exposure_s = 0.01;
  int max_instants = 16;  ///< of which the mean is taken, at most
};

/// A frame is delivered late, and what is seen in it is known later still.
struct LatencyParams {
  double latency_s = 0.08;  ///< from the middle of the exposure
  double processing_s =
      0.0;  ///< that a frame takes; one that arrives meanwhile waits, or is dropped
};

/// The light's gain varies over the room and in time.
struct LightParams {
  double room = 0.25;          ///< ± over the room
  double drift = 0.10;         ///< ± in time, of the whole light
  double drift_period_s = 60;  ///< of its slowest wave
  double lamp_step = 0.5;      ///< share of its light that a lamp may lose at a step
  double step_every_s = 30;    ///< mean time between two steps of some lamp; 0: none
};

/// The head sits a little askew on the base, and the camera beside its place on the head; a fixed
/// camera sits askew on the base.
struct MountingParams {
  double angle = from_deg(0.25);  ///< σ of yaw, pitch and roll, rad
  double offset_m = 0.003;        ///< σ of each coordinate
  double camera_offset_m = 0.0;   ///< σ of each coordinate of the optical centre in the head
};

/// The table of focal lengths is a little wrong.
struct ZoomCalibrationParams {
  double sigma = 0.005;  ///< relative, rms over the zoom's range and over seeds
};

/// The optical axis wanders as the lens zooms.
struct PrincipalPointParams {
  double drift_px = 2.5;  ///< from one end of the zoom to the other; right in the middle
};

/// An omnidirectional camera is not quite what it was calibrated as.
struct MirrorParams {
  double scale = 0.002;          ///< σ of the relative error of its focal length
  double tilt = from_deg(0.05);  ///< σ of the tilt about either axis of the image, rad
  double centre_px = 0.2;        ///< σ of either coordinate of its middle
};

/// A stereo pair is not quite what it was calibrated as.
struct StereoParams {
  double baseline = 0.01;           ///< σ of the relative error of its baseline
  double vergence = from_deg(0.1);  ///< σ of how far its cameras are turned towards each other, rad
  double focal = 0.005;             ///< σ of the relative error of both focal lengths
};

/// Pan and tilt encoders follow the axes with play.
struct BacklashParams {
  double width = from_deg(0.1);  ///< rad
};

/// The wheels do not report what the base does.
struct WheelSlipParams {
  double per_m = 0.15;  ///< slips that begin per metre driven
  double min_m = 0.1;   ///< length of a slip
  double max_m = 0.4;
  double min_loss = 0.02;  ///< share of the distance that is lost during a slip
  double max_loss = 0.10;
  double skew_per_m = from_deg(3.0);  ///< σ of the turn during a slip, rad per metre
  double diameter = 0.005;            ///< σ of the relative error of the wheels' diameter
  double base = 0.005;                ///< σ of the relative error of the wheel base
};

/// Landmarks hang a little off the place that the map has.
struct MapErrorParams {
  double sigma_m = 0.005;       ///< of both coordinates in the landmark's plane
  double turn = from_deg(1.0);  ///< σ of its turn about the vertical, rad
};

/// Landmarks of the map that the room lacks.
struct MissingLandmarksParams {
  double probability = 0.1;  ///< of each
  int at_most_one_in = 6;    ///< landmarks; a map of fewer lacks none
};

/// People, or other robots, who move about.
struct PeopleParams {
  enum class Kind { people, robots };
  Kind kind = Kind::people;
  int count = 3;
  double radius_m = 0.25;
  double height_m = 1.75;
  double speed_mps = 0.8;          ///< at most; each has a pace of his own above half of it
  double pause_probability = 0.4;  ///< at the end of each leg
  double longest_pause_s = 4.0;
  double distance_m = 0.4;  ///< kept from the robot's hull by turning, stopping or stepping aside
};

/// Things on the walls that resemble landmarks.
struct ClutterParams {
  int marks = 12;  ///< dark and round
  int plates = 6;  ///< light, with a dark mark on them
};

/// At some time of the drive the robot is put elsewhere; odometry does not notice.
struct KidnappingParams {
  double earliest_s = 15.0;
  double latest_s = 60.0;
  double min_m = 1.5;  ///< from where it was
};

/// The ramps are not as the map has them.
struct RampErrorParams {
  double steeper = from_deg(1.0);  ///< rad; what they lead to is higher with them
};

/// Which disturbances are on. Everything is off by default.
struct DisturbanceParams {
  std::optional<MotionBlurParams> motion_blur;
  std::optional<LatencyParams> latency;
  std::optional<LightParams> light;
  std::optional<MountingParams> mounting;
  std::optional<ZoomCalibrationParams> zoom_calibration;
  std::optional<PrincipalPointParams> principal_point;
  std::optional<MirrorParams> mirror;
  std::optional<StereoParams> stereo;
  std::optional<BacklashParams> backlash;
  std::optional<WheelSlipParams> wheel_slip;
  std::optional<MapErrorParams> map_error;
  std::optional<MissingLandmarksParams> missing_landmarks;
  std::optional<PeopleParams> people;
  std::optional<ClutterParams> clutter;
  std::optional<KidnappingParams> kidnapping;
  std::optional<RampErrorParams> ramp_error;
};

/// Reads the map `disturbances` of a mission file. Each key is `off`, `realistic` or a map of its
/// parameters, of which those that are left out are realistic; `all` is what absent keys are, but
/// for kidnapping. Throws InputError.
DisturbanceParams read_disturbances(MapReader reader);

}  // namespace vigia::sim
