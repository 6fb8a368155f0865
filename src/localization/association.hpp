#pragma once

#include <optional>
#include <vector>

#include "vigia/core/floor_plan.hpp"
#include "vigia/localization/ekf_state.hpp"

namespace vigia::localization {

/// A landmark that may explain an observation.
struct Candidate {
  const Landmark* landmark = nullptr;
  double nis = 0.0;
  double cost = 0.0;  ///< −2 ln likelihood up to a constant: NIS + ln det S
};

/// What the association weighs.
struct Association {
  std::vector<Candidate> inside_gate;  ///< best first
  double best_nis = 0.0;               ///< of the nearest landmark, inside the gate or not
  bool any_image = false;              ///< whether any landmark has an image from there at all
};

/// The map, and what else is fixed for the whole mission.
struct AssociationModel {
  const LandmarkMap& map;
  const FloorPlan* plan;  ///< null: nothing occludes
  const RigOnGround& on_ground;
  const SensorNoise& noise;
  double gate;  ///< bound on the NIS
};

/// All landmarks whose predicted image lies within the gate of the measured (u, v, s) and that no
/// wall hides. @p state carries the biases of the observation's look.
Association associate(const AssociationModel& model, const EkfState& state,
                      const EllipseObservation& observation, const Eigen::Vector3d& z,
                      const Eigen::Matrix3d& R);

}  // namespace vigia::localization
