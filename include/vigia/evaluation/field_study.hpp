#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "vigia/evaluation/field_frames.hpp"

namespace vigia::evaluation {

/// What turns one frame into a pose.
enum class FrameMethod {
  printed,       ///< Minho, eq. 2 as it stands
  as_published,  ///< Minho, eq. 2 as kindly as it can be read
  corrected,     ///< Minho with the errata mended
  tracked,       ///< refined from a start within 5 cm and 1.1° (σ) of the truth, without prior
  cold,          ///< global match and refinement, nothing known
  murea,         ///< global, 5 cm cells
  murea_fine,    ///< global, 2.5 cm cells
};

struct FrameOutcome {
  bool answered = false;
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< (x, y, θ) minus the truth
  double nees = 0.0;                                ///< where the method has a covariance
  double weight = 1.0;                              ///< that it gives its answer, of all
  double position_m() const { return error.head<2>().norm(); }
};

struct FrameStudy {
  std::vector<Pose2> truths;
  std::vector<Eigen::Matrix3d> bounds;
  std::map<FrameMethod, std::vector<FrameOutcome>> outcomes;
};

/// @p count frames at poses anywhere on the field, each method on the same ones. What a frame shows
/// depends on @p seed and its number alone.
FrameStudy study_frames(const FieldMap& map, const FieldFrameParams& params,
                        const std::vector<FrameMethod>& methods, std::uint64_t seed, int count,
                        int threads);

/// Metres, radians, over the frames that were answered.
struct FrameErrors {
  int frames = 0;
  int answered = 0;
  double mean_m = 0.0;
  double rms_m = 0.0;
  double p95_m = 0.0;
  double max_m = 0.0;
  double heading_mean = 0.0;
  double nees = 0.0;  ///< mean per degree of freedom, of the frames right to half a metre
  int wrong = 0;      ///< by more than half a metre
  /// √(Σ e² / Σ tr P) over the frames right to half a metre, P their bounds.
  double bound_ratio = 0.0;
};

FrameErrors frame_errors(const FrameStudy& study, FrameMethod method);
/// Of an efficient estimator: mean and rms of the position by the bounds, mean of the heading.
struct FrameBound {
  double mean_m = 0.0;
  double rms_m = 0.0;
  double heading_mean = 0.0;
};
FrameBound frame_bound(const FrameStudy& study);

/// At a threshold of the answer's weight: how many wrong answers pass it and how many right ones do
/// not.
struct FlagCount {
  double threshold = 0.0;
  int wrong_unflagged = 0;
  int right_flagged = 0;
};
std::vector<FlagCount> flag_curve(const FrameStudy& study, FrameMethod method,
                                  const std::vector<double>& thresholds);

}  // namespace vigia::evaluation
