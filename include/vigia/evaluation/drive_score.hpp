#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vigia/mission/listener.hpp"

namespace vigia::evaluation {

/// A localizer's estimate at the last fused reading of one look.
struct LookScore {
  LookId look = 0;
  double nees = 0.0;              ///< of (x, y, θ), 3 degrees of freedom
  double squared_error_m2 = 0.0;  ///< of the position
  double bound_m2 = 0.0;          ///< trace of the bound's position covariance
};

/// One localizer on one drive. Means are over the ticks of the drive.
struct LocalizerScore {
  double position_final_m = 0.0;
  double position_rmse_m = 0.0;
  double position_max_m = 0.0;
  double heading_final_rad = 0.0;
  double heading_rmse_rad = 0.0;
  double nees_mean = 0.0;
  double pcrlb_position_rms_m = 0.0;  ///< √ of the mean trace of the posterior Cramér–Rao bound
  int updates = 0;
  int rejected = 0;  ///< gated, ambiguous, degenerate or too late
  int unsupported = 0;
  double lost_s = 0.0;
  std::vector<LookScore> looks;
};

struct PerceptionScore {
  int looks = 0;
  int stops = 0;
  double stopped_s = 0.0;
  int over_limit_1 = 0;  ///< how often the primary's √λ_max rose above the first limit
  int over_limit_2 = 0;
  int zoom_changes = 0;
  double pan_travel_rad = 0.0;
  double centring_rms_px = 0.0;  ///< while tracking, once settled
  double centring_max_px = 0.0;
  int target_losses = 0;
};

struct DriveScore {
  std::string mission;
  std::uint64_t seed = 0;
  mission::Outcome outcome = mission::Outcome::timeout;
  double sim_s = 0.0;
  std::string primary;
  std::map<std::string, LocalizerScore> localizers;
  PerceptionScore perception;
};

/// Scores a drive while it runs: errors against the truth, consistency, and the posterior
/// Cramér–Rao bound along the executed looks, linearised at the true state.
class DriveScorer : public mission::Listener {
 public:
  /// Centring counts from this long after a target was acquired.
  static constexpr double kSettle_s = 0.6;

  DriveScorer();
  ~DriveScorer() override;

  void on_start(const mission::MissionSetup& setup, std::uint64_t seed) override;
  void on_tick(const mission::Tick& tick) override;
  void on_event(const mission::Event& event) override;
  void on_finish(mission::Outcome outcome, Stamp end) override;

  /// Complete after on_finish().
  const DriveScore& score() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// summary.json as contracted.
std::string summary_json(const DriveScore& score);

}  // namespace vigia::evaluation
