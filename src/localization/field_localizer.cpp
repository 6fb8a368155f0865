#include "vigia/localization/field_localizer.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace vigia::localization {
namespace {

/// A method of localization on fields, with the model that it refers to.
template <typename Method>
class FieldLocalizerOf final : public FieldLocalizer {
 public:
  template <typename Params, typename... Args>
  FieldLocalizerOf(std::string_view name, const FieldMap& field,
                   const std::optional<MirrorOfRig>& mirror, const Params& params,
                   const Args&... args)
      : name_(name),
        model_(std::make_unique<const FieldModel>(field)),
        method_(*model_, params, args...) {
    if (mirror) calibrate(*model_, *mirror, params.odometry);
  }

  std::string_view name() const override { return name_; }

 private:
  const Belief& own_belief() const override { return method_.belief(); }
  void start(Stamp stamp, const std::optional<Prior>& prior) override {
    method_.reset(stamp, prior);
  }
  void move_by(const OdometryIncrement& increment) override { method_.predict(increment); }
  void take(const FieldScan& scan) override { method_.update(scan); }

  std::string_view name_;
  std::unique_ptr<const FieldModel> model_;
  Method method_;
};

}  // namespace

void FieldLocalizer::calibrate(const FieldModel& model, const MirrorOfRig& mirror,
                               const OdometryNoise& odometry) {
  mirror_ = mirror;
  calibration_.emplace(model, mirror.errors, odometry);
}

void FieldLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  places_.assign(1, {stamp, {}});
  start(stamp, prior);
  if (calibration_) calibration_->lose_place();
  refresh();
}

void FieldLocalizer::predict(const OdometryIncrement& increment) {
  places_.push_back({increment.to, move(places_.back().oMr, increment)});
  const Stamp oldest = increment.to - history();
  while (places_.front().stamp < oldest) places_.pop_front();
  move_by(increment);
  if (calibration_) calibration_->predict(increment);
  refresh();
}

UpdateResult FieldLocalizer::update(const Observation& observation) {
  const auto* seen = std::get_if<FieldObservation>(&observation);
  if (seen == nullptr) return {};
  UpdateResult result;
  result.status = UpdateStatus::degenerate;
  if (seen->scan.points.empty()) return result;
  const Place& now = places_.back();
  const Stamp exposed = seen->scan.stamp;
  result.status = UpdateStatus::too_late;
  if (exposed < places_.front().stamp) return result;
  // The last place at or before the exposure: exposures are in ticks.
  const auto after = std::find_if(places_.begin(), places_.end(),
                                  [&](const Place& place) { return exposed < place.stamp; });
  process(*seen, compose(inverse(now.oMr), std::prev(after)->oMr));
  refresh();
  result.status = UpdateStatus::fused;
  return result;
}

/// Takes the scan as the robot would have made it now.
void FieldLocalizer::process(const FieldObservation& seen, const Pose2& now_from_then) {
  const Stamp now = places_.back().stamp;
  const bool late = seen.scan.stamp < now;
  const auto* mirror = std::get_if<UnifiedOmni>(&seen.shot.model);
  if (!calibration_ || mirror == nullptr) {
    take(late ? carried(seen.scan, now_from_then, now) : seen.scan);
    return;
  }
  const MirrorOnRobot camera{*mirror, mirror_->rig.at(seen.shot.camera).rMc(seen.shot.head)};
  CorrectedScan scan = calibration_->corrected(seen.scan, camera);
  if (late) scan = carried(scan, now_from_then, now);
  take(scan.scan);
  calibration_->update(scan, own_belief());
}

void FieldLocalizer::lose() {
  start(places_.back().stamp, std::nullopt);
  if (calibration_) calibration_->lose_place();
  refresh();
}

/// The belief, and what is not known of the mirror.
void FieldLocalizer::refresh() {
  belief_ = own_belief();
  if (!calibration_) return;
  belief_.covariance += calibration_->widening();
  for (PoseHypothesis& hypothesis : belief_.hypotheses)
    hypothesis.covariance += calibration_->widening();
}

std::unique_ptr<FieldLocalizer> make_field_tracker(const FieldMap& field,
                                                   const FieldTrackerParams& params,
                                                   const std::optional<MirrorOfRig>& mirror) {
  return std::make_unique<FieldLocalizerOf<FieldTracker>>("field_grid", field, mirror, params);
}

std::unique_ptr<FieldLocalizer> make_mcl(const FieldMap& field, const MclParams& params,
                                         std::uint64_t seed,
                                         const std::optional<MirrorOfRig>& mirror) {
  return std::make_unique<FieldLocalizerOf<Mcl>>("mcl", field, mirror, params, seed);
}

std::unique_ptr<FieldLocalizer> make_murea(const FieldMap& field,
                                           const MureaLocalizerParams& params,
                                           const std::optional<MirrorOfRig>& mirror) {
  return std::make_unique<FieldLocalizerOf<MureaLocalizer>>("murea", field, mirror, params);
}

}  // namespace vigia::localization
