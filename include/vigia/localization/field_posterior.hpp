#pragma once

#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/localization/field_model.hpp"
#include "vigia/localization/field_refine.hpp"

namespace vigia::localization {

struct FieldPosteriorParams {
  /// Spacing of the nodes in σ of the fix were each point's line known: no posterior is narrower.
  double step_sigmas = 1.7;
  double depth = 7.5;    ///< nodes so far below the highest log density have no neighbours
  int max_nodes = 1500;  ///< 100 to 300 are usual
};

/// Moments of (x, y, θ) given a scan's points, about a place.
struct FieldPosterior {
  Pose2 mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double log_evidence = 0.0;  ///< log of likelihood times prior, integrated; without a prior its
                              ///< density is 1
  int nodes = 0;
};

/// Integrates FieldModel::line_evidence(), times the @p prior, over the hill that @p fix lies on:
/// sums over a lattice that grows from the fix to wherever the density is not negligible. Among
/// clutter the hill is neither symmetric nor Gaussian – which points lie on which line is open –
/// so that the curvature at its top understates its width.
FieldPosterior posterior_about(const FieldModel& model, const std::vector<FieldPoint>& points,
                               const std::vector<StraightGroup>& groups, const FieldFix& fix,
                               const std::optional<Prior>& prior = std::nullopt,
                               const FieldPosteriorParams& params = {});

}  // namespace vigia::localization
