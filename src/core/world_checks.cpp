#include "world_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/angle.hpp"
#include "vigia/core/overloaded.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

constexpr double kSlack = 1e-6;                   // metres by which the written figures may be off
const double kFacing = std::cos(from_deg(10.0));  // a mounted landmark's normal follows its wall's

std::string metres(double value) {
  const double rounded = std::round(value * 1000.0) / 1000.0;
  std::string text = std::to_string(rounded);
  text.erase(text.size() - 3);
  return text + " m";
}

/// What hangs on the wall, for messages.
std::string thing(const Landmark& landmark) {
  return disc_radius(landmark) ? "the disc" : "the sheet";
}

/// The face that a landmark is mounted on: the nearest one that its normal is square to.
const Wall* mounting_face(const PlacedLandmark& placed, const FloorPlan& plan) {
  const Eigen::Vector2d centre = placed.landmark.centre_w().head<2>();
  const Eigen::Vector2d normal = placed.landmark.normal_w().head<2>();
  const Wall* best = nullptr;
  double best_distance = kMountedWithin;
  for (const Wall& face : plan.faces()) {
    const Eigen::Vector2d along = (face.b - face.a).normalized();
    const double distance = distance_to_segment(centre, face.a, face.b);
    if (distance > best_distance || std::abs(cross(along, normal)) < kFacing) continue;
    best = &face;
    best_distance = distance;
  }
  return best;
}

/// Whether a point just in front of the landmark lies in the room and outside every solid.
bool looks_into_the_open(const PlacedLandmark& placed, const FloorPlan& plan) {
  const Eigen::Vector2d ahead =
      (placed.landmark.centre_w() + 2.0 * kMountedWithin * placed.landmark.normal_w()).head<2>();
  if (!inside_polygon(ahead, plan.outline())) return false;
  return std::none_of(plan.obstacles().begin(), plan.obstacles().end(), [&](const Obstacle& solid) {
    return placed.landmark.centre_w().z() < solid.height_m && inside_polygon(ahead, solid.polygon);
  });
}

/// Whether a wall stands between the landmark and a point just in front of it.
bool lies_behind(const PlacedLandmark& placed, const Wall& face) {
  const Eigen::Vector2d normal = placed.landmark.normal_w().head<2>();
  return (placed.landmark.centre_w().head<2>() - face.a).dot(normal) < -1e-3 - kSlack;
}

void check_in_room(const PlacedLandmark& placed, const FloorPlan& plan) {
  const Eigen::Vector3d centre = placed.landmark.centre_w();
  const Eigen::Vector2d spot = centre.head<2>();
  if (!inside_polygon(spot, plan.outline()) &&
      distance_to_outline(spot, plan.outline()) > kMountedWithin)
    throw placed.reader->error("centre_m", "the landmark lies outside the room");
  for (const Obstacle& solid : plan.obstacles()) {
    if (centre.z() < solid.height_m && inside_polygon(spot, solid.polygon) &&
        distance_to_outline(spot, solid.polygon) > kMountedWithin)
      throw placed.reader->error("centre_m", "the landmark lies inside an obstacle");
  }
  const double reach = half_width(placed.landmark);
  if (centre.z() - reach < -kSlack)
    throw placed.reader->error("centre_m", thing(placed.landmark) + " reaches below the floor");
  if (centre.z() + reach > plan.ceiling_m() + kSlack)
    throw placed.reader->error(
        "centre_m",
        thing(placed.landmark) + " reaches above the ceiling at " + metres(plan.ceiling_m()));
}

void check_fits(const PlacedLandmark& placed, const Wall& face) {
  const double reach = half_width(placed.landmark);
  if (placed.landmark.centre_w().z() + reach > face.height_m + kSlack)
    throw placed.reader->error("centre_m", thing(placed.landmark) +
                                               " sticks out above its wall, which is " +
                                               metres(face.height_m) + " high");
  const Eigen::Vector2d along = face.b - face.a;
  const double s = (placed.landmark.centre_w().head<2>() - face.a).dot(along.normalized());
  if (s < reach - kSlack || s > along.norm() - reach + kSlack)
    throw placed.reader->error("centre_m", thing(placed.landmark) +
                                               " sticks out at the side of its wall, which is " +
                                               metres(along.norm()) + " long");
}

/// Whether two landmarks on one side of one wall take the same place: discs and upright squares,
/// @p offset apart in the plane of the first.
bool footprints_meet(const Landmark& a, const Landmark& b, const Eigen::Vector2d& offset) {
  const double reach_a = half_width(a);
  const double reach_b = half_width(b);
  const bool round_a = disc_radius(a).has_value();
  const bool round_b = disc_radius(b).has_value();
  if (round_a && round_b) return offset.norm() < reach_a + reach_b;
  const Eigen::Array2d apart = offset.array().abs();
  if (!round_a && !round_b) return (apart < reach_a + reach_b).all();
  const double square = round_a ? reach_b : reach_a;
  const double radius = round_a ? reach_a : reach_b;
  return (apart - square).max(0.0).matrix().norm() < radius;
}

bool overlap(const Landmark& a, const Landmark& b) {
  if (a.normal_w().dot(b.normal_w()) <= 0.0) return false;
  const Eigen::Vector3d offset_a = a.wMl.inverse(Eigen::Isometry) * b.centre_w();
  return std::abs(offset_a.z()) < half_width(a) + half_width(b) &&
         footprints_meet(a, b, offset_a.head<2>());
}

/// The key of the number that two landmarks share though it must tell them apart, or nothing.
const char* shared_code(const Landmark& a, const Landmark& b) {
  return std::visit(Overloaded{[](const DiscShape&) -> const char* { return nullptr; },
                               [&b](const PatternShape& pattern) {
                                 const auto* other = std::get_if<PatternShape>(&b.shape);
                                 return other != nullptr && other->code == pattern.code ? "pattern"
                                                                                        : nullptr;
                               },
                               [&b](const TagShape& tag) {
                                 const auto* other = std::get_if<TagShape>(&b.shape);
                                 return other != nullptr && other->tag == tag.tag ? "tag" : nullptr;
                               }},
                    a.shape);
}

}  // namespace

void check_polygon(const std::vector<Eigen::Vector2d>& polygon, const MapReader& reader,
                   const std::string& key) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if ((polygon[(i + 1) % polygon.size()] - polygon[i]).norm() < kShortestWall)
      throw reader.error(key, "corner " + std::to_string(i + 1) + " is repeated");
  }
  if (const auto sides = crossing_sides(polygon))
    throw reader.error(key, "the polygon crosses itself: side " + std::to_string(sides->first + 1) +
                                " meets side " + std::to_string(sides->second + 1));
}

void check_below_ceiling(double height_m, double ceiling_m, const MapReader& reader) {
  if (height_m > ceiling_m)
    throw reader.error(
        "height_m", "found " + metres(height_m) + ", higher than the room's " + metres(ceiling_m));
}

void check_segment_in_room(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                           const std::vector<Eigen::Vector2d>& outline, const MapReader& reader,
                           const std::string& key) {
  // Between its crossings with the outline a segment lies wholly inside or wholly outside.
  std::vector<double> cuts{0.0, 1.0};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto crossing = cross_lines(a, b, outline[i], outline[(i + 1) % outline.size()]);
    if (crossing && crossing->along_pq > 0.0 && crossing->along_pq < 1.0)
      cuts.push_back(crossing->along_pq);
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const double fractions[] = {cuts[i], i + 1 < cuts.size() ? 0.5 * (cuts[i] + cuts[i + 1]) : 1.0};
    for (const double t : fractions) {
      const Eigen::Vector2d p = a + t * (b - a);
      if (!inside_polygon(p, outline) && distance_to_outline(p, outline) > kSlack)
        throw reader.error(
            key, "it reaches outside the room at [" + metres(p.x()) + ", " + metres(p.y()) + "]");
    }
  }
}

void check_mounting(const PlacedLandmark& placed, const FloorPlan& plan) {
  check_in_room(placed, plan);
  if (placed.free_standing) return;
  const Wall* face = mounting_face(placed, plan);
  if (face == nullptr)
    throw placed.reader->error(
        "centre_m",
        "the landmark is mounted on no wall: none that normal_deg is square to lies "
        "within " +
            metres(kMountedWithin) + " (write 'free_standing: true' for one that needs none)");
  if (!looks_into_the_open(placed, plan) || lies_behind(placed, *face))
    throw placed.reader->error("normal_deg",
                               "the landmark looks into the wall that it is mounted on");
  check_fits(placed, *face);
}

void check_against_earlier(const std::vector<PlacedLandmark>& placed) {
  const PlacedLandmark& last = placed.back();
  for (auto other = placed.begin(); other + 1 != placed.end(); ++other) {
    if (other->landmark.id == last.landmark.id)
      throw last.reader->error("id", "the id " + std::to_string(last.landmark.id) +
                                         " occurs twice; it was given before at " +
                                         to_string(other->reader->where("id")));
    if (const char* key = shared_code(last.landmark, other->landmark))
      throw last.reader->error(
          key, "landmark " + std::to_string(other->landmark.id) + " shows the same code");
    if (overlap(last.landmark, other->landmark))
      throw last.reader->error(
          "centre_m", "the landmark overlaps landmark " + std::to_string(other->landmark.id));
  }
}

}  // namespace vigia
