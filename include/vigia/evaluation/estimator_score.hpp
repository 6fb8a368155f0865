#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vigia/core/landmark.hpp"
#include "vigia/evaluation/drive_bound.hpp"
#include "vigia/evaluation/loss_score.hpp"
#include "vigia/mission/estimator_tick.hpp"

namespace vigia::evaluation {

/// A localizer's estimate at the last fused reading of one look.
struct LookScore {
  LookId look = 0;
  double nees = 0.0;              ///< of (x, y, θ), 3 degrees of freedom
  double squared_error_m2 = 0.0;  ///< of the position
  double bound_m2 = 0.0;          ///< trace of the bound's position covariance
};

/// Errors of height and attitude at the last fused reading of each look.
struct AttitudeScore {
  int looks = 0;
  double z_rms_m = 0.0;
  double z_max_m = 0.0;
  double pitch_rms_rad = 0.0;
  double pitch_max_rad = 0.0;
  double roll_rms_rad = 0.0;
  double roll_max_rad = 0.0;
  double nees_mean =
      0.0;  ///< of (z, pitch, roll), 3 degrees of freedom; 0: no covariance of its own
};

/// What a localizer says of the pose in space on ground that is not flat: from the landmark alone
/// where it measures that, else the place on the map's ground where it believes to stand.
struct SpaceScore {
  AttitudeScore level;  ///< where the robot truly stands level
  AttitudeScore ramps;
};

/// One localizer on one drive. Means are over the ticks of the drive. Without the truth only the
/// counts and lost_s are known.
struct LocalizerScore {
  double position_final_m = 0.0;
  double position_rmse_m = 0.0;
  double position_max_m = 0.0;
  double heading_final_rad = 0.0;
  double heading_rmse_rad = 0.0;
  double nees_mean = 0.0;
  double pcrlb_position_rms_m = 0.0;  ///< √ of the mean trace of the posterior Cramér–Rao bound
  /// Mean size of a Gaussian error whose covariance is the bound's at the end of the drive: what
  /// position_final_m and heading_final_rad would be on average at the bound.
  double pcrlb_position_final_m = 0.0;
  double pcrlb_heading_final_rad = 0.0;
  int updates = 0;
  int rejected = 0;  ///< gated, ambiguous, degenerate, too late, or without an idea where it is
  int unsupported = 0;
  double lost_s = 0.0;
  std::vector<LostEpisode> lost;
  LossScore loss;
  std::vector<LookScore> looks;
  std::optional<SpaceScore> in_space;  ///< on ground that is not flat
};

/// Scores one localizer of a drive, simulated or recorded, by what an estimator's ticks hold:
/// errors against the truth, consistency, losses, and the posterior Cramér–Rao bound along the
/// looks that it fused, linearised at the true state and with the true association.
class EstimatorScorer {
 public:
  explicit EstimatorScorer(EstimatorSetup setup);

  /// @p localizer: index into tick.localizers.
  void add(const mission::EstimatorTick& tick, std::size_t localizer);

  LocalizerScore score() const;
  /// Trace of the present bound's position covariance, m².
  double bound_position_m2() const;

 private:
  std::optional<LookId> count_updates(const mission::EstimatorTick& tick, std::size_t localizer);
  void add_errors_in_space(const mission::EstimatorTick& tick, const Belief& belief, LookId look);
  void add_errors(const mission::EstimatorTick& tick, const Belief& belief,
                  std::optional<LookId> fused);

  EstimatorSetup setup_;
  DriveBound bound_;
  LossScorer losses_;
  LocalizerScore score_;
  /// Over ticks with the truth.
  struct Sums {
    int ticks = 0;
    double squared_position = 0.0;
    double squared_heading = 0.0;
    double nees = 0.0;
    double bound_trace = 0.0;
  };
  Sums sums_;
  bool fixed_ = false;  ///< has known where it is
  /// Of one look: errors of (z, pitch, roll) and, where they have a covariance, their NEES.
  struct AttitudeError {
    LookId look = 0;
    bool ramp = false;
    Eigen::Vector3d error = Eigen::Vector3d::Zero();
    double nees = 0.0;
  };
  AttitudeScore attitude_score(bool ramp) const;

  std::vector<AttitudeError> attitudes_;
};

}  // namespace vigia::evaluation
