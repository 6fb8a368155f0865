#include "field_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBeside_m = 0.45;    // of boards from the carpet
constexpr double kSpectator_m = 0.9;  // of people from the carpet
const std::array<std::array<float, 3>, 7> kAdvertColours{{{205.0F, 40.0F, 38.0F},
                                                          {232.0F, 196.0F, 40.0F},
                                                          {34.0F, 74.0F, 200.0F},
                                                          {228.0F, 228.0F, 226.0F},
                                                          {30.0F, 30.0F, 34.0F},
                                                          {40.0F, 150.0F, 70.0F},
                                                          {224.0F, 120.0F, 30.0F}}};

Vector3d raised(const Vector2d& p, double z) {
  return {p.x(), p.y(), z};
}

Material plain(const Ink& ink, double fine, double contrast, std::uint64_t seed) {
  Material material = plain_material(ink.grey, fine * contrast, seed);
  material.tint = ink.tint;
  return material;
}

/// An upright rectangle over the floor from a to b.
Surface upright(const Vector2d& a, const Vector2d& b, double low, double high,
                const Material& material) {
  return {raised(a, low),
          raised((b - a).normalized(), 0.0),
          Vector3d::UnitZ(),
          {raised(a, low), raised(b, low), raised(b, high), raised(a, high)},
          material};
}

/// A column of square section.
void add_column(const Vector2d& at, const Vector2d& along, double width_m, double height,
                const Material& material, std::vector<Surface>& surfaces) {
  const Vector2d across(-along.y(), along.x());
  const double h = 0.5 * width_m;
  const std::array<Vector2d, 4> corners{at - h * along - h * across, at + h * along - h * across,
                                        at + h * along + h * across, at - h * along + h * across};
  for (std::size_t i = 0; i < corners.size(); ++i)
    surfaces.push_back(upright(corners[i], corners[(i + 1) % 4], 0.0, height, material));
}

/// A point at arc length @p s of the carpet's edge, so far outside it, and the way along there.
struct EdgePlace {
  Vector2d p;
  Vector2d along;
};

EdgePlace beside_carpet(const FieldMap& field, double s, double outside_m) {
  const Vector2d half(0.5 * field.length_m + field.margin_m + outside_m,
                      0.5 * field.width_m + field.margin_m + outside_m);
  const std::array<Vector2d, 4> corners{
      {{-half.x(), -half.y()}, {half.x(), -half.y()}, half, {-half.x(), half.y()}}};
  double left = std::fmod(s, 4.0 * half.sum());
  for (std::size_t i = 0;; i = (i + 1) % 4) {
    const Vector2d side = corners[(i + 1) % 4] - corners[i];
    if (left <= side.norm()) return {corners[i] + left * side.normalized(), side.normalized()};
    left -= side.norm();
  }
}

double perimeter(const FieldMap& field, double outside_m) {
  return 2.0 * (field.length_m + field.width_m) + 8.0 * (field.margin_m + outside_m);
}

bool has_room(const FloorPlan& plan, const Vector2d& p, double radius_m) {
  return inside_polygon(p, plan.outline()) && plan.clearance(p) >= radius_m;
}

}  // namespace

Ink field_ink(FieldColour colour) {
  switch (colour) {
    case FieldColour::yellow:
      return ink({222.0F, 182.0F, 34.0F});
    case FieldColour::blue:
      return ink({24.0F, 66.0F, 190.0F});
    case FieldColour::white:
      break;
  }
  return ink({222.0F, 222.0F, 222.0F});
}

Surface carpet_surface(const FieldMap& field, const Appearance& look) {
  const double beyond = std::max(field.margin_m, 0.1);
  const double x = 0.5 * field.length_m + beyond;
  const double y = 0.5 * field.width_m + beyond;
  return {{0.0, 0.0, 0.0},
          Vector3d::UnitX(),
          Vector3d::UnitY(),
          {{-x, -y, 0.0}, {x, -y, 0.0}, {x, y, 0.0}, {-x, y, 0.0}},
          carpet_material(look.carpet_grey, look.contrast, derive_seed(look.seed, "carpet"))};
}

std::vector<Surface> goal_surfaces(const FieldMap& field, const Appearance& look) {
  std::vector<Surface> surfaces;
  const std::uint64_t seed = derive_seed(look.seed, "goals");
  const Material frame = plain(field_ink(FieldColour::white), 3.0, look.contrast, seed);
  for (const FieldGoal& goal : field.goals) {
    const Vector2d along = (goal.to - goal.from).normalized();
    Vector2d behind(-along.y(), along.x());
    if (behind.dot(goal.centre()) < 0.0) behind = -behind;
    const bool white = goal.colour == FieldColour::white;
    const Ink inside = white ? ink({120.0F, 122.0F, 124.0F}) : field_ink(goal.colour);
    const Material panel = plain(inside, white ? 22.0 : 6.0, look.contrast, seed);
    const Vector2d deep = goal.depth_m * behind;
    surfaces.push_back(upright(goal.from, goal.from + deep, 0.0, goal.height_m, panel));
    surfaces.push_back(upright(goal.from + deep, goal.to + deep, 0.0, goal.height_m, panel));
    surfaces.push_back(upright(goal.to + deep, goal.to, 0.0, goal.height_m, panel));
    const double wide = goal.frame_m;
    if (wide <= 0.0) continue;
    const double out = 0.5 * wide;  // the mouth lies between the posts
    add_column(goal.from - out * along, along, wide, goal.height_m, frame, surfaces);
    add_column(goal.to + out * along, along, wide, goal.height_m, frame, surfaces);
    surfaces.push_back(upright(goal.from, goal.to, goal.height_m - wide, goal.height_m, frame));
  }
  return surfaces;
}

std::vector<Surface> advert_surfaces(const FieldMap& field, const FloorPlan& plan,
                                     const Appearance& look) {
  std::vector<Surface> boards;
  RandomStream random(look.seed, "adverts");
  const double round = perimeter(field, kBeside_m);
  for (int i = 0; i < look.adverts; ++i) {
    const double s = round * (i + random.uniform(0.0, 0.5)) / look.adverts;
    const double length = random.uniform(0.3, 0.9) * round / look.adverts;
    const double height = random.uniform(0.3, 1.0);
    const Ink colour = ink(kAdvertColours[random.index(kAdvertColours.size())]);
    const EdgePlace at = beside_carpet(field, s, kBeside_m);
    const Vector2d end = at.p + std::min(length, 3.0) * at.along;
    if (!has_room(plan, at.p, 0.02) || !has_room(plan, end, 0.02)) continue;
    boards.push_back(upright(
        at.p, end, 0.0, height,
        plain(colour, 10.0, look.contrast, derive_seed(look.seed, static_cast<std::uint64_t>(i)))));
  }
  return boards;
}

std::vector<BodyPart> post_parts(const FieldMap& field) {
  constexpr int kBands = 3;
  std::vector<BodyPart> parts;
  for (const CornerPost& post : field.posts) {
    const FieldColour other =
        post.outer == FieldColour::yellow ? FieldColour::blue : FieldColour::yellow;
    const double band = post.height_m / kBands;
    for (int i = 0; i < kBands; ++i) {
      const Ink colour = field_ink(i == 1 ? other : post.outer);
      BodyPart part;
      part.A = Vector3d(1.0 / post.radius_m, 1.0 / post.radius_m, 1.0 / band).asDiagonal();
      part.c = raised(post.at, i * band);
      part.grey = 1.3F * colour.grey;  // a body's shading takes off a quarter
      part.tint = colour.tint;
      parts.push_back(part);
    }
  }
  return parts;
}

std::vector<BodyPart> spectator_parts(const FieldMap& field, const FloorPlan& plan,
                                      const Appearance& look) {
  std::vector<BodyPart> parts;
  RandomStream random(look.seed, "spectators");
  const double round = perimeter(field, kSpectator_m);
  for (int i = 0; i < look.spectators; ++i) {
    Person person;
    const EdgePlace at = beside_carpet(
        field, round * (i + random.uniform(0.1, 0.9)) / look.spectators, kSpectator_m);
    person.position = at.p;
    person.heading = std::atan2(at.along.x(), -at.along.y()) + random.uniform(-0.8, 0.8);
    person.height_m = random.uniform(1.55, 1.95);
    person.figure = Figure::coloured_person;
    person.look = static_cast<int>(random.index(64));
    if (!has_room(plan, at.p, person.radius_m)) continue;
    std::vector<BodyPart> body = body_parts(person);
    std::move(body.begin(), body.end(), std::back_inserter(parts));
  }
  return parts;
}

}  // namespace vigia::sim
