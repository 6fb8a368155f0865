#include "vigia/localization/ceiling_localizer.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "vigia/localization/motion_fusion.hpp"

namespace vigia::localization {
namespace {

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
  const Stamp oldest = increment.to - history();
  while (steps_.front().increment.to < oldest) steps_.pop_front();
  filter_.predict(increment);
  refresh_belief();
}

UpdateResult CeilingLocalizer::update(const Observation& observation) {
  const auto* seen = std::get_if<PatchesObservation>(&observation);
  const auto* flow = std::get_if<FlowObservation>(&observation);
  UpdateResult result;
  if (seen == nullptr && (flow == nullptr || !uses_flow_)) return result;
  result.status = UpdateStatus::no_prior;
  if (!has_prior_) return result;
  result = seen != nullptr ? fuse(*seen) : follow(*flow);
  refresh_belief();
  return result;
}

UpdateResult CeilingLocalizer::fuse(const PatchesObservation& seen) {
  const Stamp exposed = seen.shot.stamp;
  const auto after = std::find_if(steps_.begin(), steps_.end(),
                                  [&](const Step& step) { return exposed < step.increment.to; });
  UpdateResult result;
  result.status = UpdateStatus::too_late;
  if (after != steps_.end() && exposed < after->increment.from) return result;
  CeilingFilter filter = after == steps_.end() ? filter_ : after->before;
  const CeilingUpdate update = filter.update(seen.patches);
  repeat(after, std::move(filter));
  result.status = status_of(update, filter_.belief());
  return result;
}

UpdateResult CeilingLocalizer::follow(const FlowObservation& flow) {
  const auto first = std::find_if(steps_.begin(), steps_.end(), [&](const Step& step) {
    return step.increment.from == flow.from;
  });
  const auto last = std::find_if(
      first, steps_.end(), [&](const Step& step) { return step.increment.to == flow.shot.stamp; });
  UpdateResult result;
  result.status = UpdateStatus::too_late;
  result.dof = 3;
  if (last == steps_.end()) return result;
  std::vector<OdometryIncrement> parts;
  for (auto step = first; step != std::next(last); ++step) parts.push_back(step->increment);
  *first = {first->before, joined(parts), flow.shift};
  const auto begin = std::prev(steps_.erase(std::next(first), std::next(last)));
  const bool agreed = repeat(begin, begin->before);
  result.status = agreed ? UpdateStatus::fused : UpdateStatus::gated;
  return result;
}

/// The steps from one on, begun with @p filter, anew; whether the flow of the first was believed.
bool CeilingLocalizer::repeat(const Steps::iterator& from, CeilingFilter filter) {
  bool believed = false;
  for (auto step = from; step != steps_.end(); ++step) {
    step->before = filter;
    const bool agreed = step->flow && filter.predict(step->increment, *step->flow);
    if (!step->flow) filter.predict(step->increment);
    if (step == from) believed = agreed;
  }
  filter_ = std::move(filter);
  return believed;
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
