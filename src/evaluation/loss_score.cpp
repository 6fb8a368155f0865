#include "vigia/evaluation/loss_score.hpp"

#include "lost_episodes.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::evaluation {
namespace {

int ticks_of(const LossScore& score) {
  int ticks = 0;
  for (const CalibrationBin& bin : score.calibration) ticks += bin.ticks;
  return ticks;
}

/// @p mean of @p count values with @p more_mean of @p more values added.
double mean_of_both(double mean, int count, double more_mean, int more) {
  return count + more > 0 ? (mean * count + more_mean * more) / (count + more) : 0.0;
}

void add_to(LossScore& sum, const LossScore& drive) {
  sum.brier = mean_of_both(sum.brier, ticks_of(sum), drive.brier, ticks_of(drive));
  sum.delay_mean_s = mean_of_both(sum.delay_mean_s, sum.said, drive.delay_mean_s, drive.said);
  sum.delay_max_s = std::max(sum.delay_max_s, drive.delay_max_s);
  sum.false_alarms += drive.false_alarms;
  sum.driven_m += drive.driven_m;
  sum.misses += drive.misses;
  sum.misses_over_half_metre += drive.misses_over_half_metre;
  sum.unsaid_s += drive.unsaid_s;
  sum.said += drive.said;
  sum.right_recoveries += drive.right_recoveries;
  sum.wrong_recoveries += drive.wrong_recoveries;
  sum.ambiguous_s += drive.ambiguous_s;
  for (std::size_t i = 0; i < sum.calibration.size(); ++i) {
    CalibrationBin& bin = sum.calibration[i];
    const CalibrationBin& more = drive.calibration[i];
    bin.mean_probability =
        mean_of_both(bin.mean_probability, bin.ticks, more.mean_probability, more.ticks);
    bin.ticks += more.ticks;
    bin.astray += more.astray;
  }
}

}  // namespace

double LossScore::false_alarms_per_km() const {
  return driven_m > 0.0 ? 1000.0 * false_alarms / driven_m : 0.0;
}

LossScore combined(const std::vector<LossScore>& drives) {
  LossScore sum;
  for (const LossScore& drive : drives) add_to(sum, drive);
  return sum;
}

void LossScorer::add(double now_s, double dt_s, double driven_m, const Belief& belief,
                     const Pose2& truth) {
  const double error_m = (belief.pose.position() - truth.position()).norm();
  const double sigma_m = belief.position_sigma();
  const bool astray = is_astray(error_m, sigma_m);
  update_episodes(episodes_, now_s, belief.status == BeliefStatus::lost, error_m, sigma_m);
  follow_status(error_m, belief);
  follow_error(now_s, dt_s, error_m, belief);
  score_.driven_m += driven_m;
  if (belief.status == BeliefStatus::ambiguous) score_.ambiguous_s += dt_s;
  calibrate(belief.lost_probability, astray);
  last_ = belief.status;
}

void LossScorer::follow_status(double error_m, const Belief& belief) {
  if (!last_ || belief.status == *last_ || belief.status != BeliefStatus::tracking) return;
  const bool wrong = error_m > allowed_error_m(belief.position_sigma());
  ++(wrong ? score_.wrong_recoveries : score_.right_recoveries);
}

void LossScorer::follow_error(double now_s, double dt_s, double error_m, const Belief& belief) {
  const double allowed_m = allowed_error_m(belief.position_sigma());
  const bool says_tracking = belief.status == BeliefStatus::tracking;
  if (error_m > allowed_m) {
    if (says_tracking) score_.unsaid_s += dt_s;
    // What begins while it says that it does not know is no miss.
    if (!open_ && says_tracking) open_ = Wrong{now_s, std::nullopt, false};
  }
  if (!open_) return;
  open_->over_half_metre = open_->over_half_metre || error_m > kAstray_m;
  if (!says_tracking && !open_->said_s) open_->said_s = now_s;
  if (!open_->said_s && error_m > 0.5 * allowed_m) return;
  close(*open_);
  open_.reset();
}

void LossScorer::close(const Wrong& ended) {
  if (!ended.said_s) {
    ++score_.misses;
    if (ended.over_half_metre) ++score_.misses_over_half_metre;
    return;
  }
  const double delay_s = *ended.said_s - ended.since_s;
  ++score_.said;
  delay_sum_s_ += delay_s;
  score_.delay_max_s = std::max(score_.delay_max_s, delay_s);
}

void LossScorer::calibrate(double probability, bool astray) {
  const auto bins = static_cast<double>(score_.calibration.size());
  const auto i = static_cast<std::size_t>(std::clamp(bins * probability, 0.0, bins - 1.0));
  CalibrationBin& bin = score_.calibration[i];
  ++bin.ticks;
  bin.mean_probability += probability;  // a sum until score() divides it
  if (astray) ++bin.astray;
  brier_sum_ += std::pow(probability - (astray ? 1.0 : 0.0), 2);
  ++ticks_;
}

LossScore LossScorer::score() const {
  LossScorer whole = *this;
  if (whole.open_) whole.close(*whole.open_);
  LossScore score = whole.score_;
  score.false_alarms = static_cast<int>(std::count_if(
      episodes_.begin(), episodes_.end(), [](const LostEpisode& e) { return e.false_alarm(); }));
  if (score.said > 0) score.delay_mean_s = whole.delay_sum_s_ / score.said;
  if (ticks_ > 0) score.brier = brier_sum_ / ticks_;
  for (CalibrationBin& bin : score.calibration)
    if (bin.ticks > 0) bin.mean_probability /= bin.ticks;
  return score;
}

}  // namespace vigia::evaluation
