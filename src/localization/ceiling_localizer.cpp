#include "vigia/localization/ceiling_localizer.hpp"

#include <algorithm>
#include <utility>

namespace vigia::localization {
namespace {

constexpr double kCeilingHistory_s = 1.0;

UpdateStatus status_of(CeilingUpdate update, const Belief& belief) {
  switch (update) {
    case CeilingUpdate::none_seen:
      return UpdateStatus::degenerate;
    case CeilingUpdate::gated:
      return UpdateStatus::gated;
    case CeilingUpdate::fused:
      break;
  }
  return belief.status == BeliefStatus::ambiguous ? UpdateStatus::ambiguous : UpdateStatus::fused;
}

}  // namespace

void CeilingLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  steps_.clear();
  has_prior_ = prior.has_value();
  filter_.reset(stamp, prior.value_or(anywhere()));
  refresh_belief();
}

void CeilingLocalizer::predict(const OdometryIncrement& increment) {
  steps_.push_back({filter_, increment});
  const Stamp oldest = increment.to - Duration::from_seconds(kCeilingHistory_s);
  while (steps_.front().increment.to < oldest) steps_.pop_front();
  filter_.predict(increment);
  refresh_belief();
}

UpdateResult CeilingLocalizer::update(const Observation& observation) {
  const auto* seen = std::get_if<PatchesObservation>(&observation);
  UpdateResult result;
  if (seen == nullptr) return result;
  result.status = UpdateStatus::no_prior;
  if (!has_prior_) return result;
  const Stamp exposed = seen->shot.stamp;
  const auto after = std::find_if(steps_.begin(), steps_.end(),
                                  [&](const Step& step) { return exposed < step.increment.to; });
  result.status = UpdateStatus::too_late;
  if (after != steps_.end() && exposed < after->increment.from) return result;
  CeilingFilter filter = after == steps_.end() ? filter_ : after->before;
  const CeilingUpdate update = filter.update(seen->patches);
  for (auto step = after; step != steps_.end(); ++step) {
    step->before = filter;
    filter.predict(step->increment);
  }
  filter_ = std::move(filter);
  refresh_belief();
  result.status = status_of(update, belief_);
  return result;
}

void CeilingLocalizer::lose() {
  reset(filter_.belief().stamp, std::nullopt);
}

void CeilingLocalizer::refresh_belief() {
  belief_ = filter_.belief();
  if (has_prior_) return;
  belief_.status = BeliefStatus::lost;
  belief_.hypotheses.clear();
  belief_.lost_probability = 1.0;
}

}  // namespace vigia::localization
