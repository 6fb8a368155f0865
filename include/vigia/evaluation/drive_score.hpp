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

/// A time during which a localizer was lost: from when it said so or its error passed kLost_m,
/// whichever came first, until it tracks again with an error of less than half of that.
struct LostEpisode {
  /// An error of the position that nobody would call localized, m.
  static constexpr double kLost_m = 0.5;

  std::optional<double> said_s;    ///< when its belief's status became lost
  std::optional<double> passed_s;  ///< when its error passed kLost_m
  std::optional<double> ended_s;
  double began_s() const;
  /// Whether it had said so by the time the error passed kLost_m, if it ever did.
  bool announced() const { return said_s && (!passed_s || *said_s <= *passed_s); }
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
  /// Mean size of a Gaussian error whose covariance is the bound's at the end of the drive: what
  /// position_final_m and heading_final_rad would be on average at the bound.
  double pcrlb_position_final_m = 0.0;
  double pcrlb_heading_final_rad = 0.0;
  int updates = 0;
  int rejected = 0;  ///< gated, ambiguous, degenerate or too late
  int unsupported = 0;
  double lost_s = 0.0;
  std::vector<LostEpisode> lost;
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

/// How often the mission was lost and found, by its events.
struct RecoveryScore {
  int lost = 0;
  int recovered = 0;
  double recovering_s = 0.0;  ///< from each `lost` to its `recovered`
};

struct DriveScore {
  std::string mission;
  std::uint64_t seed = 0;
  mission::Outcome outcome = mission::Outcome::timeout;
  double sim_s = 0.0;
  std::string primary;
  std::map<std::string, LocalizerScore> localizers;
  PerceptionScore perception;
  RecoveryScore recovery;
};

/// Scores a drive while it runs: errors against the truth, consistency, and the posterior
/// Cramér–Rao bound along the executed looks, linearised at the true state.
class DriveScorer : public mission::Listener {
 public:
  /// Centring counts from this long after a target was acquired.
  static constexpr double kSettle_s = 0.6;

  DriveScorer();
  ~DriveScorer() override;

  void on_start(const mission::MissionStart& start) override;
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

/// The whole score on one line of JSON, looks and episodes included, and back: equal to the bit.
/// score_from_record() throws std::exception for anything else.
std::string score_record(const DriveScore& score);
DriveScore score_from_record(const std::string& record);

}  // namespace vigia::evaluation
