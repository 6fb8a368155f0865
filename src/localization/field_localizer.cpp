#include "vigia/localization/field_localizer.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace vigia::localization {
namespace {

constexpr double kRemembered_s = 1.0;

/// A method of localization on fields, with the model that it refers to.
template <typename Method>
class FieldLocalizerOf final : public FieldLocalizer {
 public:
  template <typename... Args>
  FieldLocalizerOf(std::string_view name, const FieldMap& field, const Args&... args)
      : name_(name), model_(std::make_unique<const FieldModel>(field)), method_(*model_, args...) {}

  std::string_view name() const override { return name_; }
  const Belief& belief() const override { return method_.belief(); }

 private:
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

void FieldLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  places_.assign(1, {stamp, {}});
  start(stamp, prior);
}

void FieldLocalizer::predict(const OdometryIncrement& increment) {
  places_.push_back({increment.to, move(places_.back().oMr, increment)});
  const Stamp oldest = increment.to - Duration::from_seconds(kRemembered_s);
  while (places_.front().stamp < oldest) places_.pop_front();
  move_by(increment);
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
  const Pose2 now_from_then = compose(inverse(now.oMr), std::prev(after)->oMr);
  take(exposed < now.stamp ? carried(seen->scan, now_from_then, now.stamp) : seen->scan);
  result.status = UpdateStatus::fused;
  return result;
}

void FieldLocalizer::lose() {
  start(places_.back().stamp, std::nullopt);
}

std::unique_ptr<FieldLocalizer> make_field_tracker(const FieldMap& field,
                                                   const FieldTrackerParams& params) {
  return std::make_unique<FieldLocalizerOf<FieldTracker>>("field_grid", field, params);
}

std::unique_ptr<FieldLocalizer> make_mcl(const FieldMap& field, const MclParams& params,
                                         std::uint64_t seed) {
  return std::make_unique<FieldLocalizerOf<Mcl>>("mcl", field, params, seed);
}

std::unique_ptr<FieldLocalizer> make_murea(const FieldMap& field,
                                           const MureaLocalizerParams& params) {
  return std::make_unique<FieldLocalizerOf<MureaLocalizer>>("murea", field, params);
}

}  // namespace vigia::localization
