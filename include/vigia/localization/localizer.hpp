#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "vigia/core/belief.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"

namespace vigia::localization {

/// What a localizer made of an observation.
enum class UpdateStatus {
  fused,
  gated,        ///< no landmark of the map explains it
  ambiguous,    ///< several landmarks explain it
  degenerate,   ///< the model has no image there (behind the camera, edge on)
  too_late,     ///< older than the odometry history
  unsupported,  ///< a kind that this localizer does not use
  no_prior,     ///< it has no idea where it is and cannot find out by itself
};
inline constexpr std::size_t kUpdateStatuses = 7;

std::string_view to_string(UpdateStatus status);

struct UpdateResult {
  UpdateStatus status = UpdateStatus::unsupported;
  std::optional<LandmarkId> landmark;  ///< to which the observation was associated
  double nis = 0.0;                    ///< normalised innovation squared, when computed
  int dof = 0;
};

/// Estimates where the robot is. Increments come in order of time; an observation may be stamped
/// earlier than the last increment.
class Localizer {
 public:
  virtual ~Localizer() = default;
  virtual std::string_view name() const = 0;
  /// Begins anew at @p stamp, from the prior or without one. Without, a localizer that can find
  /// itself is `lost` until it has; another stays so, and its updates end with `no_prior`.
  virtual void reset(Stamp stamp, const std::optional<Prior>& prior) = 0;
  virtual void predict(const OdometryIncrement& increment) = 0;
  virtual UpdateResult update(const Observation& observation) = 0;
  virtual const Belief& belief() const = 0;
  /// Perception says that what the belief predicts is not there: lost until the next reset(), or
  /// until a localizer that can find itself has.
  virtual void lose() = 0;
};

}  // namespace vigia::localization
