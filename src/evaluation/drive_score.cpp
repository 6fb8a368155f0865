#include "vigia/evaluation/drive_score.hpp"

#include "loss_watch.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/evaluation/metrics.hpp"
#include "vigia/evaluation/pcrlb.hpp"

namespace vigia::evaluation {
namespace {

int& count_of(LocalizerScore& score, localization::UpdateStatus status) {
  switch (status) {
    case localization::UpdateStatus::fused:
      return score.updates;
    case localization::UpdateStatus::unsupported:
      return score.unsupported;
    default:
      return score.rejected;
  }
}

/// What the image taught at best.
void bound_by(const Observation& observation, const Landmark& landmark,
              const mission::ExposureTruth& truth, PosteriorBound& bound) {
  const Shot& shot = shot_of(observation);
  if (const auto* disc = std::get_if<EllipseObservation>(&observation))
    bound.update(truth.pose, landmark, shot, truth.bias,
                 localization::measured_disc_covariance(*disc));
  if (const auto* points = std::get_if<PointsObservation>(&observation))
    bound.update(truth.pose, landmark, shot, truth.bias,
                 localization::seen_points(landmark, *points));
}

}  // namespace

struct DriveScorer::Impl {
  /// One localizer's sums over a drive.
  struct LocalizerSums {
    explicit LocalizerSums(PosteriorBound b) : bound(std::move(b)) {}

    PosteriorBound bound;
    double squared_position = 0.0;
    double squared_heading = 0.0;
    double nees = 0.0;
    double bound_trace = 0.0;
    LocalizerScore score;
  };

  const mission::MissionSetup* setup = nullptr;
  DriveScore score;
  std::vector<LocalizerSums> sums;
  int ticks = 0;
  int centred = 0;
  double squared_centring = 0.0;
  bool stopped = false;
  bool zooming = false;
  double last_zoom_mm = 0.0;
  double last_pan = 0.0;
  double last_sigma_m = 0.0;
  double lost_since_s = 0.0;

  void score_localizer(const mission::EstimatorTick& tick, std::size_t i);
  /// Counts what became of the observations; the look of the last one that was fused.
  std::optional<LookId> score_updates(const mission::EstimatorTick& tick, std::size_t i);
  static void score_look(LookId look, LocalizerSums& sum, double nees, double squared);
  void score_perception(const mission::Tick& tick);
  void score_centring(const mission::AttentionTick& attention);
};

DriveScorer::DriveScorer() : impl_(std::make_unique<Impl>()) {}
DriveScorer::~DriveScorer() = default;

void DriveScorer::on_start(const mission::MissionStart& start) {
  const mission::MissionSetup& setup = start.setup;
  *impl_ = {};
  impl_->setup = &setup;
  impl_->score.mission = setup.name;
  impl_->score.seed = start.seed;
  impl_->score.primary = setup.primary;
  for (std::size_t i = 0; i < setup.localizers.size(); ++i)
    impl_->sums.emplace_back(
        PosteriorBound(setup.prior.covariance, setup.on_ground(), setup.robot.robot.sensor));
  impl_->last_zoom_mm = setup.robot.initial_zoom_mm;
}

void DriveScorer::on_tick(const mission::Tick& tick) {
  for (std::size_t i = 0; i < impl_->sums.size(); ++i) impl_->score_localizer(tick.estimator, i);
  impl_->score_perception(tick);
  ++impl_->ticks;
}

std::optional<LookId> DriveScorer::Impl::score_updates(const mission::EstimatorTick& tick,
                                                       std::size_t i) {
  LocalizerSums& sum = sums[i];
  const auto& updates = tick.localizers[i].updates;
  std::optional<LookId> look;
  for (std::size_t k = 0; k < updates.size(); ++k) {
    ++count_of(sum.score, updates[k].status);
    if (updates[k].status != localization::UpdateStatus::fused) continue;
    if (updates[k].landmark)
      bound_by(tick.observations[k], *setup->world.landmarks.find(*updates[k].landmark),
               tick.truth->exposures[k], sum.bound);
    look = shot_of(tick.observations[k]).look;
  }
  return look;
}

void DriveScorer::Impl::score_localizer(const mission::EstimatorTick& tick, std::size_t i) {
  LocalizerSums& sum = sums[i];
  const mission::GroundTruth& truth = *tick.truth;
  const Belief& belief = *tick.localizers[i].belief;
  const double turned = wrap_angle(truth.pose.theta - truth.pose_before.theta);
  const auto u =
      chord_increment(truth.pose_before, truth.pose, turned, tick.odometry.from, tick.odometry.to);
  sum.bound.predict(truth.pose_before, u, control_covariance(u, setup->robot.robot.odometry));
  const auto fused = score_updates(tick, i);
  const Eigen::Vector3d error = difference(belief.pose, truth.pose);
  const double squared = error.head<2>().squaredNorm();
  const double nees = evaluation::nees({truth.pose, belief.pose, belief.covariance});
  sum.squared_position += squared;
  sum.squared_heading += error.z() * error.z();
  sum.nees += nees;
  sum.bound_trace += sum.bound.covariance().topLeftCorner<2, 2>().trace();
  sum.score.position_max_m = std::max(sum.score.position_max_m, std::sqrt(squared));
  sum.score.position_final_m = std::sqrt(squared);
  sum.score.heading_final_rad = std::abs(error.z());
  const bool says_lost = belief.status == BeliefStatus::lost;
  if (says_lost) sum.score.lost_s += setup->tick_s;
  watch_for_loss(sum.score.lost, tick.now.seconds(), says_lost, std::sqrt(squared));
  if (fused) score_look(*fused, sum, nees, squared);
}

void DriveScorer::Impl::score_look(LookId look, LocalizerSums& sum, double nees, double squared) {
  auto& looks = sum.score.looks;
  if (looks.empty() || looks.back().look != look) looks.push_back({look});
  looks.back() = {look, nees, squared, sum.bound.covariance().topLeftCorner<2, 2>().trace()};
}

void DriveScorer::Impl::score_perception(const mission::Tick& tick) {
  PerceptionScore& p = score.perception;
  const auto attention = tick.attention.value_or(mission::AttentionTick{});
  score_centring(attention);
  if (attention.stopped_to_look) {
    p.stopped_s += setup->tick_s;
    if (!stopped) ++p.stops;
  }
  stopped = attention.stopped_to_look;
  const bool zoom_moves = std::abs(tick.truth.zoom_mm - last_zoom_mm) > 1e-9;
  if (zoom_moves && !zooming) ++p.zoom_changes;
  zooming = zoom_moves;
  last_zoom_mm = tick.truth.zoom_mm;
  p.pan_travel_rad += std::abs(tick.truth.head.pan - last_pan);
  last_pan = tick.truth.head.pan;
  const double sigma = tick.estimator.primary_belief().position_sigma();
  const auto& limits = setup->look.trigger;
  if (sigma > limits.limit_1_m && last_sigma_m <= limits.limit_1_m) ++p.over_limit_1;
  if (sigma > limits.limit_2_m && last_sigma_m <= limits.limit_2_m) ++p.over_limit_2;
  last_sigma_m = sigma;
}

void DriveScorer::Impl::score_centring(const mission::AttentionTick& attention) {
  if (!attention.centring_px || attention.tracked_s < kSettle_s) return;
  ++centred;
  const double off_px = *attention.centring_px;
  squared_centring += off_px * off_px;
  score.perception.centring_max_px = std::max(score.perception.centring_max_px, off_px);
}

void DriveScorer::on_event(const mission::Event& event) {
  if (event.kind == mission::EventKind::look) ++impl_->score.perception.looks;
  if (event.kind == mission::EventKind::target_lost) ++impl_->score.perception.target_losses;
  RecoveryScore& recovery = impl_->score.recovery;
  if (event.kind == mission::EventKind::lost) {
    ++recovery.lost;
    impl_->lost_since_s = event.stamp.seconds();
  }
  if (event.kind == mission::EventKind::recovered) {
    ++recovery.recovered;
    recovery.recovering_s += event.stamp.seconds() - impl_->lost_since_s;
  }
}

void DriveScorer::on_finish(mission::Outcome outcome, Stamp end) {
  Impl& impl = *impl_;
  impl.score.outcome = outcome;
  impl.score.sim_s = end.seconds();
  if (impl.centred > 0)
    impl.score.perception.centring_rms_px = std::sqrt(impl.squared_centring / impl.centred);
  const double n = std::max(1, impl.ticks);
  for (std::size_t i = 0; i < impl.sums.size(); ++i) {
    Impl::LocalizerSums& sum = impl.sums[i];
    sum.score.position_rmse_m = std::sqrt(sum.squared_position / n);
    sum.score.heading_rmse_rad = std::sqrt(sum.squared_heading / n);
    sum.score.nees_mean = sum.nees / n;
    sum.score.pcrlb_position_rms_m = std::sqrt(sum.bound_trace / n);
    const Eigen::Matrix3d bound = sum.bound.covariance();
    sum.score.pcrlb_position_final_m = mean_length(bound.topLeftCorner<2, 2>());
    sum.score.pcrlb_heading_final_rad = std::sqrt(2.0 * bound(2, 2) / kPi);
    impl.score.localizers[impl.setup->localizers[i]] = sum.score;
  }
}

const DriveScore& DriveScorer::score() const {
  return impl_->score;
}

}  // namespace vigia::evaluation
