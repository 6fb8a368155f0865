#include "vigia/evaluation/estimator_score.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "vigia/evaluation/metrics.hpp"
#include "vigia/localization/spatial_pose.hpp"

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

const double kRampPitch = from_deg(0.2);  // of the ground under a robot that does not stand level

bool level(const Eigen::Isometry3d& wMr) {
  return wMr.linear()(2, 2) > std::cos(kRampPitch);
}

}  // namespace

EstimatorScorer::EstimatorScorer(EstimatorSetup setup) : setup_(std::move(setup)), bound_(setup_) {}

void EstimatorScorer::add(const mission::EstimatorTick& tick, std::size_t localizer) {
  const Belief& belief = *tick.localizers[localizer].belief;
  if (tick.truth) {
    const mission::GroundTruth& truth = *tick.truth;
    const double turned = wrap_angle(truth.pose.theta - truth.pose_before.theta);
    const auto u = chord_increment(truth.pose_before, truth.pose, turned, tick.odometry.from,
                                   tick.odometry.to);
    bound_.move(truth.pose_before, u);
  }
  const auto fused = count_updates(tick, localizer);
  if (belief.status == BeliefStatus::lost)
    score_.lost_s += (tick.odometry.to - tick.odometry.from).seconds();
  if (tick.truth) add_errors(tick, belief, fused);
  if (tick.truth && tick.truth->wMr && fused) add_errors_in_space(tick, belief, *fused);
}

void EstimatorScorer::add_errors_in_space(const mission::EstimatorTick& tick, const Belief& belief,
                                          LookId look) {
  const SpatialPose truth{*tick.truth->wMr, {}};
  const SpatialPose on_map{setup_.on_ground.ground.place(belief.pose), {}};
  const auto was = localization::floor_attitude(truth);
  const auto seen = localization::floor_attitude(belief.in_space.value_or(on_map));
  AttitudeError of{look, !level(truth.wMr), {}, 0.0};
  of.error << seen.z_m - was.z_m, seen.pitch - was.pitch, seen.roll - was.roll;
  if (belief.in_space) of.nees = of.error.dot(seen.covariance.ldlt().solve(of.error));
  if (attitudes_.empty() || attitudes_.back().look != look) attitudes_.push_back(of);
  attitudes_.back() = of;
}

AttitudeScore EstimatorScorer::attitude_score(bool ramp) const {
  AttitudeScore score;
  Eigen::Vector3d squared = Eigen::Vector3d::Zero();
  Eigen::Vector3d largest = Eigen::Vector3d::Zero();
  for (const AttitudeError& of : attitudes_) {
    if (of.ramp != ramp) continue;
    ++score.looks;
    squared += of.error.cwiseAbs2();
    largest = largest.cwiseMax(of.error.cwiseAbs());
    score.nees_mean += of.nees;
  }
  const double n = std::max(1, score.looks);
  const Eigen::Vector3d rms = (squared / n).cwiseSqrt();
  score.z_rms_m = rms[0];
  score.pitch_rms_rad = rms[1];
  score.roll_rms_rad = rms[2];
  score.z_max_m = largest[0];
  score.pitch_max_rad = largest[1];
  score.roll_max_rad = largest[2];
  score.nees_mean /= n;
  return score;
}

/// Counts what became of the observations; the look of the last one that was fused.
std::optional<LookId> EstimatorScorer::count_updates(const mission::EstimatorTick& tick,
                                                     std::size_t localizer) {
  const auto& updates = tick.localizers[localizer].updates;
  std::optional<LookId> look;
  for (std::size_t k = 0; k < updates.size(); ++k) {
    const Observation& observation = tick.observations[k];
    const bool motion = std::holds_alternative<FlowObservation>(observation);
    if (!motion) ++count_of(score_, updates[k].status);
    if (updates[k].status != localization::UpdateStatus::fused) continue;
    if (tick.truth) bound_.learn(observation, tick.truth->exposures[k]);
    if (!motion) look = shot_of(observation).look;
  }
  return look;
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

double EstimatorScorer::bound_position_m2() const {
  return bound_.covariance().topLeftCorner<2, 2>().trace();
}

LocalizerScore EstimatorScorer::score() const {
  LocalizerScore score = score_;
  const double n = std::max(1, sums_.ticks);
  score.position_rmse_m = std::sqrt(sums_.squared_position / n);
  score.heading_rmse_rad = std::sqrt(sums_.squared_heading / n);
  score.nees_mean = sums_.nees / n;
  score.pcrlb_position_rms_m = std::sqrt(sums_.bound_trace / n);
  const Eigen::Matrix3d bound = bound_.covariance();
  score.pcrlb_position_final_m = mean_length(bound.topLeftCorner<2, 2>());
  score.pcrlb_heading_final_rad = std::sqrt(2.0 * bound(2, 2) / kPi);
  score.loss = losses_.score();
  score.lost = losses_.episodes();
  if (!setup_.on_ground.ground.flat())
    score.in_space = SpaceScore{attitude_score(false), attitude_score(true)};
  return score;
}

}  // namespace vigia::evaluation
