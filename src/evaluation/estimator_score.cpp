#include "vigia/evaluation/estimator_score.hpp"

#include "true_association.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vigia/evaluation/metrics.hpp"

namespace vigia::evaluation {
namespace {

int& count_of(LocalizerScore& score, localization::UpdateStatus status) {
  switch (status) {
    case localization::UpdateStatus::fused:
      return score.updates;
    case localization::UpdateStatus::unsupported:
      return score.unsupported;
    case localization::UpdateStatus::gated:
    case localization::UpdateStatus::ambiguous:
    case localization::UpdateStatus::degenerate:
    case localization::UpdateStatus::too_late:
    case localization::UpdateStatus::no_prior:
      return score.rejected;
  }
  return score.rejected;
}

}  // namespace

EstimatorScorer::EstimatorScorer(EstimatorSetup setup)
    : setup_(std::move(setup)), bound_(setup_.prior_covariance, setup_.on_ground, setup_.sensor) {
  if (setup_.field) field_.emplace(*setup_.field);
  if (setup_.corners && setup_.field) {
    localization::CornerFilterParams exact = *setup_.corners;
    exact.odometry = setup_.odometry;
    exact.gate = 1e12;  // of a corner its covariance counts, not where it is
    exact.iterations = 1;
    corners_.emplace(*setup_.field, exact);
    corners_->reset({}, {{}, setup_.prior_covariance});
  }
  if (!setup_.ceiling) return;
  localization::CeilingFilterParams params;
  params.odometry = setup_.odometry;
  ceiling_.emplace(setup_.ceiling->camera, setup_.ceiling->grid, params);
  ceiling_->reset({}, {{}, setup_.prior_covariance});
}

void EstimatorScorer::add(const mission::EstimatorTick& tick, std::size_t localizer) {
  const Belief& belief = *tick.localizers[localizer].belief;
  if (tick.truth) {
    const mission::GroundTruth& truth = *tick.truth;
    const double turned = wrap_angle(truth.pose.theta - truth.pose_before.theta);
    const auto u = chord_increment(truth.pose_before, truth.pose, turned, tick.odometry.from,
                                   tick.odometry.to);
    bound_.predict(truth.pose_before, u, control_covariance(u, setup_.odometry));
    if (ceiling_) {
      ceiling_->place({truth.pose_before, {}, {}});
      ceiling_->predict(u);
    }
    if (corners_) {
      corners_->relinearise(truth.pose_before);
      corners_->predict(u);
    }
  }
  const auto fused = count_updates(tick, localizer);
  if (belief.status == BeliefStatus::lost)
    score_.lost_s += (tick.odometry.to - tick.odometry.from).seconds();
  if (tick.truth) add_errors(tick, belief, fused);
}

/// Counts what became of the observations; the look of the last one that was fused.
std::optional<LookId> EstimatorScorer::count_updates(const mission::EstimatorTick& tick,
                                                     std::size_t localizer) {
  const auto& updates = tick.localizers[localizer].updates;
  std::optional<LookId> look;
  for (std::size_t k = 0; k < updates.size(); ++k) {
    ++count_of(score_, updates[k].status);
    if (updates[k].status != localization::UpdateStatus::fused) continue;
    if (tick.truth) bound_by(tick.observations[k], tick.truth->exposures[k]);
    look = shot_of(tick.observations[k]).look;
  }
  return look;
}

/// What the image taught at best, whatever the localizer took it for.
void EstimatorScorer::bound_by(const Observation& observation,
                               const mission::ExposureTruth& truth) {
  if (const auto* seen = std::get_if<FieldObservation>(&observation); seen && field_) {
    // Of the points as they truly lie: on the map's lines or by chance.
    bound_.update(
        field_->linearise(seen->scan.points, truth.pose, field_->params().clutter).complete);
    return;
  }
  if (const auto* seen = std::get_if<PatchesObservation>(&observation); seen && ceiling_) {
    ceiling_->inform({truth.pose, {}, {}}, seen->patches);
    return;
  }
  if (const auto* seen = std::get_if<StereoObservation>(&observation); seen && corners_) {
    corners_->relinearise(truth.pose);
    corners_->update(seen->corners);
    return;
  }
  const Landmark* landmark =
      true_landmark(observation, setup_.landmarks, setup_.on_ground, truth.pose, truth.bias);
  if (landmark != nullptr) bound_.update(truth.pose, truth.bias, *landmark, observation);
}

void EstimatorScorer::add_errors(const mission::EstimatorTick& tick, const Belief& belief,
                                 std::optional<LookId> fused) {
  const Pose2& truth = tick.truth->pose;
  const Eigen::Vector3d error = difference(belief.pose, truth);
  const double squared = error.head<2>().squaredNorm();
  const double nees = evaluation::nees({truth, belief.pose, belief.covariance});
  const double bound_m2 = bound_position_m2();
  if (!fixed_ && belief.status == BeliefStatus::tracking) {
    // What it believed before it knew anything is no estimate.
    fixed_ = true;
    if (!setup_.prior) {
      sums_ = {};
      score_.position_max_m = 0.0;
    }
  }
  ++sums_.ticks;
  sums_.squared_position += squared;
  sums_.squared_heading += error.z() * error.z();
  sums_.nees += nees;
  sums_.bound_trace += bound_m2;
  score_.position_max_m = std::max(score_.position_max_m, std::sqrt(squared));
  score_.position_final_m = std::sqrt(squared);
  score_.heading_final_rad = std::abs(error.z());
  const double now_s = tick.now.seconds();
  const double dt_s = (tick.odometry.to - tick.odometry.from).seconds();
  losses_.add(now_s, dt_s, std::abs(tick.odometry.trans), belief, truth);
  if (!fused) return;
  auto& looks = score_.looks;
  if (looks.empty() || looks.back().look != *fused) looks.push_back({*fused});
  looks.back() = {*fused, nees, squared, bound_m2};
}

Eigen::Matrix3d EstimatorScorer::bound_covariance() const {
  if (corners_) return corners_->belief().covariance;
  return ceiling_ ? ceiling_->belief().covariance : bound_.covariance();
}

double EstimatorScorer::bound_position_m2() const {
  return bound_covariance().topLeftCorner<2, 2>().trace();
}

LocalizerScore EstimatorScorer::score() const {
  LocalizerScore score = score_;
  const double n = std::max(1, sums_.ticks);
  score.position_rmse_m = std::sqrt(sums_.squared_position / n);
  score.heading_rmse_rad = std::sqrt(sums_.squared_heading / n);
  score.nees_mean = sums_.nees / n;
  score.pcrlb_position_rms_m = std::sqrt(sums_.bound_trace / n);
  const Eigen::Matrix3d bound = bound_covariance();
  score.pcrlb_position_final_m = mean_length(bound.topLeftCorner<2, 2>());
  score.pcrlb_heading_final_rad = std::sqrt(2.0 * bound(2, 2) / kPi);
  score.loss = losses_.score();
  score.lost = losses_.episodes();
  return score;
}

}  // namespace vigia::evaluation
