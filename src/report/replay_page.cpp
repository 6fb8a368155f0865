#include "vigia/report/replay_page.hpp"

#include "html_page.hpp"
#include "page_assets.hpp"
#include "replay_json.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace vigia::report {
namespace {

void check(const ReplayRun& run) {
  const std::size_t n = run.t_s.size();
  const auto fits = [n](std::size_t size) { return size == n || size == 0; };
  if (n == 0) throw std::invalid_argument("a replay has ticks");
  bool fit = run.truth.size() == n && fits(run.speed_mps.size()) && fits(run.pan.size()) &&
             fits(run.tilt.size()) && fits(run.zoom_mm.size()) && run.target.size() == n;
  for (const auto& [id, values] : run.suitability.landmarks)
    fit = fit && values.size() == run.suitability.t_s.size();
  for (const auto& localizer : run.localizers)
    fit = fit && localizer.beliefs.size() == n && localizer.bound_m.size() == n;
  for (const auto& camera : run.cameras)
    fit = fit && fits(camera.left.size()) && camera.right.size() == camera.left.size();
  if (!fit) throw std::invalid_argument("a replay's columns have as many rows as it has ticks");
}

std::string page_title(const std::vector<ReplayRun>& runs) {
  if (runs.size() == 1) return fmt::format("{}, seed {}", runs.front().name, runs.front().seed);
  const bool alike = std::all_of(runs.begin(), runs.end(), [&](const ReplayRun& run) {
    return run.name == runs.front().name;
  });
  return fmt::format("{} drives of {}", runs.size(),
                     alike ? runs.front().name : "different missions, on one map");
}

}  // namespace

std::string replay_page(const std::vector<ReplayRun>& runs, int max_ticks) {
  if (runs.empty()) throw std::invalid_argument("a replay page has a run");
  for (const auto& run : runs) check(run);
  const std::string title = page_title(runs);
  return html_page({title,
                    {assets::kPlotCss, assets::kReplayCss},
                    assets::kReplayHtml,
                    replay_json(runs, title, std::max(2, max_ticks)),
                    {assets::kPlotJs, assets::kReplayJs}});
}

}  // namespace vigia::report
