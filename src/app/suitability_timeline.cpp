#include "suitability_timeline.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/mission/planning_parts.hpp"
#include "vigia/planner/apparent_size.hpp"
#include "vigia/planner/fuzzy_supervisors.hpp"

namespace vigia::app {
namespace {

constexpr std::size_t kMostJudged = 20'000;  // a tenth of a second

/// The recorded ticks at which the landmarks are judged.
std::vector<std::size_t> judged_ticks(const std::vector<double>& t_s, std::size_t landmarks) {
  const double span_s = t_s.back() - t_s.front();
  const double most = static_cast<double>(std::max<std::size_t>(2, kMostJudged / landmarks));
  const double period_s = std::max(1.0 / kSuitability_hz, span_s / most);
  constexpr double kRounding_s = 1e-6;
  std::vector<std::size_t> ticks;
  double due_s = t_s.front();
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (t_s[i] < due_s - kRounding_s) continue;
    due_s = t_s[i] + period_s;
    ticks.push_back(i);
  }
  return ticks;
}

}  // namespace

report::ReplaySuitability suitability(const mission::MissionSetup& setup,
                                      const report::ReplayRun& run) {
  report::ReplaySuitability timeline;
  const auto& landmarks = setup.world.landmarks.all();
  const auto driving = std::find_if(run.localizers.begin(), run.localizers.end(),
                                    [](const auto& localizer) { return localizer.primary; });
  if (landmarks.empty() || run.t_s.empty() || driving == run.localizers.end()) return timeline;
  const planner::Visibility visibility = mission::visibility(setup);
  const planner::HeadModel head = mission::head_model(setup);
  planner::FuzzySupervisors supervisors(setup.look.rules);
  const auto ticks = judged_ticks(run.t_s, landmarks.size());
  for (const std::size_t i : ticks) timeline.t_s.push_back(run.t_s[i]);
  for (const Landmark& landmark : landmarks) {
    std::vector<double> values;
    for (const std::size_t i : ticks) {
      const Pose2& pose = driving->beliefs[i].pose;
      const bool seen = visibility.sight(landmark, pose) == planner::Sight::visible;
      const double range_m = visibility.range(landmark, pose);
      values.push_back(seen ? supervisors.suitability(
                                  landmark, range_m, visibility.view_angle(landmark, pose),
                                  head.zoom.at(planner::zoom_for(landmark, range_m, head)).px)
                            : NAN);
    }
    const auto known = [](double value) { return std::isfinite(value); };
    if (std::any_of(values.begin(), values.end(), known))
      timeline.landmarks.emplace_back(landmark.id, std::move(values));
  }
  return timeline;
}

}  // namespace vigia::app
