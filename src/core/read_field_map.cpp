#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "vigia/core/angle.hpp"
#include "vigia/core/field_map.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

constexpr Range kOnField{-100.0, 100.0};
constexpr double kShortestLine_m = 0.05;
constexpr double kOnLine_m = 1e-3;
constexpr std::size_t kMostLines = 1000;
const std::vector<std::string> kColours{"white", "yellow", "blue"};

void check_on_field(const FieldMap& map, const Eigen::Vector2d& p, double beyond_m,
                    const MapReader& reader, const std::string& key) {
  if (map.contains(p, map.margin_m + beyond_m)) return;
  throw reader.error(key, "it lies outside the field and its margin");
}

/// How far two straight lines run on one another: painted floor that would count twice.
double length_on(const FieldLine& one, const FieldLine& other) {
  if (one.kind != FieldLine::Kind::segment || other.kind != FieldLine::Kind::segment) return 0.0;
  const double length = one.length_m();
  const Eigen::Vector2d along = (one.b - one.a) / length;
  if (std::abs(cross(along, other.a - one.a)) > kOnLine_m ||
      std::abs(cross(along, other.b - one.a)) > kOnLine_m)
    return 0.0;
  const double from = along.dot(other.a - one.a);
  const double to = along.dot(other.b - one.a);
  return std::min(std::max(from, to), length) - std::max(std::min(from, to), 0.0);
}

void add_line(FieldMap& map, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m,
              const MapReader& reader) {
  if ((to - from).norm() < kShortestLine_m)
    throw reader.error("points_m", "two points in a row lie less than 0.05 m apart");
  check_on_field(map, from, 0.0, reader, "points_m");
  check_on_field(map, to, 0.0, reader, "points_m");
  const FieldLine line = FieldLine::segment(from, to, width_m);
  for (const FieldLine& earlier : map.lines)
    if (length_on(line, earlier) > kOnLine_m)
      throw reader.error("points_m", "a piece of it runs on an earlier line");
  map.lines.push_back(line);
}

void read_line(MapReader reader, double width_m, FieldMap& map) {
  const std::vector<Eigen::Vector2d> points = reader.points2("points_m", kOnField, 2);
  const bool closed = reader.boolean("closed", false);
  reader.finish();
  if (map.lines.size() + points.size() > kMostLines)
    throw reader.error("points_m",
                       "a field has at most " + std::to_string(kMostLines) + " pieces of line");
  for (std::size_t i = 1; i < points.size(); ++i)
    add_line(map, points[i - 1], points[i], width_m, reader);
  if (closed) add_line(map, points.back(), points.front(), width_m, reader);
}

void read_arc(MapReader reader, double width_m, FieldMap& map) {
  const Eigen::Vector2d centre = reader.vector2("centre_m", kOnField);
  const double radius = reader.number("radius_m", {0.1, 50.0});
  const double from = from_deg(reader.number("from_deg", {-360.0, 360.0}, 0.0));
  const double sweep = from_deg(reader.number("sweep_deg", {1.0, 360.0}, 360.0));
  reader.finish();
  if (map.lines.size() >= kMostLines)
    throw reader.error("radius_m",
                       "a field has at most " + std::to_string(kMostLines) + " pieces of line");
  const FieldLine line = FieldLine::arc(centre, radius, from, sweep, width_m);
  constexpr int kProbes = 16;
  for (int i = 0; i <= kProbes; ++i)
    check_on_field(map, line.at(line.length_m() * i / kProbes), 0.0, reader, "radius_m");
  map.lines.push_back(line);
}

FieldGoal read_goal(MapReader reader, const FieldMap& map) {
  FieldGoal goal;
  goal.colour = static_cast<FieldColour>(reader.choice("colour", kColours));
  goal.from = reader.vector2("from_m", kOnField);
  goal.to = reader.vector2("to_m", kOnField);
  goal.depth_m = reader.number("depth_m", {0.05, 5.0}, goal.depth_m);
  goal.height_m = reader.number("height_m", {0.1, 5.0}, goal.height_m);
  reader.finish();
  if ((goal.to - goal.from).norm() < 0.2)
    throw reader.error("to_m", "the goal's mouth must be at least 0.2 m wide");
  check_on_field(map, goal.from, 0.0, reader, "from_m");
  check_on_field(map, goal.to, 0.0, reader, "to_m");
  return goal;
}

CornerPost read_post(MapReader reader, const FieldMap& map) {
  CornerPost post;
  post.at = reader.vector2("at_m", kOnField);
  post.outer = static_cast<FieldColour>(1 + reader.choice("outer", {"yellow", "blue"}));
  post.radius_m = reader.number("radius_m", {0.01, 1.0}, post.radius_m);
  post.height_m = reader.number("height_m", {0.1, 5.0}, post.height_m);
  reader.finish();
  check_on_field(map, post.at, 0.0, reader, "at_m");
  return post;
}

}  // namespace

FieldMap read_field_map(MapReader reader) {
  FieldMap map;
  map.length_m = reader.number("length_m", {2.0, 60.0});
  map.width_m = reader.number("width_m", {2.0, 60.0});
  map.margin_m = reader.number("margin_m", {0.0, 10.0}, map.margin_m);
  const double width = reader.number("line_width_m", {0.01, 0.5}, 0.125);
  for (const MapReader& line : reader.maps("lines")) read_line(line, width, map);
  for (const MapReader& arc : reader.maps("arcs")) read_arc(arc, width, map);
  for (const MapReader& goal : reader.maps("goals")) map.goals.push_back(read_goal(goal, map));
  for (const MapReader& post : reader.maps("posts")) map.posts.push_back(read_post(post, map));
  reader.finish();
  if (map.lines.empty()) throw reader.error("lines", "a field needs at least one line or arc");
  return map;
}

}  // namespace vigia
