#include "vigia/report/replay_page.hpp"

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
  for (const auto& localizer : run.localizers)
    fit = fit && localizer.beliefs.size() == n && localizer.bound_m.size() == n;
  for (const auto& camera : run.cameras)
    fit = fit && fits(camera.left.size()) && camera.right.size() == camera.left.size();
  if (!fit) throw std::invalid_argument("a replay's columns have as many rows as it has ticks");
}

std::string page_title(const std::vector<ReplayRun>& runs) {
  if (runs.size() == 1) return fmt::format("{}, seed {}", runs.front().name, runs.front().seed);
  return fmt::format("{} drives of {}", runs.size(), runs.front().name);
}

/// As text of an HTML element.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

// No network, no other file: a page that is mailed reads nothing but itself.
constexpr std::string_view kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
)";

}  // namespace

std::string replay_page(const std::vector<ReplayRun>& runs, int max_ticks) {
  if (runs.empty()) throw std::invalid_argument("a replay page has a run");
  for (const auto& run : runs) check(run);
  const std::string title = page_title(runs);
  std::string page(kHead);
  page += fmt::format("<title>{}</title>\n<style>{}\n{}</style>\n</head>\n<body>\n{}",
                      escaped(title), assets::kPlotCss, assets::kPageCss, assets::kPageHtml);
  page += "<script type=\"application/json\" id=\"replay\">";
  page += replay_json(runs, title, std::max(2, max_ticks));
  page += "</script>\n<script>";
  page += assets::kPlotJs;
  page += "</script>\n<script>";
  page += assets::kPageJs;
  page += "</script>\n</body>\n</html>\n";
  return page;
}

}  // namespace vigia::report
