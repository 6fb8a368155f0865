#pragma once

#include "vigia/core/odometry.hpp"
#include "vigia/core/sensor_noise.hpp"

namespace vigia {

/// What the calibration of a stereo pair may miss (σ, constant along a drive); 0: it is exact.
struct StereoCalibrationNoise {
  double baseline = 0.0;  ///< relative
  double vergence = 0.0;  ///< of the axes towards each other, rad
  double focal = 0.0;     ///< of both cameras, relative
};

/// What a robot believes of its sensors' errors: the one model from which filter, search, planner,
/// tracker's prediction and gaze take theirs. A consumer's own parameters may override it.
struct NoiseModel {
  OdometryNoise odometry;  ///< of the increments
  SensorNoise sensor;      ///< of the head's and the zoom's readings
  /// σ of what the landmarks' models leave out, white per image, added to the tracker's covariance:
  /// a disc's centre or a point in px, and a disc's relative size.
  double centre_floor_px = 0.002;
  double size_floor = 5e-5;
  StereoCalibrationNoise stereo;  ///< of a pair of cameras
};

}  // namespace vigia
