#include "colour_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vigia::tracking {
namespace {

/// A run of one colour on a ray.
struct ColourRun {
  FieldClass colour = FieldClass::other;
  int begin = 0;
  int end = 0;
  int length() const { return end - begin; }
};

bool is_goal_colour(FieldClass of) {
  return of == FieldClass::yellow || of == FieldClass::blue;
}

/// Runs of yellow and blue of the least length; a single sample of another class, as noise makes
/// it, does not end one.
std::vector<ColourRun> colour_runs(const PlannedRay& ray, const RaySamples& samples, int least) {
  const FieldClass* classes = samples.classes.data() + ray.first;
  std::vector<ColourRun> runs;
  for (int i = 0; i < ray.count; ++i) {
    if (!is_goal_colour(classes[i])) continue;
    ColourRun run{classes[i], i, i + 1};
    for (int k = i + 1; k < ray.count && k - run.end <= 1; ++k)
      if (classes[k] == run.colour) run.end = k + 1;
    if (run.length() >= least) runs.push_back(run);
    i = run.end - 1;
  }
  return runs;
}

/// Whether the field ends where the run begins: green or a line not far before it.
bool stands_on_field(const PlannedRay& ray, const RaySamples& samples, int begin) {
  constexpr double kReach = 8.0;  // px, of a shadow, a line's blur or a goal's white post
  const FieldClass* classes = samples.classes.data() + ray.first;
  const int reach = static_cast<int>(kReach / ray.step_px);
  int field = 0;
  for (int i = std::max(0, begin - reach); i < begin; ++i)
    field += classes[i] == FieldClass::green ? 1 : 0;
  return field >= 2;
}

/// What a ray says of coloured things: its nearest run, and whether the other colour follows it at
/// once, as on a corner post.
struct RayColour {
  ColourFoot foot;
  FieldColour colour = FieldColour::yellow;
  bool post = false;
};

FieldColour field_colour(FieldClass of) {
  return of == FieldClass::blue ? FieldColour::blue : FieldColour::yellow;
}

std::optional<RayColour> ray_colour(const PlannedRay& ray, int number, const RaySamples& samples,
                                    const RadialScanParams& params) {
  constexpr int kSeam = 3;  // samples of mixed colour between two bands
  const int least = std::max(1, static_cast<int>(std::lround(params.min_run_px / ray.step_px)));
  const int least_band = std::max(1, least / 2);
  const std::vector<ColourRun> runs = colour_runs(ray, samples, least_band);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!stands_on_field(ray, samples, runs[i].begin)) continue;
    const bool banded = i + 1 < runs.size() && runs[i + 1].colour != runs[i].colour &&
                        runs[i + 1].begin - runs[i].end <= kSeam;
    if (!banded && runs[i].length() < least) continue;
    RayColour found;
    found.foot.ray = number;
    // Between the last sample that is not of the colour and the first that is.
    found.foot.foot_px = ray.radius(runs[i].begin - 0.5);
    found.foot.sigma_px = std::hypot(ray.step_px / std::sqrt(12.0), params.blur_px);
    found.colour = field_colour(runs[i].colour);
    found.post = banded;
    return found;
  }
  return std::nullopt;
}

bool belong_together(const RayColour& a, const RayColour& b) {
  return a.post == b.post && a.colour == b.colour;
}

/// Groups neighbouring rays that meet the same thing, across at most one ray that does not.
std::vector<std::vector<RayColour>> colour_groups(
    const std::vector<std::optional<RayColour>>& rays) {
  constexpr int kGap = 2;
  std::vector<std::vector<RayColour>> groups;
  for (const auto& found : rays) {
    if (!found) continue;
    if (!groups.empty() && found->foot.ray - groups.back().back().foot.ray <= kGap &&
        belong_together(groups.back().back(), *found))
      groups.back().push_back(*found);
    else
      groups.push_back({*found});
  }
  // Across ray 0.
  const int count = static_cast<int>(rays.size());
  if (groups.size() > 1 &&
      groups.front().front().foot.ray + count - groups.back().back().foot.ray <= kGap &&
      belong_together(groups.front().front(), groups.back().back())) {
    groups.back().insert(groups.back().end(), groups.front().begin(), groups.front().end());
    groups.erase(groups.begin());
  }
  return groups;
}

/// A group's rims lie between its last ray and the next that does not meet it.
ColourSpan span_of(const std::vector<RayColour>& group, int rays) {
  const double step = 2.0 * kPi / rays;
  ColourSpan span;
  span.colour = group.front().colour;
  for (const RayColour& found : group) span.feet.push_back(found.foot);
  span.first_angle = (group.front().foot.ray - 0.5) * step;
  span.last_angle = (group.back().foot.ray + 0.5) * step;
  if (span.last_angle < span.first_angle) span.last_angle += 2.0 * kPi;
  span.angle_sigma = step / std::sqrt(12.0);
  return span;
}

}  // namespace

ColourSearchResult search_colours(const RadialPlan& plan, const RaySamples& samples,
                                  const RadialScanParams& params) {
  const int rays = static_cast<int>(plan.rays.size());
  std::vector<std::optional<RayColour>> found;
  found.reserve(plan.rays.size());
  for (int k = 0; k < rays; ++k)
    found.push_back(ray_colour(plan.rays[static_cast<std::size_t>(k)], k, samples, params));
  ColourSearchResult result;
  for (const auto& group : colour_groups(found))
    (group.front().post ? result.posts : result.goals).push_back(span_of(group, rays));
  return result;
}

}  // namespace vigia::tracking
