#include "vigia/evaluation/drive_score.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vigia/mission/delays.hpp"
#include "vigia/mission/localizers.hpp"

namespace vigia::evaluation {
namespace {

/// Of a start of which nothing is said: anywhere in the building.
Eigen::Matrix3d covariance_of_anywhere(const FloorPlan& plan) {
  const Eigen::Vector2d extent = plan.max_corner() - plan.min_corner();
  const Eigen::Vector3d variances(extent.x() * extent.x() / 12.0, extent.y() * extent.y() / 12.0,
                                  kPi * kPi / 3.0);
  return variances.asDiagonal();
}

std::optional<EstimatorSetup::Ceiling> ceiling_of(const mission::MissionSetup& setup,
                                                  const std::string& localizer) {
  const auto camera = mission::ceiling_camera(setup);
  if (!camera) return std::nullopt;
  return EstimatorSetup::Ceiling{*camera, *setup.world.ceiling, setup.ceiling,
                                 mission::moved_by_flow(setup, localizer)};
}

/// With the errors of calibration that the simulator truly draws.
std::optional<localization::CornerFilterParams> corners_of(const mission::MissionSetup& setup) {
  auto params = mission::corner_filter_params(setup);
  if (!params) return std::nullopt;
  const auto& drawn = setup.disturbances.stereo;
  params->calibration_sigma =
      drawn ? localization::StereoErrors{drawn->baseline, drawn->vergence, drawn->focal}
            : localization::StereoErrors{};
  return params;
}

EstimatorSetup estimator_setup(const mission::MissionSetup& setup, const std::string& localizer) {
  return {setup.world.landmarks,
          setup.on_ground(),
          setup.robot.robot.odometry,
          setup.robot.robot.sensor,
          setup.prior ? setup.prior->covariance : covariance_of_anywhere(setup.world.plan),
          setup.prior.has_value(),
          setup.world.field,
          ceiling_of(setup, localizer),
          corners_of(setup),
          mission::longest_delay(setup)};
}

}  // namespace

struct DriveScorer::Impl {
  const mission::MissionSetup* setup = nullptr;
  DriveScore score;
  std::vector<EstimatorScorer> localizers;  ///< in the order of MissionSetup::localizers
  int centred = 0;
  double squared_centring = 0.0;
  bool stopped = false;
  bool zooming = false;
  double last_zoom_mm = 0.0;
  double last_pan = 0.0;
  double last_sigma_m = 0.0;
  double lost_since_s = 0.0;

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
  impl_->localizers.clear();
  for (const std::string& name : setup.localizers)
    impl_->localizers.emplace_back(estimator_setup(setup, name));
  impl_->last_zoom_mm = setup.robot.initial_zoom_mm;
}

void DriveScorer::on_tick(const mission::Tick& tick) {
  for (std::size_t i = 0; i < impl_->localizers.size(); ++i)
    impl_->localizers[i].add(tick.estimator, i);
  impl_->score_perception(tick);
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
  for (std::size_t i = 0; i < impl.localizers.size(); ++i)
    impl.score.localizers[impl.setup->localizers[i]] = impl.localizers[i].score();
}

const DriveScore& DriveScorer::score() const {
  return impl_->score;
}

double DriveScorer::bound_position_m2(std::size_t localizer) const {
  return impl_->localizers[localizer].bound_position_m2();
}

}  // namespace vigia::evaluation
