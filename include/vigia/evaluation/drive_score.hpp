#pragma once

#include <map>
#include <memory>
#include <string>

#include "vigia/evaluation/estimator_score.hpp"
#include "vigia/mission/listener.hpp"

namespace vigia::evaluation {

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

/// Scores a drive while it runs: its localizers by an EstimatorScorer each, and what the
/// pan-tilt-zoom attention and the recovery did.
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
  /// EstimatorScorer::bound_position_m2() of a localizer, in the order of MissionSetup::localizers.
  double bound_position_m2(std::size_t localizer) const;

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
