#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/angle.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"
#include "vigia/evaluation/metrics.hpp"
#include "vigia/localization/published_running_fix.hpp"
#include "vigia/localization/running_fix.hpp"
#include "vigia/localization/station_fix.hpp"

namespace vigia::evaluation {

/// The setting of Bais §4: the FIRA MiroSot small league's field, x from the blue goal's line to
/// the yellow one's, y from the field's middle, the four corners of the goals' mouths as landmarks.
/// What the paper does not print is fixed here: the field of view, the keep-off from the walls, the
/// steps in which the robot turns.
struct CornerSetting {
  double length_m = 1.5;
  double width_m = 1.3;
  double goal_m = 0.4;
  double margin_m = 0.0375;  ///< half the robot, kept from the walls
  int columns = 320;         ///< of each image
  double field_of_view = from_deg(60.0);
  double baseline_m = 0.03;
  double turn_step = from_deg(10.0);

  /// The column of a corner's image: its pixel's, or with white noise.
  enum class Columns { whole_pixels, noisy };
  Columns image = Columns::whole_pixels;
  double noise_px = 0.1;  ///< of noisy columns

  localization::StereoErrors calibration;        ///< that every run has
  localization::StereoErrors calibration_sigma;  ///< of what each run has beside it, constant in it
  std::optional<double> displacement_m;          ///< to the second point; else it lies anywhere
  /// Of the heading by which displacements are put into world axes, constant in a run, rad.
  double heading_sigma = 0.0;
  double displacement_sigma_m = 0.0;  ///< of each displacement, per axis
  double turn_sigma = 0.0;            ///< of each turn between two points, rad
  double landmark_sigma_m = 0.0;      ///< of each corner's place in the map, per axis
};

/// The calibrated pair.
localization::StereoPair stereo_pair(const CornerSetting& setting);
/// Of each column: the noise, or 1/√12 px.
double column_sigma_px(const CornerSetting& setting);
/// Corners of the goals' mouths: blue left and right, yellow left and right as seen along x.
std::vector<Eigen::Vector2d> goal_corners(const CornerSetting& setting);

/// One run: the robot stands at points drawn uniformly in the field with a random heading, at each
/// it turns on the spot in steps until both images show a corner (of several that nearest the
/// image's middle), from the second of two points on the corner of the first where @p same_corner.
/// Images are a pair of pinhole cameras', by their true places on the robot.
struct CornerRun {
  std::vector<Pose2> truths;
  localization::StationChain measured;  ///< sigmas of everything but calibration filled in
  localization::StationChain exact;     ///< true displacements and places, the same sigmas
  localization::StereoErrors errors;    ///< of calibration, as drawn
};
CornerRun draw_corner_run(const CornerSetting& setting, int points, bool same_corner,
                          RandomStream& random);

/// A measured pose less the truth: x, y, θ.
using PoseError = Eigen::Vector3d;

/// What became of the two points of a run.
struct CornerTrial {
  std::vector<double> range_errors_m;  ///< signed, at both points, of the stereo ranges alone
  std::vector<double> ranges_m;        ///< true
  localization::PublishedFixStatus published_status =
      localization::PublishedFixStatus::circles_do_not_meet;
  /// By eqs. 4–8; of the two candidates that nearer the truth.
  std::optional<PoseError> published;
  /// running_fix() with a prior that is off by 20 cm and 20° (σ).
  localization::RunningFixStatus resolved_status =
      localization::RunningFixStatus::circles_do_not_meet;
  bool resolved_wrongly = false;  ///< found, though not at the candidate nearer the truth
  localization::StationFixStatus likeliest_status = localization::StationFixStatus::degenerate;
  std::optional<PoseError> likeliest;  ///< by station_fix(), calibration taken for exact
  Eigen::Matrix3d likeliest_covariance = Eigen::Matrix3d::Zero();
  double likeliest_range_error_m = 0.0;  ///< at the second point
  double sin_gamma = 0.0;                ///< true
  std::optional<Eigen::Matrix3d> bound;  ///< calibration exact
  double range_bound_m = 0.0;            ///< σ of the range at the second point by that bound
};

/// A run's draws depend on its number and @p seed alone: under another noise or resolution the same
/// places are tried.
std::vector<CornerTrial> study_corner_trials(const CornerSetting& setting, std::uint64_t seed,
                                             int count, int threads);

/// What became of a drive past many points: the pose at the last.
struct CornerDrive {
  std::optional<PoseError> uncorrected;  ///< calibration taken for exact
  localization::StationFixStatus status = localization::StationFixStatus::degenerate;
  std::optional<PoseError> corrected;    ///< its errors carried as states
  double nees = 0.0;                     ///< of the corrected, three degrees of freedom
  std::optional<Eigen::Matrix3d> bound;  ///< that carries them
};
std::vector<CornerDrive> study_corner_drives(const CornerSetting& setting, int points,
                                             std::uint64_t seed, int count, int threads);

/// Of absolute values, as Bais's tables have them.
struct ErrorSpread {
  int n = 0;
  double mean = 0.0;
  double deviation = 0.0;
  double least = 0.0;
  double greatest = 0.0;
};
ErrorSpread spread_of(const std::vector<double>& errors);

/// Positions of those that were fixed against their bounds.
struct BoundRatio {
  int n = 0;
  double mean_m = 0.0;  ///< of the position error
  double greatest_m = 0.0;
  double bound_mean_m = 0.0;  ///< mean error of an efficient estimator
  Estimate ratio;             ///< √(Σ e² / Σ tr P)
  double nees = 0.0;          ///< per degree of freedom, by the claimed covariance
};
/// Over trials whose status is `found` (or, @p all, every one with a pose).
BoundRatio likeliest_ratio(const std::vector<CornerTrial>& trials, bool all);
/// Of the corrected poses whose status is `found`.
BoundRatio drive_ratio(const std::vector<CornerDrive>& drives);

}  // namespace vigia::evaluation
