#pragma once

#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/evaluation/ceiling_views.hpp"
#include "vigia/localization/ceiling_filter.hpp"

namespace vigia::evaluation {

/// Errors of a localizer over frames: metres and radians.
struct CeilingErrorSummary {
  int frames = 0;
  double mean_m = 0.0;
  double p95_m = 0.0;
  double max_m = 0.0;
  double rms_m = 0.0;
  double heading_mean = 0.0;
  double heading_p95 = 0.0;
  double heading_max = 0.0;
  double nees = 0.0;           ///< per degree of freedom, where the localizer has a covariance
  double bound_m = 0.0;        ///< √ of the mean trace of the bound, where there is one
  double bound_mean_m = 0.0;   ///< mean length of an error of that covariance
  double bound_heading = 0.0;  ///< mean size, rad
};

/// A pose that somebody states of a frame.
struct CeilingEstimate {
  Pose2 truth;
  Pose2 estimate;
  std::optional<Eigen::Matrix3d> covariance;  ///< claimed
  std::optional<Eigen::Matrix3d> bound;
  BeliefStatus status = BeliefStatus::tracking;
};
CeilingErrorSummary summarise_errors(const std::vector<CeilingEstimate>& estimates);

/// What a recorded drive is followed by.
enum class CeilingMotion { unknown, published_flow, key_frame_flow };

/// What goes wrong with the patches of some frames in a row.
enum class CeilingFault {
  unseen,   ///< none is found
  misread,  ///< each frame's are all displaced, by up to 20 cm on the ceiling
};
struct CeilingBurst {
  int first = 0;
  int frames = 0;
};
/// The drive with the bursts in it; depends on the seed alone.
std::vector<CeilingFrame> with_bursts(const CeilingSetting& setting,
                                      std::vector<CeilingFrame> frames, CeilingFault fault,
                                      const std::vector<CeilingBurst>& bursts, std::uint64_t seed);

/// Chonbuk's nearest patch, with its fusion where @p threshold_m is given; the first pose is given.
/// @p camera is the one that it believes to have.
std::vector<CeilingEstimate> follow_published(const CeilingSetting& setting,
                                              const localization::CeilingCamera& camera,
                                              const std::vector<CeilingFrame>& frames,
                                              std::optional<double> threshold_m = std::nullopt);

/// All patches of each frame by itself, from a prior about the truth that says no more than which
/// cell it is; beside the Cramér–Rao bound of the frame, placement errors in it.
std::vector<CeilingEstimate> fix_jointly(const CeilingSetting& setting,
                                         const localization::CeilingFilterParams& params,
                                         const std::vector<CeilingFrame>& frames);

/// The filter along the drive, beside the posterior bound: the same recursion at the truth.
std::vector<CeilingEstimate> follow_jointly(const CeilingSetting& setting,
                                            const localization::CeilingFilterParams& params,
                                            const std::vector<CeilingFrame>& frames,
                                            CeilingMotion motion, double period_s);

/// The camera's errors as they are known at the end of a drive, from its patches alone.
struct CeilingCalibration {
  localization::CeilingCameraErrors errors;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};
CeilingCalibration calibrate_ceiling(const CeilingSetting& setting,
                                     const std::vector<CeilingFrame>& frames, double period_s);

/// Poses by optical flow alone, from the first frame's true pose on, with the ceiling's distance
/// and the tilt known.
std::vector<CeilingEstimate> follow_flow(const CeilingSetting& setting,
                                         const std::vector<CeilingFrame>& frames,
                                         CeilingMotion motion);

}  // namespace vigia::evaluation
