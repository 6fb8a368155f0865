#include "vigia/core/field_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

constexpr double kSamePlace_m = 1e-3;

/// The angle of @p p about the arc's centre, past its beginning, in [0, 2π).
double angle_along(const FieldLine& arc, const Eigen::Vector2d& p) {
  const Eigen::Vector2d out = p - arc.centre;
  const double past = std::atan2(out.y(), out.x()) - arc.from;
  return past - 2.0 * kPi * std::floor(past / (2.0 * kPi));
}

LineOffset segment_offset(const FieldLine& line, const Eigen::Vector2d& p) {
  const Eigen::Vector2d ab = line.b - line.a;
  const double length = ab.norm();
  const Eigen::Vector2d along = ab / length;
  const Eigen::Vector2d from_a = p - line.a;
  const double s = along.dot(from_a);
  LineOffset offset;
  offset.normal = {-along.y(), along.x()};
  offset.distance_m = offset.normal.dot(from_a);
  offset.inside_m = std::min(s, length - s);
  return offset;
}

LineOffset arc_offset(const FieldLine& line, const Eigen::Vector2d& p) {
  const Eigen::Vector2d out = p - line.centre;
  const double r = out.norm();
  LineOffset offset;
  if (r > 0.0) offset.normal = out / r;
  offset.distance_m = r - line.radius_m;
  offset.inside_m = std::numeric_limits<double>::infinity();
  if (line.closed()) return offset;
  const double past = angle_along(line, p);
  offset.inside_m = past <= line.sweep
                        ? line.radius_m * std::min(past, line.sweep - past)
                        : -line.radius_m * std::min(past - line.sweep, 2.0 * kPi - past);
  return offset;
}

FieldLine half_turned(FieldLine line) {
  line.a = -line.a;
  line.b = -line.b;
  line.centre = -line.centre;
  line.from += kPi;
  return line;
}

/// Whether two lines cover the same floor.
bool same_place(const FieldLine& one, const FieldLine& other) {
  if (one.kind != other.kind || std::abs(one.length_m() - other.length_m()) > kSamePlace_m)
    return false;
  constexpr int kProbes = 4;
  for (int i = 0; i <= kProbes; ++i)
    if (distance_to_line(other, one.at(one.length_m() * i / kProbes)) > kSamePlace_m) return false;
  return true;
}

bool same_goal(const FieldGoal& one, const FieldGoal& other) {
  const auto near = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return (p - q).norm() < kSamePlace_m;
  };
  return one.colour == other.colour && ((near(one.from, other.from) && near(one.to, other.to)) ||
                                        (near(one.from, other.to) && near(one.to, other.from)));
}

FieldGoal half_turned(FieldGoal goal) {
  goal.from = -goal.from;
  goal.to = -goal.to;
  return goal;
}

bool lines_symmetric(const FieldMap& map) {
  return std::all_of(map.lines.begin(), map.lines.end(), [&](const FieldLine& line) {
    const FieldLine turned = half_turned(line);
    return std::any_of(map.lines.begin(), map.lines.end(),
                       [&](const FieldLine& other) { return same_place(turned, other); });
  });
}

bool solids_symmetric(const FieldMap& map) {
  const bool goals = std::all_of(map.goals.begin(), map.goals.end(), [&](const FieldGoal& goal) {
    const FieldGoal turned = half_turned(goal);
    return std::any_of(map.goals.begin(), map.goals.end(),
                       [&](const FieldGoal& other) { return same_goal(turned, other); });
  });
  return goals && std::all_of(map.posts.begin(), map.posts.end(), [&](const CornerPost& post) {
           return std::any_of(map.posts.begin(), map.posts.end(), [&](const CornerPost& other) {
             return other.outer == post.outer && (other.at + post.at).norm() < kSamePlace_m;
           });
         });
}

void cross_segment(const FieldLine& line, const Eigen::Vector2d& origin,
                   const Eigen::Vector2d& direction, double max_m, std::vector<LineCrossing>& out) {
  const auto crossing = cross_lines(origin, origin + direction, line.a, line.b);
  if (!crossing || crossing->along_ab < 0.0 || crossing->along_ab > 1.0) return;
  if (crossing->along_pq <= 0.0 || crossing->along_pq > max_m) return;
  out.push_back({crossing->along_pq, segment_offset(line, line.a).normal});
}

void cross_arc(const FieldLine& line, const Eigen::Vector2d& origin,
               const Eigen::Vector2d& direction, double max_m, std::vector<LineCrossing>& out) {
  const Eigen::Vector2d from_centre = origin - line.centre;
  const double half = from_centre.dot(direction);
  const double square = half * half - from_centre.squaredNorm() + line.radius_m * line.radius_m;
  if (square <= 0.0) return;  // a ray that touches does not cross
  for (const double range : {-half - std::sqrt(square), -half + std::sqrt(square)}) {
    if (range <= 0.0 || range > max_m) continue;
    const LineOffset offset = arc_offset(line, origin + range * direction);
    if (offset.inside_m >= 0.0) out.push_back({range, offset.normal});
  }
}

}  // namespace

FieldLine FieldLine::segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width_m) {
  FieldLine line;
  line.width_m = width_m;
  line.a = a;
  line.b = b;
  return line;
}

FieldLine FieldLine::arc(const Eigen::Vector2d& centre, double radius_m, double from, double sweep,
                         double width_m) {
  FieldLine line;
  line.kind = Kind::arc;
  line.width_m = width_m;
  line.centre = centre;
  line.radius_m = radius_m;
  line.from = from;
  line.sweep = sweep;
  return line;
}

double FieldLine::length_m() const {
  return kind == Kind::segment ? (b - a).norm() : radius_m * sweep;
}

Eigen::Vector2d FieldLine::at(double s) const {
  if (kind == Kind::segment) return a + s * (b - a).normalized();
  return centre + radius_m * unit_vector(from + s / radius_m);
}

bool FieldLine::closed() const {
  return kind == Kind::arc && sweep >= 2.0 * kPi - 1e-9;
}

LineOffset line_offset(const FieldLine& line, const Eigen::Vector2d& p) {
  return line.kind == FieldLine::Kind::segment ? segment_offset(line, p) : arc_offset(line, p);
}

double distance_to_line(const FieldLine& line, const Eigen::Vector2d& p) {
  const LineOffset offset = line_offset(line, p);
  if (offset.inside_m >= 0.0) return std::abs(offset.distance_m);
  return std::min((p - line.at(0.0)).norm(), (p - line.at(line.length_m())).norm());
}

void cross_line(const FieldLine& line, const Eigen::Vector2d& origin,
                const Eigen::Vector2d& direction, double max_m, std::vector<LineCrossing>& out) {
  if (line.kind == FieldLine::Kind::segment)
    cross_segment(line, origin, direction, max_m, out);
  else
    cross_arc(line, origin, direction, max_m, out);
}

std::string_view to_string(FieldColour colour) {
  switch (colour) {
    case FieldColour::white:
      return "white";
    case FieldColour::yellow:
      return "yellow";
    case FieldColour::blue:
      return "blue";
  }
  return "";
}

bool FieldMap::half_turn_symmetric(bool with_goals) const {
  return lines_symmetric(*this) && (!with_goals || solids_symmetric(*this));
}

bool FieldMap::contains(const Eigen::Vector2d& p, double beyond_m) const {
  return std::abs(p.x()) <= 0.5 * length_m + beyond_m &&
         std::abs(p.y()) <= 0.5 * width_m + beyond_m;
}

const FieldGoal* FieldMap::goal(FieldColour colour) const {
  const auto found = std::find_if(goals.begin(), goals.end(),
                                  [&](const FieldGoal& goal) { return goal.colour == colour; });
  return found == goals.end() ? nullptr : &*found;
}

FieldDistance::FieldDistance(const FieldMap& map, double reach_m, double cell_m)
    : lines_(map.lines), reach_m_(reach_m), cell_m_(cell_m) {
  const double beyond = map.margin_m + reach_m;
  const Eigen::Vector2d half(0.5 * map.length_m + beyond, 0.5 * map.width_m + beyond);
  corner_ = -half;
  columns_ = static_cast<int>(std::ceil(2.0 * half.x() / cell_m));
  rows_ = static_cast<int>(std::ceil(2.0 * half.y() / cell_m));
  const double listed = reach_m + cell_m * std::sqrt(0.5);
  first_.push_back(0);
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const Eigen::Vector2d middle = corner_ + cell_m * Eigen::Vector2d(column + 0.5, row + 0.5);
      for (std::size_t i = 0; i < lines_.size(); ++i)
        if (distance_to_line(lines_[i], middle) <= listed)
          candidates_.push_back(static_cast<std::uint16_t>(i));
      first_.push_back(static_cast<std::uint32_t>(candidates_.size()));
    }
}

FieldDistance::Candidates FieldDistance::near(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d at = (p - corner_) / cell_m_;
  if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < columns_ && at.y() < rows_))
    return {candidates_.data(), candidates_.data()};
  const int index = static_cast<int>(at.y()) * columns_ + static_cast<int>(at.x());
  const auto cell = static_cast<std::size_t>(index);
  return {candidates_.data() + first_[cell], candidates_.data() + first_[cell + 1]};
}

double FieldDistance::distance(const Eigen::Vector2d& p) const {
  double nearest = reach_m_;
  for (const std::uint16_t i : near(p)) nearest = std::min(nearest, distance_to_line(lines_[i], p));
  return nearest;
}

}  // namespace vigia
