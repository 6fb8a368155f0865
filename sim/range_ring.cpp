#include "vigia/sim/range_ring.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/sector.hpp"
#include "vigia/sim/params.hpp"

namespace vigia::sim {
namespace {

using Eigen::Vector2d;

/// Distance from the sector's tip to the part of a circle inside it.
std::optional<double> circle_in_sector(const Sector& sector, const Vector2d& centre,
                                       double radius) {
  if (sector.holds(centre)) return std::max(0.0, centre.norm() - radius);
  std::optional<double> nearest;
  for (const Vector2d& edge : {sector.right, sector.left}) {
    const double along = edge.dot(centre);
    const double off = cross(edge, centre);
    const double half_chord2 = radius * radius - off * off;
    if (half_chord2 < 0.0 || along + std::sqrt(half_chord2) < 0.0) continue;
    const double hit = std::max(0.0, along - std::sqrt(half_chord2));
    nearest = std::min(hit, nearest.value_or(hit));
  }
  return nearest;
}

/// nearest_in_cone() of faces near @p p.
std::optional<double> nearest_in_sector(const NearFaces& faces, const std::vector<Pillar>& pillars,
                                        const Vector2d& p, const Sector& sector, double reach_m,
                                        double above_m) {
  std::optional<double> nearest = faces.nearest_in(sector);
  for (const Pillar& pillar : pillars) {
    if (pillar.height_m <= above_m) continue;
    const auto distance = circle_in_sector(sector, pillar.centre - p, pillar.radius_m);
    if (distance && *distance <= nearest.value_or(reach_m)) nearest = distance;
  }
  return nearest;
}

}  // namespace

std::optional<double> nearest_in_cone(const FloorPlan& plan, const std::vector<Pillar>& pillars,
                                      const Eigen::Vector2d& p, double direction, double cone,
                                      double reach_m, double above_m) {
  return nearest_in_sector(NearFaces(plan, p, reach_m, above_m), pillars, p,
                           Sector::about(direction, 0.5 * cone), reach_m, above_m);
}

RangeRing::RangeRing(const RangeRingParams& params, std::uint64_t seed)
    : params_(params), random_(seed, "range ring") {
  for (int i = 0; i < params_.beams; ++i) {
    const double bearing = wrap_angle(2.0 * kPi * i / params_.beams);
    bearings_.push_back(bearing);
    beams_.push_back(Sector::about(bearing, 0.5 * params_.cone));
  }
}

RangeScan RangeRing::scan(Stamp stamp, const Pose2& pose, const FloorPlan& plan,
                          const std::vector<Pillar>& pillars) {
  RangeScan scan{stamp, params_.reach_m, {}};
  scan.readings.reserve(static_cast<std::size_t>(params_.beams));
  const NearFaces faces(plan, pose.position(), params_.reach_m, params_.height_m);
  const Eigen::Vector2d ahead = unit_vector(pose.theta);
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    RangeReading reading{bearings_[i], params_.reach_m, false};
    const auto nearest = nearest_in_sector(faces, pillars, pose.position(), beams_[i].turned(ahead),
                                           params_.reach_m, params_.height_m);
    const bool dropped = random_.uniform(0.0, 1.0) < params_.dropout;
    const double error = random_.normal();
    if (nearest && !dropped) {
      const double sigma = std::hypot(params_.sigma_m, params_.sigma_relative * *nearest);
      reading.range_m = std::clamp(*nearest + sigma * error, 0.0, params_.reach_m);
      reading.echo = true;
    }
    scan.readings.push_back(reading);
  }
  return scan;
}

void describe(ParamVisitor& v, RangeRingParams& p) {
  v.integer("beams", p.beams, {1, 720}, "spread evenly round the base");
  v.number("reach_m", p.reach_m, {0.1, 100.0}, "of a beam");
  v.number("sigma_m", p.sigma_m, {0.0, 1.0}, "constant part of an echo's σ");
  v.number("sigma_relative", p.sigma_relative, {0.0, 1.0}, "part of σ that grows with the range");
  v.angle("cone_deg", p.cone, {0.1, 170.0}, "full opening angle of a beam");
  v.number("height_m", p.height_m, {0.0, 3.0}, "above the floor: what is lower gives no echo");
  v.number("dropout", p.dropout, {0.0, 1.0}, "share of the echoes that do not come back");
}

}  // namespace vigia::sim
