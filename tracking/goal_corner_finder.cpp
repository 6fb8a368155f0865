#include "vigia/tracking/goal_corner_finder.hpp"

#include "upright_edge.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vigia/core/median.hpp"

namespace vigia::tracking {
namespace {

using imaging::Window;

constexpr int kLeastRun = 2;        // pixels of a colour beside a transition
constexpr int kRowGap = 2;          // rows that an edge may miss in a row
constexpr double kStandsOut = 1.6;  // of an edge's rows over the next one's

FieldClass goal_class(FieldColour colour) {
  return colour == FieldColour::yellow ? FieldClass::yellow : FieldClass::blue;
}

/// The whole window's classes.
struct ClassWindow {
  Window window;
  std::vector<FieldClass> classes;

  FieldClass at(int u, int v) const {
    return classes[static_cast<std::size_t>(v - window.v) * static_cast<std::size_t>(window.width) +
                   static_cast<std::size_t>(u - window.u)];
  }
};

ClassWindow classes_of(const ColourWindow& picture, const FieldPalette& palette) {
  ClassWindow seen{picture.window, {}};
  seen.classes.reserve(picture.pixels.size());
  for (const vpRGBa& pixel : picture.pixels) seen.classes.push_back(palette(pixel));
  return seen;
}

/// How many pixels from @p u on, in the direction @p by, are of one class, at most @p most.
int run_of(const ClassWindow& seen, FieldClass of, int u, int v, int by, int most) {
  int run = 0;
  while (run < most && u >= seen.window.u && u < seen.window.right() && seen.at(u, v) == of) {
    u += by;
    ++run;
  }
  return run;
}

/// A run that ends before it need not: its last pixel may be mixed.
int pure_run(int run, int most) {
  return run < most ? std::max(kLeastRun, run - 1) : run;
}

/// Transitions between white and the goals' colours in a row.
void add_transitions(const ClassWindow& seen, int v, const GoalCornerParams& params,
                     std::vector<ColourTransition>& found) {
  for (int u = seen.window.u + 1; u + 1 < seen.window.right(); ++u) {
    const FieldClass here = seen.at(u, v);
    const bool white = here == FieldClass::white;
    if (!white && here != FieldClass::yellow && here != FieldClass::blue) continue;
    if (seen.at(u + 1, v) == here) continue;
    int next = u + 1;
    const auto mixed = [&](FieldClass of) {
      return of == FieldClass::other || of == FieldClass::green || of == FieldClass::black;
    };
    while (next < seen.window.right() && next - u - 1 < params.max_mixed && mixed(seen.at(next, v)))
      ++next;
    if (next >= seen.window.right()) continue;
    const FieldClass there = seen.at(next, v);
    const bool to_colour = white && (there == FieldClass::yellow || there == FieldClass::blue);
    const bool to_white = !white && there == FieldClass::white;
    if (!to_colour && !to_white) continue;
    const int left = run_of(seen, here, u, v, -1, params.side_px);
    const int right = run_of(seen, there, next, v, 1, params.side_px);
    if (left < kLeastRun || right < kLeastRun) continue;
    const FieldClass goal = to_colour ? there : here;
    found.push_back({v, u, next, pure_run(left, params.side_px), pure_run(right, params.side_px),
                     goal == FieldClass::yellow ? FieldColour::yellow : FieldColour::blue,
                     to_colour});
  }
}

using Group = std::vector<ColourTransition>;

bool continues(const Group& group, const ColourTransition& next, double max_step_px) {
  const ColourTransition& last = group.back();
  return last.colour == next.colour && last.colour_on_right == next.colour_on_right &&
         next.v > last.v && next.v - last.v <= kRowGap &&
         std::abs(next.middle() - last.middle()) <= max_step_px * (next.v - last.v);
}

/// Transitions of neighbouring rows, put together; each group without those that lie off its
/// median, and without its ends, where the wall's other edges mix in.
std::vector<Group> grouped(const std::vector<ColourTransition>& transitions,
                           const GoalCornerParams& params) {
  std::vector<Group> groups;
  for (const ColourTransition& next : transitions) {
    const auto open = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return continues(group, next, params.max_step_px);
    });
    if (open != groups.end())
      open->push_back(next);
    else
      groups.push_back({next});
  }
  std::vector<Group> kept;
  for (Group& group : groups) {
    if (static_cast<int>(group.size()) < params.min_rows + 2) continue;
    group.erase(group.begin());
    group.pop_back();
    std::vector<double> columns;
    for (const ColourTransition& row : group) columns.push_back(row.middle());
    const double middle = median_of(columns);
    const double reach = params.max_step_px + 0.1 * static_cast<double>(group.size());
    group.erase(std::remove_if(group.begin(), group.end(),
                               [&](const ColourTransition& row) {
                                 return std::abs(row.middle() - middle) > reach;
                               }),
                group.end());
    if (static_cast<int>(group.size()) >= params.min_rows) kept.push_back(std::move(group));
  }
  return kept;
}

std::vector<Group> edges_in(const ColourWindow& picture, const FieldPalette& palette,
                            const GoalCornerParams& params) {
  const ClassWindow seen = classes_of(picture, palette);
  std::vector<ColourTransition> transitions;
  for (int v = seen.window.v; v < seen.window.bottom(); ++v)
    add_transitions(seen, v, params, transitions);
  return grouped(transitions, params);
}

/// Samples of every few pixels of every few rows that are of one colour.
struct SampleGrid {
  int columns = 0;
  int rows = 0;
  std::vector<FieldClass> classes;

  FieldClass& at(int column, int row) {
    return classes[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
  }
};

/// The box of the samples that hang together with one, which are taken from the grid.
struct Patch {
  int low_column = 0;
  int high_column = 0;
  int low_row = 0;
  int high_row = 0;
  int samples = 0;
};

Patch take_patch(SampleGrid& grid, int column, int row) {
  const FieldClass colour = grid.at(column, row);
  Patch patch{column, column, row, row, 0};
  std::vector<std::pair<int, int>> open{{column, row}};
  grid.at(column, row) = FieldClass::other;
  while (!open.empty()) {
    const auto [c, r] = open.back();
    open.pop_back();
    ++patch.samples;
    patch.low_column = std::min(patch.low_column, c);
    patch.high_column = std::max(patch.high_column, c);
    patch.low_row = std::min(patch.low_row, r);
    patch.high_row = std::max(patch.high_row, r);
    for (int dr = -1; dr <= 1; ++dr) {
      for (int dc = -1; dc <= 1; ++dc) {
        const int nc = c + dc;
        const int nr = r + dr;
        if (nc < 0 || nr < 0 || nc >= grid.columns || nr >= grid.rows) continue;
        if (grid.at(nc, nr) != colour) continue;
        grid.at(nc, nr) = FieldClass::other;
        open.emplace_back(nc, nr);
      }
    }
  }
  return patch;
}

/// Windows that overlap become one.
std::vector<Window> united(std::vector<Window> windows) {
  for (std::size_t i = 0; i < windows.size(); ++i) {
    for (std::size_t j = i + 1; j < windows.size(); ++j) {
      if (intersect(windows[i], windows[j]).empty()) continue;
      windows[i] = unite(windows[i], windows[j]);
      windows.erase(windows.begin() + static_cast<std::ptrdiff_t>(j));
      j = i;
    }
  }
  return windows;
}

}  // namespace

/// Goals are painted in stronger colours than what a field of play has at large.
GoalCornerParams::GoalCornerParams() {
  colours.yellow = {from_deg(48.0), from_deg(16.0), 0.5, 60.0};
  colours.blue = {from_deg(223.0), from_deg(22.0), 0.55, 50.0};
  colours.white_min_value = 90.0;
  colours.white_max_saturation = 0.2;
  colours.black_max_value = 35.0;
}

GoalCornerFinder::GoalCornerFinder(const GoalCornerParams& params)
    : params_(params), palette_(params.colours) {}

std::vector<Window> GoalCornerFinder::patches(const imaging::Frame& frame) const {
  std::vector<imaging::Run> runs;
  for (int v = params_.first_row; v < frame.height(); v += params_.step_px)
    runs.push_back({v, 0, frame.width()});
  if (runs.empty()) return {};
  std::vector<vpRGBa> pixels(imaging::pixels_in(runs));
  frame.read_colour_runs(runs, pixels.data());
  SampleGrid grid{
      (frame.width() + params_.step_px - 1) / params_.step_px, static_cast<int>(runs.size()), {}};
  for (std::size_t row = 0; row < runs.size(); ++row)
    for (int u = 0; u < frame.width(); u += params_.step_px)
      grid.classes.push_back(palette_(
          pixels[row * static_cast<std::size_t>(frame.width()) + static_cast<std::size_t>(u)]));
  std::vector<Window> windows;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const FieldClass colour = grid.at(column, row);
      if (colour != goal_class(FieldColour::yellow) && colour != goal_class(FieldColour::blue))
        continue;
      const Patch patch = take_patch(grid, column, row);
      if (patch.samples < params_.min_patch) continue;
      const int step = params_.step_px;
      const int margin = params_.margin_px + step;
      const Window box{patch.low_column * step - margin,
                       params_.first_row + patch.low_row * step - step,
                       (patch.high_column - patch.low_column) * step + 2 * margin,
                       (patch.high_row - patch.low_row) * step + 2 * step + 1};
      windows.push_back(intersect(box, frame.full()));
    }
  }
  return united(std::move(windows));
}

GoalCornerScan GoalCornerFinder::find(const imaging::Frame& frame) const {
  GoalCornerScan scan;
  scan.windows = patches(frame);
  for (const Window& window : scan.windows) {
    const ColourWindow picture = read_colour_window(frame, window);
    for (const Group& group : edges_in(picture, palette_, params_)) {
      if (const auto corner = fit_upright_edge(picture, group, params_))
        scan.corners.push_back(*corner);
      else
        ++scan.rejected;
    }
  }
  return scan;
}

std::optional<GoalCornerImage> GoalCornerFinder::find_same(const imaging::Frame& right,
                                                           const GoalCornerImage& left,
                                                           const DisparityRange& range) const {
  const int reach = params_.side_px + params_.max_mixed;
  const int from = static_cast<int>(std::floor(left.u - range.max_px)) - reach;
  const int to = static_cast<int>(std::ceil(left.u - range.min_px)) + reach;
  const Window window =
      intersect({from, left.first_row - 3, to - from + 1, left.rows + 6}, right.full());
  if (window.empty()) return std::nullopt;
  const ColourWindow picture = read_colour_window(right, window);
  std::vector<GoalCornerImage> same;
  for (const Group& group : edges_in(picture, palette_, params_)) {
    if (group.front().colour != left.colour ||
        group.front().colour_on_right != left.colour_on_right)
      continue;
    const auto corner = fit_upright_edge(picture, group, params_);
    if (!corner) continue;
    const double disparity = left.u - corner->u;
    if (disparity >= range.min_px && disparity <= range.max_px) same.push_back(*corner);
  }
  std::sort(same.begin(), same.end(),
            [](const GoalCornerImage& a, const GoalCornerImage& b) { return a.rows > b.rows; });
  if (same.empty() || (same.size() > 1 && same[0].rows < kStandsOut * same[1].rows))
    return std::nullopt;
  return same.front();
}

}  // namespace vigia::tracking
