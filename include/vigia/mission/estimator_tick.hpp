#pragma once

#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/localization/disc_model.hpp"
#include "vigia/localization/localizer.hpp"

namespace vigia::mission {

/// What one localizer made of a tick.
struct LocalizerTick {
  const Belief* belief = nullptr;  ///< at the tick's end
  /// What became of each of EstimatorTick::observations, in their order.
  std::vector<localization::UpdateResult> updates;
};

/// The true state when an image was exposed.
struct ExposureTruth {
  Stamp stamp;
  Pose2 pose;
  localization::LookBias bias;  ///< errors of the readings that came with the image
};

struct GroundTruth {
  Pose2 pose;                            ///< at the tick's end
  Pose2 pose_before;                     ///< at its beginning
  std::vector<ExposureTruth> exposures;  ///< of EstimatorTick::observations, in their order
  std::optional<Eigen::Isometry3d> wMr;  ///< at the tick's end, on ground that is not flat
};

/// What localizers were given in one tick and what they made of it, whoever gave it: a simulated
/// drive or a recorded one. A score and a replay need no more.
struct EstimatorTick {
  Stamp now;                              ///< the tick's end
  OdometryIncrement odometry;             ///< since the last tick
  std::vector<Observation> observations;  ///< before they are associated; some may be older
  std::vector<LocalizerTick> localizers;
  std::size_t primary = 0;           ///< of them, the one that the robot is driven by
  std::optional<GroundTruth> truth;  ///< where somebody knows it

  const Belief& primary_belief() const { return *localizers[primary].belief; }
};

}  // namespace vigia::mission
