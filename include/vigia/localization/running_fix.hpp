#pragma once

#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/localization/station_motion.hpp"
#include "vigia/localization/stereo_pair.hpp"

namespace vigia::localization {

/// One landmark's range from two points and the way between them (Bais §2). The bearing at the
/// second point gives the heading once the position is known.
struct RunningFixInput {
  LandmarkPlace landmark;
  PolarSighting first;
  PolarSighting second;
  StationMotion motion;
  /// Of the robot at the second point. A displacement in the robot's own axes takes it.
  std::optional<HeadingPrior> heading;
};

struct RunningFixParams {
  /// Of the angle γ between the lines of sight, at the landmark. Where the circles touch the
  /// position is not determined along them.
  double min_sin_gamma = 0.3;
  double resolved = 0.99;  ///< weight from which on a candidate is the answer
};

enum class RunningFixStatus {
  found,                ///< one candidate is left
  ambiguous,            ///< both are; the second is the mirror image at the displacement
  circles_do_not_meet,  ///< no place has both ranges
  degenerate,           ///< |sin γ| is below the gate, or the robot did not move
  no_heading,           ///< the displacement is in the robot's axes and nothing tells the heading
};

struct RunningFix {
  RunningFixStatus status = RunningFixStatus::circles_do_not_meet;
  /// Robot poses at the second point, the likelier first. Where the status is `degenerate` they are
  /// the circles' crossings as far as there are any.
  std::vector<PoseHypothesis> candidates;
  double sin_gamma = 0.0;
};

/// Crosses the circle about the virtual landmark l + d with that about the landmark l in the form
/// that divides by the displacement's length alone: D = |d|, a = (r₂² − r₁² + D²)/2D, h² = r₂² −
/// a², p = l + a d/D ± h d⊥/D (in place of Bais eqs. 4–6); heading by atan2 (in place of eqs. 7,
/// 8). A
/// @p rough prior weighs the two.
RunningFix running_fix(const RunningFixInput& input,
                       const std::optional<Prior>& rough = std::nullopt,
                       const RunningFixParams& params = {});

/// Heading of a robot at @p p_w that sees the landmark at @p bearing.
double heading_by_landmark(const Eigen::Vector2d& landmark_w, const Eigen::Vector2d& p_w,
                           double bearing);

}  // namespace vigia::localization
