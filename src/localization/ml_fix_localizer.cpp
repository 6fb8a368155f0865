#include "vigia/localization/ml_fix_localizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vigia/localization/travelled.hpp"

namespace vigia::localization {
MlFixLocalizer::MlFixLocalizer(FieldMap field, const MlFixParams& params)
    : field_(std::move(field)), params_(params), filter_(field_, params.filter) {
  reset({}, std::nullopt);
}

void MlFixLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  steps_.clear();
  stamp_ = stamp;
  gated_ = 0;
  found_ = prior.has_value();
  filter_.reset(stamp, prior.value_or(anywhere()));
  chain_ = {};
  chain_.pair = params_.filter.pair;
  chain_.calibration_sigma = params_.filter.calibration_sigma;
  since_ = {};
  refresh_belief();
}

void MlFixLocalizer::predict(const OdometryIncrement& increment) {
  stamp_ = increment.to;
  if (found_) {
    steps_.push_back({filter_, increment});
    const Stamp oldest = increment.to - history();
    while (steps_.front().increment.to < oldest) steps_.pop_front();
  } else {
    travel(since_, increment, params_.filter.odometry);
  }
  filter_.predict(increment);
  refresh_belief();
}

UpdateResult MlFixLocalizer::update(const Observation& observation) {
  const auto* seen = std::get_if<StereoObservation>(&observation);
  if (seen == nullptr) return {};
  UpdateResult result = found_ ? track(*seen) : search(*seen);
  refresh_belief();
  return result;
}

/// Fused at its exposure; the odometry since then goes over it again.
UpdateResult MlFixLocalizer::track(const StereoObservation& seen) {
  UpdateResult result{UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  if (seen.corners.empty()) return result;
  const Stamp exposed = seen.shot.stamp;
  const auto after = std::find_if(steps_.begin(), steps_.end(),
                                  [&](const Step& step) { return exposed < step.increment.to; });
  result.status = UpdateStatus::too_late;
  if (after != steps_.end() && exposed < after->increment.from) return result;
  CornerFilter filter = after == steps_.end() ? filter_ : after->before;
  const CornerUpdate update = filter.update(seen.corners);
  for (auto step = after; step != steps_.end(); ++step) {
    step->before = filter;
    filter.predict(step->increment);
  }
  filter_ = std::move(filter);
  result.status = update.fused > 0 ? UpdateStatus::fused : UpdateStatus::gated;
  result.nis = update.nis;
  result.dof = 2 * update.fused;
  gated_ = update.fused > 0 ? 0 : gated_ + 1;
  if (gated_ >= params_.gated_to_lose) lose();
  return result;
}

/// One more link of the chain; once it determines a pose that is found.
UpdateResult MlFixLocalizer::search(const StereoObservation& seen) {
  UpdateResult result{UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  if (seen.corners.empty()) return result;
  result.status = UpdateStatus::too_late;
  if (seen.shot.stamp < stamp_) return result;
  for (const StereoCorner& corner : seen.corners) {
    const auto place = goal_corner_place(field_, corner.corner);
    const StereoColumns columns = ideal_columns(params_.filter, corner);
    if (!place || !(columns.left > columns.right)) continue;
    if (!chain_.sightings.empty()) chain_.motions.push_back(std::exchange(since_, {}));
    since_ = {};
    since_.frame = MotionFrame::body;
    chain_.landmarks.push_back({*place, Eigen::Matrix2d::Zero()});
    chain_.sightings.push_back(
        {chain_.landmarks.size() - 1, columns, std::sqrt(0.5 * corner.covariance.trace())});
  }
  while (static_cast<int>(chain_.sightings.size()) > params_.stations) {
    chain_.sightings.erase(chain_.sightings.begin());
    chain_.landmarks.erase(chain_.landmarks.begin());
    chain_.motions.erase(chain_.motions.begin());
    for (StereoSighting& sighting : chain_.sightings) --sighting.landmark;
  }
  const StationFix fix = station_fix(chain_);
  result.status = UpdateStatus::no_prior;
  if (fix.status == StationFixStatus::ambiguous) result.status = UpdateStatus::ambiguous;
  if (fix.status != StationFixStatus::found) return result;
  CornerFilter::Vector6 mean;
  mean << fix.hypotheses.front().pose.vector(), fix.calibration.vector();
  filter_.reset(stamp_, mean, fix.joint_covariance);
  found_ = true;
  steps_.clear();
  result.status = UpdateStatus::fused;
  return result;
}

void MlFixLocalizer::lose() {
  reset(stamp_, std::nullopt);
}

void MlFixLocalizer::refresh_belief() {
  belief_ = filter_.belief();
  belief_.stamp = stamp_;
  if (found_) return;
  belief_.status = BeliefStatus::lost;
  belief_.lost_probability = 1.0;
}

}  // namespace vigia::localization
