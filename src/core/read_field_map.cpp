#include "read_field_map.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

const Bounds kOnField{-100.0, 100.0};
constexpr double kShortestLine_m = 0.05;
constexpr double kOnLine_m = 1e-3;
constexpr std::size_t kMostLines = 1000;

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

void describe_line(ParamVisitor& v, FieldMap& map, double width_m) {
  std::vector<Eigen::Vector2d> points;
  bool closed = false;
  v.points("points_m", points, kOnField, 2, About("its corners in order").required());
  v.boolean("closed", closed, "whether it goes on from the last to the first");
  if (v.reader() == nullptr) return;
  const MapReader& reader = *v.reader();
  if (map.lines.size() + points.size() > kMostLines)
    throw reader.error("points_m",
                       "a field has at most " + std::to_string(kMostLines) + " pieces of line");
  for (std::size_t i = 1; i < points.size(); ++i)
    add_line(map, points[i - 1], points[i], width_m, reader);
  if (closed) add_line(map, points.back(), points.front(), width_m, reader);
}

void describe_arc(ParamVisitor& v, FieldMap& map, double width_m) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 1.0;
  double from = 0.0;
  double sweep = 2.0 * kPi;
  v.vector("centre_m", centre, kOnField, About("of the circle").required());
  v.number("radius_m", radius, {0.1, 50.0}, About("of its centre line").required());
  v.angle("from_deg", from, {-360.0, 360.0}, "where it begins");
  v.angle("sweep_deg", sweep, {1.0, 360.0}, "how far it goes, counter-clockwise");
  if (v.reader() == nullptr) return;
  const MapReader& reader = *v.reader();
  if (map.lines.size() >= kMostLines)
    throw reader.error("radius_m",
                       "a field has at most " + std::to_string(kMostLines) + " pieces of line");
  const FieldLine line = FieldLine::arc(centre, radius, from, sweep, width_m);
  constexpr int kProbes = 16;
  for (int i = 0; i <= kProbes; ++i)
    check_on_field(map, line.at(line.length_m() * i / kProbes), 0.0, reader, "radius_m");
  map.lines.push_back(line);
}

void describe_goal(ParamVisitor& v, FieldMap& map) {
  FieldGoal goal;
  v.choice("colour", goal.colour, {"white", "yellow", "blue"}, About("of the goal").required());
  v.vector("from_m", goal.from, kOnField, About("one post of its mouth").required());
  v.vector("to_m", goal.to, kOnField, About("the other").required());
  v.number("depth_m", goal.depth_m, {0.05, 5.0}, "from the mouth to its back");
  v.number("height_m", goal.height_m, {0.02, 5.0}, "of the goal");
  v.given("frame_m", [&] {
    v.number("frame_m", goal.frame_m, {0.0, 0.5},
             "width of its white posts and bar; 0: it has none, as where walls end at its mouth");
  });
  if (v.reader() == nullptr) return;
  const MapReader& reader = *v.reader();
  if ((goal.to - goal.from).norm() < 0.2)
    throw reader.error("to_m", "the goal's mouth must be at least 0.2 m wide");
  check_on_field(map, goal.from, 0.0, reader, "from_m");
  check_on_field(map, goal.to, 0.0, reader, "to_m");
  map.goals.push_back(goal);
}

void describe_post(ParamVisitor& v, FieldMap& map) {
  CornerPost post;
  enum class Outer { yellow, blue };
  auto outer = Outer::yellow;
  v.vector("at_m", post.at, kOnField, About("its middle").required());
  v.choice(
      "outer", outer, {"yellow", "blue"},
      About("the colour of its upper and lower bands; the middle one has the other").required());
  v.number("radius_m", post.radius_m, {0.01, 1.0}, "of the post");
  v.number("height_m", post.height_m, {0.1, 5.0}, "of the post");
  post.outer = outer == Outer::yellow ? FieldColour::yellow : FieldColour::blue;
  if (v.reader() == nullptr) return;
  check_on_field(map, post.at, 0.0, *v.reader(), "at_m");
  map.posts.push_back(post);
}

}  // namespace

void describe(ParamVisitor& v, FieldMap& map) {
  v.number("length_m", map.length_m, {0.5, 60.0}, About("between the goal lines").required());
  v.number("width_m", map.width_m, {0.5, 60.0}, About("between the touch lines").required());
  v.number("margin_m", map.margin_m, {0.0, 10.0}, "of carpet round about");
  double width = 0.125;
  v.number("line_width_m", width, {0.002, 0.5}, "of every line and arc");
  v.each("lines", "straight lines, painted about these points",
         [&] { describe_line(v, map, width); });
  v.each("arcs", "arcs of circles", [&] { describe_arc(v, map, width); });
  v.each("goals", "what stands on the goal lines", [&] { describe_goal(v, map); });
  v.each("posts", "corner posts, banded in yellow and blue", [&] { describe_post(v, map); });
  v.require(v.reader() == nullptr || !map.lines.empty(), "lines",
            "a field needs at least one line or arc");
}

FieldMap read_field_map(MapReader reader) {
  FieldMap map;
  read_params(std::move(reader), map);
  return map;
}

}  // namespace vigia
