#include "read_ground.hpp"

#include "world_checks.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

const Bounds kGroundPlace{kCoordinate.low, kCoordinate.high};
constexpr double kAreaSlack_m2 = 0.01;
constexpr double kStep_m = 0.005;      // that a wheel climbs
constexpr double kProbe_m = 0.05;      // between two points that are looked at
constexpr double kAlongWall_m = 0.01;  // of what stands on a border

void describe_piece(ParamVisitor& v, GroundPiece& piece) {
  double grade = 0.0;
  v.points("polygon_m", piece.polygon, kGroundPlace, 3, About("its corners in order").required());
  v.number("grade", grade, {0.0, 0.25}, "rise over run of a ramp; 0: level");
  v.angle("uphill_deg", piece.uphill, {-360.0, 360.0},
          "direction in which a ramp rises, from the plan's x axis");
  piece.slope = std::atan(grade);
  if (v.reader() != nullptr) check_polygon(piece.polygon, *v.reader(), "polygon_m");
}

std::string at_place(const Eigen::Vector2d& p) {
  std::ostringstream text;
  text.precision(4);
  text << " at [" << p.x() << ", " << p.y() << "]";
  return text.str();
}

bool has_wall_along(const FloorPlan& plan, const Eigen::Vector2d& p) {
  return std::any_of(plan.faces().begin(), plan.faces().end(), [&p](const Wall& face) {
    return distance_to_segment(p, face.a, face.b) < kAlongWall_m;
  });
}

/// Somewhere on the patches' edges where a wheel would meet a step.
std::optional<std::pair<Eigen::Vector2d, double>> open_step(const FloorPlan& plan,
                                                            const Ground& ground) {
  for (const GroundPatch& patch : ground.patches()) {
    for (std::size_t i = 0; i < patch.polygon.size(); ++i) {
      const Eigen::Vector2d from = patch.polygon[i];
      const Eigen::Vector2d side = patch.polygon[(i + 1) % patch.polygon.size()] - from;
      const Eigen::Vector2d out = 2e-3 * Eigen::Vector2d(side.y(), -side.x()).normalized();
      const auto probes = static_cast<int>(std::ceil(side.norm() / kProbe_m));
      for (int k = 1; k < probes; ++k) {
        const Eigen::Vector2d p = from + side * k / probes;
        if (!inside_polygon(p + out, plan.outline())) continue;
        const double step = (ground.lift(p + out, 0.0) - ground.lift(p - out, 0.0)).z();
        // What two slopes rise between the probes is no step.
        if (std::abs(step) > kStep_m && !has_wall_along(plan, p)) return std::pair{p, step};
      }
    }
  }
  return std::nullopt;
}

bool stands_on_one(const Obstacle& obstacle, const Ground& ground) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : obstacle.polygon) middle += p;
  middle /= static_cast<double>(obstacle.polygon.size());
  const std::size_t patch = ground.patch_at(middle);
  return std::all_of(
      obstacle.polygon.begin(), obstacle.polygon.end(),
      [&](const Eigen::Vector2d& p) { return ground.patch_at(p + 1e-3 * (middle - p)) == patch; });
}

/// Throws std::invalid_argument.
Ground checked_ground(const std::vector<GroundPiece>& pieces, const FloorPlan& plan) {
  Ground ground(pieces);
  double area = 0.0;
  for (const GroundPatch& patch : ground.patches()) {
    area += polygon_area(patch.polygon);
    for (const Eigen::Vector2d& p : patch.polygon)
      if (!inside_polygon(p, plan.outline()) && distance_to_outline(p, plan.outline()) > 1e-3)
        throw std::invalid_argument("a piece reaches outside the room" + at_place(p));
  }
  const double room = polygon_area(plan.outline());
  if (std::abs(area - room) > kAreaSlack_m2)
    throw std::invalid_argument("the pieces must cover the room once: they have " +
                                std::to_string(area) + " m² and the room " + std::to_string(room) +
                                " m²");
  if (const auto step = open_step(plan, ground))
    throw std::invalid_argument("a step of " + std::to_string(std::abs(step->second)) + " m" +
                                at_place(step->first) + " has no wall along it");
  for (std::size_t i = 0; i < plan.obstacles().size(); ++i)
    if (!stands_on_one(plan.obstacles()[i], ground))
      throw std::invalid_argument("obstacle " + std::to_string(i + 1) + " stands across a fold");
  return ground;
}

}  // namespace

void describe_ground(ParamVisitor& v, const FloorPlan& plan, Ground& ground) {
  std::vector<GroundPiece> pieces;
  v.each("ground",
         "flat pieces that cover the room, the first where the plan says, each further one "
         "hinged to an earlier one along a level edge; the plan is metric along slopes",
         [&] { describe_piece(v, pieces.emplace_back()); });
  if (v.reader() == nullptr || pieces.empty()) return;
  try {
    ground = checked_ground(pieces, plan);
  } catch (const std::invalid_argument& wrong) {
    v.require(false, "ground", wrong.what());
  }
}

}  // namespace vigia
