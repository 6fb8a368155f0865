#include "vigia/evaluation/drive_bound.hpp"

#include "true_association.hpp"

#include <algorithm>

#include "vigia/localization/flow_fed_localizer.hpp"
#include "vigia/localization/motion_fusion.hpp"

namespace vigia::evaluation {
namespace {

std::optional<localization::CeilingFilter> ceiling_bound(const EstimatorSetup& setup) {
  if (!setup.ceiling) return std::nullopt;
  localization::CeilingFilterParams params = setup.ceiling->params;
  params.odometry = setup.odometry;
  localization::CeilingFilter bound(setup.ceiling->camera, setup.ceiling->grid, params);
  bound.reset({}, {{}, setup.prior_covariance});
  return bound;
}

std::optional<localization::CornerFilter> corner_bound(const EstimatorSetup& setup) {
  if (!setup.corners || !setup.field) return std::nullopt;
  localization::CornerFilterParams exact = *setup.corners;
  exact.odometry = setup.odometry;
  exact.gate = 1e12;  // of a corner its covariance counts, not where it is
  exact.iterations = 1;
  localization::CornerFilter bound(*setup.field, exact);
  bound.reset({}, {{}, setup.prior_covariance});
  return bound;
}

}  // namespace

DriveBound::DriveBound(const EstimatorSetup& setup)
    : setup_(setup),
      states_{PosteriorBound(setup.prior_covariance, setup.on_ground, setup.sensor),
              ceiling_bound(setup), corner_bound(setup)} {
  if (setup_.field) field_.emplace(*setup_.field);
}

void DriveBound::States::move(const Move& move, const OdometryNoise& odometry) {
  move_looks_and_corners(move, odometry);
  if (!ceiling) return;
  ceiling->place({move.before, {}, {}});
  ceiling->predict(move.u);
}

void DriveBound::States::move_looks_and_corners(const Move& move, const OdometryNoise& odometry) {
  looks.predict(move.before, move.u, control_covariance(move.u, odometry));
  if (corners) {
    corners->relinearise(move.before);
    corners->predict(move.u);
  }
}

Eigen::Matrix3d DriveBound::States::covariance() const {
  if (by_landmarks) return looks.covariance();
  if (corners) return corners->belief().covariance;
  return ceiling ? ceiling->belief().covariance : looks.covariance();
}

void DriveBound::move(const Pose2& before, const OdometryIncrement& u) {
  const Move move{before, u};
  if (setup_.ceiling && setup_.ceiling->flow)
    waiting_.push_back(move);
  else
    states_.move(move, setup_.odometry);
}

void DriveBound::pass_until(Stamp stamp) {
  const auto later = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const Move& move) { return stamp < move.u.to; });
  for (auto move = waiting_.begin(); move != later; ++move) states_.move(*move, setup_.odometry);
  waiting_.erase(waiting_.begin(), later);
}

/// The motions between the flow's frames as one, by odometry and flow.
void DriveBound::follow(const FlowObservation& flow) {
  pass_until(flow.from);
  std::vector<OdometryIncrement> parts;
  for (const Move& move : waiting_)
    if (move.u.to <= flow.shot.stamp) parts.push_back(move.u);
  if (parts.empty() || parts.front().from != flow.from) return;
  Move whole{waiting_.front().before, localization::joined(parts)};
  ImageShift shift = localization::seen_shift(setup_.ceiling->camera, vigia::move({}, whole.u));
  shift.covariance = flow.shift.covariance;
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(parts.size()));
  localization::CeilingFilterParams params = setup_.ceiling->params;
  params.odometry = setup_.odometry;
  if (states_.ceiling) {
    states_.ceiling->place({whole.before, {}, {}});
    states_.ceiling->predict(whole.u, shift);
  }
  if (const auto refined =
          localization::joined_with_flow(parts, shift, setup_.ceiling->camera, params, trust_))
    whole.u = *refined;
  states_.move_looks_and_corners(whole, setup_.odometry);
}

void DriveBound::learn(const Observation& observation, const mission::ExposureTruth& truth) {
  if (const auto* flow = std::get_if<FlowObservation>(&observation)) {
    if (setup_.ceiling && setup_.ceiling->flow) follow(*flow);
    return;
  }
  pass_until(shot_of(observation).stamp);
  if (const auto* seen = std::get_if<FieldObservation>(&observation); seen && field_) {
    // Of the points as they truly lie: on the map's lines or by chance.
    states_.looks.update(
        field_->linearise(seen->scan.points, truth.pose, field_->params().clutter).complete);
    return;
  }
  if (const auto* seen = std::get_if<PatchesObservation>(&observation); seen && states_.ceiling) {
    states_.ceiling->inform({truth.pose, {}, {}}, seen->patches);
    return;
  }
  if (const auto* seen = std::get_if<StereoObservation>(&observation); seen && states_.corners) {
    states_.corners->relinearise(truth.pose);
    states_.corners->update(seen->corners);
    return;
  }
  const Landmark* landmark =
      true_landmark(observation, setup_.landmarks, setup_.on_ground, truth.pose, truth.bias);
  if (landmark == nullptr) return;
  states_.by_landmarks = true;
  states_.looks.update(truth.pose, truth.bias, *landmark, observation);
}

Eigen::Matrix3d DriveBound::covariance() const {
  if (waiting_.empty()) return states_.covariance();
  States ahead = states_;
  for (const Move& move : waiting_) ahead.move(move, setup_.odometry);
  return ahead.covariance();
}

}  // namespace vigia::evaluation
