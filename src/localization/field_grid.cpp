#include "vigia/localization/field_grid.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

const ColourSighting* goal_of(const FieldScan& scan, FieldColour colour) {
  const auto found =
      std::find_if(scan.goals.begin(), scan.goals.end(),
                   [&](const ColourSighting& goal) { return goal.colour == colour; });
  return found == scan.goals.end() ? nullptr : &*found;
}

/// Direction in the world from the first goal's middle to the second's.
double axis_of(const FieldMap& map) {
  const Eigen::Vector2d axis =
      map.goal(FieldColour::blue)->centre() - map.goal(FieldColour::yellow)->centre();
  return std::atan2(axis.y(), axis.x());
}

std::vector<Eigen::Vector2d> turned_points(const FieldScan& scan, double heading) {
  // Eq. 3.
  const Eigen::Vector2d ahead = unit_vector(heading);
  std::vector<Eigen::Vector2d> turned;
  for (const FieldPoint& point : scan.points)
    turned.emplace_back(point.p_r.x() * ahead.x() - point.p_r.y() * ahead.y(),
                        point.p_r.x() * ahead.y() + point.p_r.y() * ahead.x());
  return turned;
}

/// Places of the robot that put the sighting on one of the goal's cells, dilated by @p dilated_m.
std::vector<Eigen::Vector2d> anchored_places(const FieldGoal& goal, const ColourSighting& seen,
                                             double heading, double dilated_m, double cell_m) {
  const Eigen::Vector2d mouth = goal.to - goal.from;
  const Eigen::Vector2d along = mouth.normalized();
  const Eigen::Vector2d back(-along.y(), along.x());
  const Eigen::Vector2d to_goal = seen.range_m * unit_vector(heading + seen.bearing);
  const auto steps = [&](double span) { return static_cast<int>(std::ceil(span / cell_m)); };
  std::vector<Eigen::Vector2d> places;
  for (int i = -steps(dilated_m); i <= steps(mouth.norm() + dilated_m); ++i)
    for (int j = -steps(dilated_m); j <= steps(goal.depth_m + dilated_m); ++j)
      places.push_back(goal.from + cell_m * (i * along + j * back) - to_goal);
  return places;
}

}  // namespace

double direction_by_proportion(const FieldMap& map, const ColourSighting& yellow,
                               const ColourSighting& blue, bool kind) {
  const double across = std::abs(blue.bearing - yellow.bearing);  // in the panorama
  const bool one_side = blue.bearing * yellow.bearing > 0.0;
  // The span between the goals in which the robot looks may be the one round the picture's back.
  const double total_dist = kind && one_side ? 2.0 * kPi - across : across;
  const bool yellow_nearer = std::abs(yellow.bearing) < std::abs(blue.bearing);
  const ColourSighting& nearest = yellow_nearer ? yellow : blue;
  // Eq. 2: direction = 180° goal_dist / total_dist.
  double direction = kPi * std::abs(nearest.bearing) / std::max(1e-3, total_dist);
  // A goal on the left means that the robot looks to the right of it.
  if (kind && nearest.bearing > 0.0) direction = -direction;
  const double to_goal = axis_of(map) + (yellow_nearer ? kPi : 0.0);
  return wrap_angle(to_goal + direction);
}

double direction_by_places(const FieldMap& map, const ColourSighting& yellow,
                           const ColourSighting& blue) {
  const Eigen::Vector2d axis_r =
      blue.range_m * unit_vector(blue.bearing) - yellow.range_m * unit_vector(yellow.bearing);
  return wrap_angle(axis_of(map) - std::atan2(axis_r.y(), axis_r.x()));
}

FieldGrid::FieldGrid(const FieldMap& map, const FieldGridParams& params)
    : map_(map), cell_m_(params.cell_m) {
  const Eigen::Vector2d half(0.5 * map.length_m + map.margin_m, 0.5 * map.width_m + map.margin_m);
  corner_ = -half;
  columns_ = static_cast<int>(std::ceil(2.0 * half.x() / cell_m_));
  rows_ = static_cast<int>(std::ceil(2.0 * half.y() / cell_m_));
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const Eigen::Vector2d middle = corner_ + cell_m_ * Eigen::Vector2d(column + 0.5, row + 0.5);
      line_.push_back(std::any_of(map.lines.begin(), map.lines.end(), [&](const FieldLine& line) {
        return distance_to_line(line, middle) <= 0.5 * line.width_m;
      }));
    }
}

int FieldGrid::count_on_lines(const std::vector<Eigen::Vector2d>& turned,
                              const Eigen::Vector2d& at) const {
  int count = 0;
  for (const Eigen::Vector2d& p : turned) {
    const Eigen::Vector2d cell = (at + p - corner_) / cell_m_;
    if (!(cell.x() >= 0.0 && cell.y() >= 0.0 && cell.x() < columns_ && cell.y() < rows_)) continue;
    const int index = static_cast<int>(cell.y()) * columns_ + static_cast<int>(cell.x());
    count += line_[static_cast<std::size_t>(index)];
  }
  return count;
}

FieldGridFix FieldGrid::best_of_anchors(const std::vector<Eigen::Vector2d>& turned,
                                        const std::vector<Eigen::Vector2d>& places, double heading,
                                        bool average) const {
  FieldGridFix best{FieldGridStatus::found, {0.0, 0.0, heading}, -1};
  std::vector<int> counts;
  std::size_t first = 0;
  for (const Eigen::Vector2d& place : places) {
    counts.push_back(count_on_lines(turned, place));
    if (counts.back() <= best.on_lines) continue;
    best.on_lines = counts.back();
    first = counts.size() - 1;
  }
  Eigen::Vector2d at = places[first];
  if (average) {
    // The counts about the best place are a hill whose top is flat and ragged: its middle.
    constexpr double kHill_m = 0.25;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weights = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if ((places[i] - places[first]).norm() > kHill_m) continue;
      const double above = counts[i] - 0.75 * best.on_lines;
      if (above <= 0.0) continue;
      sum += above * above * places[i];
      weights += above * above;
    }
    at = sum / weights;
  }
  best.pose.x = at.x();
  best.pose.y = at.y();
  return best;
}

FieldGridFix FieldGrid::locate(const FieldScan& scan, FieldGridMethod method) const {
  FieldGridFix none;
  const ColourSighting* yellow = goal_of(scan, FieldColour::yellow);
  const ColourSighting* blue = goal_of(scan, FieldColour::blue);
  if (map_.goal(FieldColour::yellow) == nullptr || map_.goal(FieldColour::blue) == nullptr ||
      (yellow == nullptr && blue == nullptr))
    return none;
  none.status = FieldGridStatus::one_goal;
  if (yellow == nullptr || blue == nullptr) return none;
  none.status = FieldGridStatus::no_points;
  if (scan.points.empty()) return none;
  const bool corrected = method == FieldGridMethod::corrected;
  const double heading =
      corrected
          ? direction_by_places(map_, *yellow, *blue)
          : direction_by_proportion(map_, *yellow, *blue, method == FieldGridMethod::as_published);
  const ColourSighting& closest = yellow->range_m < blue->range_m ? *yellow : *blue;
  const double dilated_m = corrected ? 3.0 * closest.range_sigma_m : 0.0;
  return best_of_anchors(
      turned_points(scan, heading),
      anchored_places(*map_.goal(closest.colour), closest, heading, dilated_m, cell_m_), heading,
      corrected);
}

}  // namespace vigia::localization
