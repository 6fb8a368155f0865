#pragma once

#include <array>
#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"

namespace vigia::evaluation {

/// How often a localizer that gave a probability of being lost within one tenth was lost.
struct CalibrationBin {
  int ticks = 0;
  double mean_probability = 0.0;
  int astray = 0;  ///< of the ticks
};

/// A time during which a localizer was lost: from when it said so or its error passed kLost_m,
/// whichever came first, until it tracks again with an error of less than half of that. An error
/// that the claim allows for is no loss: within four times the claimed √λ_max, of which no more
/// than half a metre is believed.
struct LostEpisode {
  /// An error of the position that nobody would call localized, m.
  static constexpr double kLost_m = 0.5;

  std::optional<double> said_s;    ///< when its belief's status became lost
  std::optional<double> passed_s;  ///< when its error passed kLost_m, and what the claim allows for
  std::optional<double> ended_s;
  /// It said so while it was not astray (see LossScore) and claimed σ ≤ kLost_m.
  bool groundless = false;
  double began_s() const;
  /// Groundless, and the error did not pass kLost_m later on either.
  bool false_alarm() const { return groundless && !passed_s; }
  /// Whether it had said so by the time the error passed kLost_m, if it ever did. A false alarm
  /// announces nothing.
  bool announced() const { return said_s && !false_alarm() && (!passed_s || *said_s <= *passed_s); }
};

/// How one localizer was lost and found on one drive, against the truth and its claimed σ. It is
/// astray while its position is off by more than half a metre or by more than four times the
/// claimed √λ_max. Off by more than the claim allows for (see LostEpisode), it is wrong.
struct LossScore {
  /// Episodes that were false alarms (see LostEpisode).
  int false_alarms = 0;
  double driven_m = 0.0;  ///< by odometry
  double false_alarms_per_km() const;
  /// Times wrong that began while it said that it knows where it is, and were not said while they
  /// lasted; one lasts until the error is within half of what the claim allows for.
  int misses = 0;
  int misses_over_half_metre = 0;  ///< of those, the ones that went beyond half a metre
  double unsaid_s = 0.0;           ///< wrong and `tracking`
  int said = 0;                    ///< times wrong that it said, if late
  double delay_mean_s = 0.0;       ///< of those, from going wrong to saying so
  double delay_max_s = 0.0;
  int right_recoveries = 0;  ///< came to say `tracking` and was not wrong
  int wrong_recoveries = 0;  ///< … and was
  double ambiguous_s = 0.0;  ///< in status `ambiguous`
  double brier = 0.0;        ///< mean of (lost_probability − astray)²
  std::array<CalibrationBin, 10> calibration{};
};

/// Of several drives together: sums; delays and calibration by how many they are the means of.
LossScore combined(const std::vector<LossScore>& drives);

/// Scores a localizer's losses tick by tick.
class LossScorer {
 public:
  static constexpr double kAstray_m = LostEpisode::kLost_m;
  static constexpr double kAstraySigmas = 4.0;

  /// One tick of @p dt_s that ends at @p now_s, during which the wheels turned by @p driven_m.
  void add(double now_s, double dt_s, double driven_m, const Belief& belief, const Pose2& truth);

  LossScore score() const;
  const std::vector<LostEpisode>& episodes() const { return episodes_; }

 private:
  /// A time wrong.
  struct Wrong {
    double since_s = 0.0;
    std::optional<double> said_s;
    bool over_half_metre = false;
  };

  void follow_status(double error_m, const Belief& belief);
  void follow_error(double now_s, double dt_s, double error_m, const Belief& belief);
  void close(const Wrong& ended);
  void calibrate(double probability, bool astray);

  LossScore score_;
  std::optional<BeliefStatus> last_;
  std::vector<LostEpisode> episodes_;
  std::optional<Wrong> open_;
  double delay_sum_s_ = 0.0;
  double brier_sum_ = 0.0;
  int ticks_ = 0;
};

}  // namespace vigia::evaluation
