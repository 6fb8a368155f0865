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
              const sim::RobotTruth& truth, PosteriorBound& bound) {
  const auto& angle = truth.look_angle_error;
  const localization::LookBias bias{angle.pan, angle.tilt, truth.look_log_focal_error};
  const Shot& shot = shot_of(observation);
  if (const auto* disc = std::get_if<EllipseObservation>(&observation))
    bound.update(truth.pose, landmark, shot, bias, localization::measured_disc_covariance(*disc));
  if (const auto* points = std::get_if<PointsObservation>(&observation))
    bound.update(truth.pose, landmark, shot, bias, localization::seen_points(landmark, *points));
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

  void score_localizer(const mission::Tick& tick, std::size_t i);
  void score_look(const mission::Tick& tick, LocalizerSums& sum, double nees, double squared);
  void score_perception(const mission::Tick& tick);
  void score_centring(const mission::Tick& tick);
};

DriveScorer::DriveScorer() : impl_(std::make_unique<Impl>()) {}
DriveScorer::~DriveScorer() = default;

void DriveScorer::on_start(const mission::MissionSetup& setup, std::uint64_t seed) {
  *impl_ = {};
  impl_->setup = &setup;
  impl_->score.mission = setup.name;
  impl_->score.seed = seed;
  impl_->score.primary = setup.primary;
  for (std::size_t i = 0; i < setup.localizers.size(); ++i)
    impl_->sums.emplace_back(
        PosteriorBound(setup.prior.covariance, setup.on_ground(), setup.robot.robot.sensor));
  impl_->last_zoom_mm = setup.robot.initial_zoom_mm;
}

void DriveScorer::on_tick(const mission::Tick& tick) {
  for (std::size_t i = 0; i < tick.localizers.size(); ++i) impl_->score_localizer(tick, i);
  impl_->score_perception(tick);
  ++impl_->ticks;
}

void DriveScorer::Impl::score_localizer(const mission::Tick& tick, std::size_t i) {
  LocalizerSums& sum = sums[i];
  const Belief& belief = *tick.localizers[i].belief;
  const auto& update = tick.localizers[i].update;
  const double turned = wrap_angle(tick.truth.pose.theta - tick.true_pose_before.theta);
  const auto u = chord_increment(tick.true_pose_before, tick.truth.pose, turned, tick.odometry.from,
                                 tick.odometry.to);
  sum.bound.predict(tick.true_pose_before, u, control_covariance(u, setup->robot.robot.odometry));
  const bool fused = update && update->status == localization::UpdateStatus::fused;
  if (update) ++count_of(sum.score, update->status);
  if (fused && update->landmark)
    bound_by(*tick.observation, *setup->world.landmarks.find(*update->landmark),
             tick.truth_at_exposure, sum.bound);
  const Eigen::Vector3d error = difference(belief.pose, tick.truth.pose);
  const double squared = error.head<2>().squaredNorm();
  const double nees = evaluation::nees({tick.truth.pose, belief.pose, belief.covariance});
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
  if (fused) score_look(tick, sum, nees, squared);
}

void DriveScorer::Impl::score_look(const mission::Tick& tick, LocalizerSums& sum, double nees,
                                   double squared) {
  auto& looks = sum.score.looks;
  if (looks.empty() || looks.back().look != tick.look) looks.push_back({tick.look});
  looks.back() = {tick.look, nees, squared, sum.bound.covariance().topLeftCorner<2, 2>().trace()};
}

void DriveScorer::Impl::score_perception(const mission::Tick& tick) {
  PerceptionScore& p = score.perception;
  score_centring(tick);
  if (tick.stopped_to_look) {
    p.stopped_s += setup->tick_s;
    if (!stopped) ++p.stops;
  }
  stopped = tick.stopped_to_look;
  const bool zoom_moves = std::abs(tick.truth.zoom_mm - last_zoom_mm) > 1e-9;
  if (zoom_moves && !zooming) ++p.zoom_changes;
  zooming = zoom_moves;
  last_zoom_mm = tick.truth.zoom_mm;
  p.pan_travel_rad += std::abs(tick.truth.head.pan - last_pan);
  last_pan = tick.truth.head.pan;
  const double sigma = tick.localizers[tick.primary].belief->position_sigma();
  const auto& limits = setup->look.trigger;
  if (sigma > limits.limit_1_m && last_sigma_m <= limits.limit_1_m) ++p.over_limit_1;
  if (sigma > limits.limit_2_m && last_sigma_m <= limits.limit_2_m) ++p.over_limit_2;
  last_sigma_m = sigma;
}

void DriveScorer::Impl::score_centring(const mission::Tick& tick) {
  if (!tick.centring_px || tick.tracked_s < kSettle_s) return;
  ++centred;
  squared_centring += *tick.centring_px * *tick.centring_px;
  score.perception.centring_max_px = std::max(score.perception.centring_max_px, *tick.centring_px);
}

void DriveScorer::on_event(const mission::Event& event) {
  if (event.kind == "look") ++impl_->score.perception.looks;
  if (event.kind == "target_lost") ++impl_->score.perception.target_losses;
  RecoveryScore& recovery = impl_->score.recovery;
  if (event.kind == "lost") {
    ++recovery.lost;
    impl_->lost_since_s = event.stamp.seconds();
  }
  if (event.kind == "recovered") {
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
