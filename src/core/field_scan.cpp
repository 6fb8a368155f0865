#include "vigia/core/field_scan.hpp"

#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/pose.hpp"

namespace vigia {
namespace {

Eigen::Rotation2Dd turn_of(const Pose2& pose) {
  return Eigen::Rotation2Dd(pose.theta);
}

ColourSighting carried(ColourSighting sighting, const Pose2& aMb) {
  const Eigen::Vector2d p =
      aMb.position() + turn_of(aMb) * (sighting.range_m * unit_vector(sighting.bearing));
  sighting.bearing = std::atan2(p.y(), p.x());
  sighting.range_m = p.norm();
  return sighting;
}

}  // namespace

FieldPoint polar_point(double bearing, double range_m, double bearing_sigma, double range_sigma_m) {
  const Eigen::Vector2d u = unit_vector(bearing);
  const Eigen::Vector2d across(-u.y(), u.x());
  const double across_m = bearing_sigma * range_m;
  return {range_m * u, range_sigma_m * range_sigma_m * u * u.transpose() +
                           across_m * across_m * across * across.transpose()};
}

FieldScan carried(const FieldScan& scan_b, const Pose2& aMb, Stamp stamp) {
  FieldScan scan = scan_b;
  scan.stamp = stamp;
  const Eigen::Matrix2d R = turn_of(aMb).toRotationMatrix();
  for (FieldPoint& point : scan.points)
    point = {aMb.position() + R * point.p_r, R * point.covariance * R.transpose()};
  for (auto* sightings : {&scan.goals, &scan.posts})
    for (ColourSighting& sighting : *sightings) sighting = carried(sighting, aMb);
  return scan;
}

}  // namespace vigia
