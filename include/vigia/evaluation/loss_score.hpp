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

/// How one localizer was lost and found on one drive, against the truth and its claimed σ. It is
/// astray while its position is off by more than half a metre or by more than four times the
/// claimed √λ_max.
struct LossScore {
  /// How often it came to say that it is lost though it was not astray and claimed σ ≤ half a
  /// metre.
  int false_alarms = 0;
  double driven_m = 0.0;  ///< by odometry
  double false_alarms_per_km() const;
  /// Times astray that began while it said that it knows where it is, and were not said while they
  /// lasted; one lasts until the error is within half of both limits.
  int misses = 0;
  int misses_over_half_metre = 0;  ///< of those, the ones that went beyond half a metre
  double unsaid_s = 0.0;           ///< astray and `tracking`
  int said = 0;                    ///< times astray that it said, if late
  double delay_mean_s = 0.0;       ///< of those, from going astray to saying so
  double delay_max_s = 0.0;
  int right_recoveries = 0;  ///< came to say `tracking` and was not astray
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
  static constexpr double kAstray_m = 0.5;
  static constexpr double kAstraySigmas = 4.0;

  /// One tick of @p dt_s that ends at @p now_s, during which the wheels turned by @p driven_m.
  void add(double now_s, double dt_s, double driven_m, const Belief& belief, const Pose2& truth);

  LossScore score() const;

 private:
  /// A time astray.
  struct Astray {
    double since_s = 0.0;
    std::optional<double> said_s;
    bool over_half_metre = false;
  };

  void follow_status(bool astray, const Belief& belief);
  void follow_error(double now_s, double dt_s, double error_m, const Belief& belief);
  void close(const Astray& ended);
  void calibrate(double probability, bool astray);

  LossScore score_;
  std::optional<BeliefStatus> last_;
  std::optional<Astray> open_;
  double delay_sum_s_ = 0.0;
  double brier_sum_ = 0.0;
  int ticks_ = 0;
};

}  // namespace vigia::evaluation
