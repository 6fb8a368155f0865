#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/evaluation/field_frames.hpp"
#include "vigia/evaluation/metrics.hpp"

namespace vigia::evaluation {

/// What localizes itself along a drive over a field.
enum class FieldLocalizer {
  odometry,
  field_grid,     ///< refined matches followed in time (localization::FieldTracker)
  mcl,            ///< Monte Carlo localization at its best
  mcl_described,  ///< as Minho's paper describes it
  murea,
};

struct FieldDriveParams {
  FieldFrameParams frames;
  /// Of the wheels, and as the localizers believe it.
  OdometryNoise odometry{0.02, 0.01, 0.02};
  double speed_m_s = 1.5;
  double turn_rad_s = 2.0;  ///< at most
  double period_s = 0.04;
  int count = 1000;              ///< frames
  bool prior = true;             ///< 10 cm and 3° (σ) at the start; else nothing
  std::optional<int> kidnap_at;  ///< the frame before which the robot is put elsewhere, > 0.5 m off
  double teleports_per_m = 0.0;  ///< rate at which it is put elsewhere, > 0.5 m off
  /// Straight false lines stay where they are during the drive; else each frame has others.
  bool lasting_false_lines = true;
};

/// One frame of one localizer.
struct FieldDriveSample {
  Pose2 truth;
  Belief belief;
  Eigen::Matrix3d bound = Eigen::Matrix3d::Zero();  ///< posterior Cramér–Rao bound, goals in it
                                                    ///< for those that measure by them
  bool teleported = false;                          ///< put elsewhere just before this frame
  double error_m() const { return (belief.pose.position() - truth.position()).norm(); }
  /// Wrong by more than half a metre.
  bool wrong() const { return error_m() > 0.5; }
  /// Whether the belief says that it may be wrong.
  bool flagged() const { return belief.status != BeliefStatus::tracking; }
};

using FieldDrive = std::map<FieldLocalizer, std::vector<FieldDriveSample>>;

/// A drive from way point to way point, turning while driving, through the same frames for every
/// localizer; depends on the seed alone.
FieldDrive drive_field(const FieldMap& map, const FieldDriveParams& params,
                       const std::vector<FieldLocalizer>& localizers, std::uint64_t seed);

/// Drives @p count seeds from @p first on.
std::vector<FieldDrive> drive_field_seeds(const FieldMap& map, const FieldDriveParams& params,
                                          const std::vector<FieldLocalizer>& localizers,
                                          std::uint64_t first, int count, int threads);

/// Over all frames of all drives.
struct FieldDriveErrors {
  int frames = 0;
  double mean_m = 0.0;
  double p95_m = 0.0;
  double max_m = 0.0;
  double heading_mean = 0.0;
  int wrong_unflagged = 0;
  int right_flagged = 0;
  int right = 0;
  double nees = 0.0;     ///< per degree of freedom, over right frames
  Estimate pcrlb_ratio;  ///< over right frames
};
FieldDriveErrors drive_errors(const std::vector<FieldDrive>& drives, FieldLocalizer localizer);

/// What became of kidnapped robots, @p within frames later.
struct KidnapCount {
  int trials = 0;
  int recovered = 0;            ///< right to half a metre and unflagged
  int both = 0;                 ///< flagged, the truth among the hypotheses
  int confident_wrong = 0;      ///< wrong and unflagged
  double mean_unflagged = 0.0;  ///< frames from the kidnapping to the first flag or the recovery
};
KidnapCount count_kidnapped(const std::vector<FieldDrive>& drives, FieldLocalizer localizer,
                            int kidnapped_at, int within);

/// Fox's protocol (Fox, Burgard, Dellaert, Thrun 1999): robots put elsewhere while they drive have
/// recovered when the error stays below near_m for hold_s.
struct TeleportRule {
  double near_m = 0.45;
  double hold_s = 10.0;
  double judged_s = 15.0;  ///< a teleport is judged if so long a drive follows it undisturbed
};
struct TeleportCount {
  int teleports = 0;
  int judged = 0;
  int recovered = 0;
  double mean_s = 0.0;      ///< from a teleport to the beginning of the time near, if recovered
  double greatest_s = 0.0;  ///< of these
  int far = 0;              ///< frames farther off than near_m …
  int far_unflagged = 0;    ///< … and of them those that the belief does not flag
  int frames = 0;
};
TeleportCount count_teleports(const std::vector<FieldDrive>& drives, FieldLocalizer localizer,
                              double period_s, const TeleportRule& rule = {});

}  // namespace vigia::evaluation
