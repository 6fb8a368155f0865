#pragma once

#include <optional>
#include <vector>

#include "vigia/localization/look_input.hpp"

namespace vigia::localization {

/// What the inputs of a look are linearised with.
struct LookModel {
  const MeasurementModel& measurement;
  const OdometryNoise& odometry;
};

/// The most likely trajectory of a look and the filter linearised about it.
struct SmoothedLook {
  std::vector<LookState> filtered;  ///< after each input; the last is the estimate
  std::vector<Vector6> trajectory;  ///< the smoothed mean before each input
};

/// The states after each of @p inputs (nullptr: left out), from @p start on, with every input
/// linearised about the most likely trajectory given all of them: an iterated extended Kalman
/// smoother, which is Gauss–Newton on the whole trajectory (Bell 1994). Each iteration is a forward
/// pass linearised about the present trajectory and a backward pass of adjoints (Bryson and
/// Frazier's, which inverts no covariance).
///
/// An image fixes three directions of the state to micrometres and leaves the others free by
/// centimetres. Which ones depends on the point of linearisation: images linearised one by one at
/// different estimates rule out different directions and so feign information on all. Linearised
/// about one trajectory they do not.
///
/// @p guess is the first trajectory: the mean before each input. At most @p iterations passes,
/// until one moves the trajectory by less than @p converged (m, rad).
/// Nothing comes back when a landmark has no image from the trajectory.
std::optional<SmoothedLook> smooth_look(const LookState& start,
                                        const std::vector<const LookInput*>& inputs,
                                        std::vector<Vector6> guess, const LookModel& model,
                                        int iterations, double converged);

}  // namespace vigia::localization
