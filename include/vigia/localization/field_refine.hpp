#pragma once

#include <optional>

#include "vigia/core/belief.hpp"
#include "vigia/localization/field_model.hpp"

namespace vigia::localization {

struct FieldRefineParams {
  int iterations = 20;      ///< at most
  double converged = 1e-4;  ///< the last step is shorter, m and rad
  double spread_m = 0.0;    ///< σ added to the points at the beginning, halved at each step
  double max_step_m = 0.3;
  double max_step_rad = 0.15;
  /// Share of clutter; without it, it is estimated by EM, the model's share as prior worth
  /// prior_points.
  std::optional<double> clutter;
  double prior_points = 5.0;
};

enum class FieldFixStatus { converged, not_converged, degenerate };

/// A pose that a scan's points agree with best.
struct FieldFix {
  FieldFixStatus status = FieldFixStatus::degenerate;
  Pose2 pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, θ), the prior's share in it
  double log_likelihood = 0.0;                           ///< of the points
  double log_prior = 0.0;  ///< log density of the prior there, 0 without one
  double clutter = 0.0;    ///< share that was assumed or estimated
  double on_lines = 0.0;   ///< expected number of points on lines
  int iterations = 0;
};

/// Maximises the mixture's likelihood over x, y, θ together from @p start by Newton's method (the
/// complete information where the observed one is not positive), halving steps that go down. A
/// @p prior takes part as a Gaussian.
FieldFix refine_field_pose(const FieldModel& model, const std::vector<FieldPoint>& points,
                           const Pose2& start, const std::optional<Prior>& prior = std::nullopt,
                           const FieldRefineParams& params = {});

/// Log-evidence of a fix against others far from it, at a common share of clutter: points
/// (FieldModel::line_evidence(), @p groups the scan's), sightings, the prior's density and the
/// volume about the pose.
double log_evidence_of(const FieldModel& model, const FieldScan& scan,
                       const std::vector<StraightGroup>& groups, const FieldFix& fix,
                       double clutter);

}  // namespace vigia::localization
