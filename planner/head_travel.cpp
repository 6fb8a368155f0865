#include "head_travel.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/planner/apparent_size.hpp"
#include "vigia/planner/path_model.hpp"

namespace vigia::planner {
namespace {

/// Time from rest to rest over a distance under limits of rate and acceleration.
double axis_time(double distance, double rate, double acceleration) {
  const double ramps = rate * rate / acceleration;
  return distance <= ramps ? 2.0 * std::sqrt(distance / acceleration)
                           : distance / rate + rate / acceleration;
}

/// The pan to turn by: the nearest turn of the wanted angle within the head's range.
double pan_distance(double wanted, double from, const HeadLimits& limits) {
  double best = std::abs(std::clamp(wanted, limits.pan_min, limits.pan_max) - from);
  for (const double pan : {wanted - 2.0 * kPi, wanted + 2.0 * kPi})
    if (pan >= limits.pan_min && pan <= limits.pan_max) best = std::min(best, std::abs(pan - from));
  return best;
}

/// Pan of the head, within its range, that points at the landmark; nothing near a stop.
std::optional<double> free_pan(const Landmark& landmark, const Pose2& pose, const HeadModel& head) {
  constexpr double kMargin = from_deg(6.0);
  const HeadAngles aim =
      aim_at(head.geometry, head.ground.place(pose).inverse() * landmark.centre_w());
  for (const double pan : {aim.pan, aim.pan - 2.0 * kPi, aim.pan + 2.0 * kPi})
    if (pan >= head.limits.pan_min + kMargin && pan <= head.limits.pan_max - kMargin) return pan;
  return std::nullopt;
}

/// How far along the path the robot gets; its error across and in heading stays as it is.
Pose2 moved_along(const LookContext& context, double advance_m) {
  const Pose2 here = pose_on_path(context.path, context.station_m);
  const Pose2 there =
      pose_on_path(context.path, std::min(context.station_m + advance_m, context.path.length()));
  return compose(there, compose(inverse(here), context.belief.pose));
}

}  // namespace

bool can_be_held(const Landmark& landmark, const Arrival& arrival, const LookContext& context) {
  if (!can_be_observed(landmark, context, arrival.pose)) return false;
  const double advance =
      arrival.station_m - context.station_m + context.speed_mps * context.head_model.dwell_s;
  const Pose2 end = advance > 0.0 ? moved_along(context, advance) : arrival.pose;
  const auto from = free_pan(landmark, arrival.pose, context.head_model);
  const auto to = free_pan(landmark, end, context.head_model);
  // From one side of the stop to the other is nearly a whole turn.
  return from && to && std::abs(*to - *from) < kPi && can_be_observed(landmark, context, end);
}

double travel_time(const HeadReading& from, const HeadAngles& aim, double zoom_mm,
                   const HeadModel& head) {
  const HeadLimits& limits = head.limits;
  const double pan = pan_distance(aim.pan, from.angles.pan, limits);
  const double tilt = std::abs(aim.tilt - from.angles.tilt);
  return std::max({axis_time(pan, limits.rate, limits.acceleration),
                   axis_time(tilt, limits.rate, limits.acceleration),
                   std::abs(zoom_mm - from.zoom_mm) / limits.zoom_rate_mm_s});
}

Arrival foresee(const Landmark& landmark, std::optional<double> zoom_mm,
                const LookContext& context) {
  Arrival arrival{0.0, context.belief.pose, context.station_m};
  // Each round leaves about an eighth of the error.
  for (int round = 0; round < 4; ++round) {
    const Eigen::Vector3d p_r =
        context.head_model.ground.place(arrival.pose).inverse() * landmark.centre_w();
    const double range = (p_r - context.head_model.geometry.mount_r).norm();
    const double zoom = zoom_mm ? *zoom_mm : zoom_for(landmark, range, context.head_model);
    arrival.seconds = travel_time(context.head, aim_at(context.head_model.geometry, p_r), zoom,
                                  context.head_model);
    const double advance = context.speed_mps * arrival.seconds;
    arrival.pose = advance > 0.0 ? moved_along(context, advance) : context.belief.pose;
    arrival.station_m = std::min(context.station_m + advance, context.path.length());
  }
  return arrival;
}

}  // namespace vigia::planner
