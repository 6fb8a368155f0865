#include "drive_layer.hpp"
#include "foxglove_json.hpp"
#include "outlines.hpp"
#include "palette.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "vigia/core/overloaded.hpp"
#include "vigia/report/foxglove.hpp"

namespace vigia::report::foxglove {
namespace {

/// LineType.
enum class Line { strip = 0, loop = 1, list = 2 };

using Points = std::vector<Eigen::Vector3d>;

constexpr double kAbove_m = 0.01;  // the floor, so that what lies on it shows
constexpr double kThin_m = 0.004;  // of a sheet on a wall

Json entity(Stamp at, const std::string& frame, const std::string& id) {
  Json out = {{"timestamp", time_json(at)},
              {"frame_id", frame},
              {"id", id},
              {"lifetime", {{"sec", 0}, {"nsec", 0}}},  // until another of that id comes
              {"frame_locked", true},
              {"metadata", Json::array()}};
  for (const char* kind :
       {"arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"})
    out[kind] = Json::array();
  return out;
}

std::string scene(const Json& entities) {
  return text_of({{"deletions", Json::array()}, {"entities", entities}});
}

Json points_json(const Points& points) {
  Json list = Json::array();
  for (const auto& p : points) list.push_back(point_json(p));
  return list;
}

Json line(Line type, const Points& points, double thickness_m, const Colour& colour) {
  return {{"type", static_cast<int>(type)},
          {"pose", pose_json(Eigen::Isometry3d::Identity())},
          {"thickness", number_json(thickness_m)},
          {"scale_invariant", false},
          {"points", points_json(points)},
          {"color", colour_json(colour)},
          {"colors", Json::array()},
          {"indices", Json::array()}};
}

Json triangles(const Points& corners, const Colour& colour) {
  return {{"pose", pose_json(Eigen::Isometry3d::Identity())},
          {"points", points_json(corners)},
          {"color", colour_json(colour)},
          {"colors", Json::array()},
          {"indices", Json::array()}};
}

Json cube(const Eigen::Isometry3d& wMb, const Eigen::Vector3d& size, const Colour& colour) {
  return {{"pose", pose_json(wMb)}, {"size", point_json(size)}, {"color", colour_json(colour)}};
}

Json cylinder(const Eigen::Isometry3d& wMb, double radius_m, double height_m,
              const Colour& colour) {
  Json out = cube(wMb, {2.0 * radius_m, 2.0 * radius_m, height_m}, colour);
  out["bottom_scale"] = 1.0;
  out["top_scale"] = 1.0;
  return out;
}

Json text(const Eigen::Vector3d& at, const std::string& words) {
  Eigen::Isometry3d wMt = Eigen::Isometry3d::Identity();
  wMt.translation() = at;
  return {{"pose", pose_json(wMt)},
          {"billboard", true},
          {"font_size", 0.15},
          {"scale_invariant", false},
          {"color", colour_json(palette::kInk)},
          {"text", words}};
}

void add_quad(Points& corners, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
              const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  corners.insert(corners.end(), {a, b, c, a, c, d});
}

/// On ground that folds a straight line of the plan is cut into short pieces.
int pieces_of(const Ground& ground, double length_m) {
  constexpr double kPiece_m = 0.25;
  return ground.patches().empty() ? 1 : std::max(1, static_cast<int>(length_m / kPiece_m));
}

/// A vertical face above the line from @p a to @p b.
void add_face(Points& corners, const Ground& ground, const Eigen::Vector2d& a,
              const Eigen::Vector2d& b, double height_m) {
  const int pieces = pieces_of(ground, (b - a).norm());
  for (int i = 0; i < pieces; ++i) {
    const Eigen::Vector2d from = a + (b - a) * i / pieces;
    const Eigen::Vector2d to = a + (b - a) * (i + 1) / pieces;
    add_quad(corners, ground.lift(from, 0.0), ground.lift(to, 0.0), ground.lift(to, height_m),
             ground.lift(from, height_m));
  }
}

/// A line of the plan on the ground.
Points on_ground(const Ground& ground, const std::vector<Eigen::Vector2d>& plan, bool closed) {
  Points points;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < plan.size(); ++i) {
    const Eigen::Vector2d& a = plan[i];
    const Eigen::Vector2d& b = plan[(i + 1) % plan.size()];
    const int pieces = pieces_of(ground, (b - a).norm());
    for (int k = 0; k < pieces; ++k)
      points.push_back(ground.lift(a + (b - a) * k / pieces, kAbove_m));
  }
  if (!closed && !plan.empty()) points.push_back(ground.lift(plan.back(), kAbove_m));
  return points;
}

// ---- the world ----------------------------------------------------------------------------------

Json building(Stamp at, const WorldMap& world) {
  Json out = entity(at, kWorldFrame, "building");
  Points faces;
  for (const Wall& wall : world.plan.faces())
    add_face(faces, world.ground, wall.a, wall.b, wall.height_m);
  out["triangles"].push_back(triangles(faces, palette::kSolid.with_alpha(0.4)));
  out["lines"].push_back(
      line(Line::loop, on_ground(world.ground, world.plan.outline(), true), 0.05, palette::kInk));
  for (const GroundPatch& patch : world.ground.patches()) {
    Points fan;
    for (std::size_t i = 2; i < patch.polygon.size(); ++i)
      for (const std::size_t corner : {std::size_t{0}, i - 1, i})
        fan.push_back(world.ground.lift(patch.polygon[corner], 0.0));
    out["triangles"].push_back(triangles(fan, palette::kGrid));
  }
  return out;
}

void add_landmark(Json& out, const Landmark& landmark) {
  const auto sheet = [&](double half_m, const Colour& colour, double thick_m) {
    out["cubes"].push_back(cube(landmark.wMl, {2.0 * half_m, 2.0 * half_m, thick_m}, colour));
  };
  std::visit(Overloaded{[&](const DiscShape& disc) {
                          out["cylinders"].push_back(
                              cylinder(landmark.wMl, disc.radius_m, kThin_m, palette::kInk));
                        },
                        [&](const PatternShape&) {
                          sheet(half_width(landmark), palette::kPurple, kThin_m);
                        },
                        [&](const TagShape& tag) {
                          sheet(half_width(landmark), palette::kWhite, kThin_m);
                          sheet(0.5 * tag.side_m, palette::kInk, 2.0 * kThin_m);
                        }},
             landmark.shape);
  const double above_m = half_width(landmark) + 0.12;
  out["texts"].push_back(
      text(landmark.wMl * Eigen::Vector3d(0.0, above_m, 0.05), fmt::format("L{}", landmark.id)));
}

Json landmarks(Stamp at, const WorldMap& world) {
  Json out = entity(at, kWorldFrame, "landmarks");
  for (const Landmark& landmark : world.landmarks.all()) add_landmark(out, landmark);
  return out;
}

Colour colour_of(FieldColour colour) {
  if (colour == FieldColour::yellow) return palette::hex(0xf0d000);
  return colour == FieldColour::blue ? palette::kBlue : palette::kWhite;
}

void add_goal(Json& out, const Ground& ground, const FieldGoal& goal) {
  const Eigen::Vector2d behind = goal.centre().normalized() * goal.depth_m;
  Points faces;
  add_face(faces, ground, goal.from, goal.from + behind, goal.height_m);
  add_face(faces, ground, goal.from + behind, goal.to + behind, goal.height_m);
  add_face(faces, ground, goal.to + behind, goal.to, goal.height_m);
  out["triangles"].push_back(triangles(faces, colour_of(goal.colour).with_alpha(0.6)));
}

Json field(Stamp at, const FieldMap& map, const Ground& ground) {
  Json out = entity(at, kWorldFrame, "field");
  const double x = 0.5 * map.length_m + map.margin_m;
  const double y = 0.5 * map.width_m + map.margin_m;
  Points carpet;
  add_quad(carpet, ground.lift({-x, -y}, 0.0), ground.lift({x, -y}, 0.0), ground.lift({x, y}, 0.0),
           ground.lift({-x, y}, 0.0));
  out["triangles"].push_back(triangles(carpet, palette::kGreen.with_alpha(0.6)));
  for (const FieldLine& each : map.lines)
    out["lines"].push_back(line(Line::strip, on_ground(ground, line_points(each), false),
                                each.width_m, palette::kWhite));
  for (const FieldGoal& goal : map.goals) add_goal(out, ground, goal);
  for (const CornerPost& post : map.posts) {
    Eigen::Isometry3d wMp = Eigen::Isometry3d::Identity();
    wMp.translation() = ground.lift(post.at, 0.5 * post.height_m);
    out["cylinders"].push_back(cylinder(wMp, post.radius_m, post.height_m, colour_of(post.outer)));
  }
  return out;
}

/// Those above the plan; of a ceiling with very many only the first.
Json ceiling(Stamp at, const WorldMap& world) {
  constexpr std::size_t kMostEnds = 2 * 20'000;
  const CeilingGrid& grid = *world.ceiling;
  const CeilingCells cells = cells_in(grid, {world.plan.min_corner(), world.plan.max_corner()});
  const Eigen::Vector2d half(0.5 * grid.length_m, 0.0);
  Points ends;
  for (auto i = cells.first.i; i <= cells.last.i && ends.size() < kMostEnds; ++i) {
    for (auto j = cells.first.j; j <= cells.last.j && ends.size() < kMostEnds; ++j) {
      if (!has_patch(grid, {i, j})) continue;
      const Eigen::Vector2d centre = cell_centre(grid, {i, j});
      ends.push_back(world.ground.lift(centre - half, grid.height_m));
      ends.push_back(world.ground.lift(centre + half, grid.height_m));
    }
  }
  Json out = entity(at, kWorldFrame, "ceiling");
  out["lines"].push_back(line(Line::list, ends, grid.width_m, palette::kInk));
  return out;
}

Json route_entity(Stamp at, const WorldMap& world, const Path& route) {
  Json out = entity(at, kWorldFrame, "route");
  out["lines"].push_back(
      line(Line::strip, on_ground(world.ground, route.points(), false), 0.03, palette::kInk));
  return out;
}

// ---- beliefs ------------------------------------------------------------------------------------

Colour belief_colour(std::size_t i) {
  constexpr Colour kColours[] = {palette::kBlue,   palette::kVermillion, palette::kGreen,
                                 palette::kPurple, palette::kOrange,     palette::kSkyBlue};
  return kColours[i % std::size(kColours)];
}

Json ellipse(const Ground& ground, const Pose2& at, const Eigen::Matrix3d& covariance,
             const Colour& colour) {
  const double k = std::sqrt(kChi2At95);
  const auto outline = ellipse_outline(at.position(), covariance.topLeftCorner<2, 2>(), k);
  return line(Line::loop, on_ground(ground, outline, true), 0.015, colour);
}

Json belief_entity(Stamp at, const NamedBelief& named, const Ground& ground, const Colour& colour) {
  const Belief& belief = *named.belief;
  Json out = entity(at, kWorldFrame, named.name);
  const auto tell = [&out](const char* key, const std::string& value) {
    out["metadata"].push_back({{"key", key}, {"value", value}});
  };
  tell("status", std::string(to_string(belief.status)));
  tell("sigma_m", fmt::format("{:.4g}", belief.position_sigma()));
  tell("heading_sigma_deg", fmt::format("{:.4g}", to_deg(std::sqrt(belief.covariance(2, 2)))));
  tell("lost_probability", fmt::format("{:.3g}", belief.lost_probability));
  if (belief.hypotheses.empty())
    out["lines"].push_back(ellipse(ground, belief.pose, belief.covariance, colour));
  for (const PoseHypothesis& each : belief.hypotheses)
    out["lines"].push_back(ellipse(ground, each.pose, each.covariance, colour));
  return out;
}

}  // namespace

std::string world_scene(Stamp at, const WorldMap& world, const Path& route) {
  Json entities = Json::array({building(at, world)});
  if (!world.landmarks.all().empty()) entities.push_back(landmarks(at, world));
  if (world.field) entities.push_back(field(at, *world.field, world.ground));
  if (world.ceiling) entities.push_back(ceiling(at, world));
  if (!route.empty()) entities.push_back(route_entity(at, world, route));
  return scene(entities);
}

std::string robot_scene(Stamp at, const std::string& frame, double radius_m) {
  constexpr double kHeight_m = 0.3;
  Json out = entity(at, frame, "robot");
  Eigen::Isometry3d middle = Eigen::Isometry3d::Identity();
  middle.translation().z() = 0.5 * kHeight_m;
  out["cylinders"].push_back(
      cylinder(middle, radius_m, kHeight_m, palette::kTruth.with_alpha(0.7)));
  const Eigen::Vector3d top(0.0, 0.0, kHeight_m + kAbove_m);
  out["lines"].push_back(
      line(Line::strip, {top, top + Eigen::Vector3d(radius_m, 0.0, 0.0)}, 0.03, palette::kInk));
  return scene(Json::array({out}));
}

std::string beliefs_scene(Stamp at, const std::vector<NamedBelief>& beliefs, const Ground& ground) {
  Json entities = Json::array();
  for (std::size_t i = 0; i < beliefs.size(); ++i)
    entities.push_back(belief_entity(at, beliefs[i], ground, belief_colour(i)));
  return scene(entities);
}

}  // namespace vigia::report::foxglove
