#include "vigia/planner/visibility.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/line_of_sight.hpp"

namespace vigia::planner {
namespace {

bool within(double angle, double low, double high) {
  return angle >= low && angle <= high;
}

}  // namespace

Visibility::Visibility(const FloorPlan& plan, HeadGeometry head, HeadLimits limits,
                       VisibilityParams params, const Ground& ground)
    : plan_(&plan), head_(std::move(head)), limits_(limits), params_(params), ground_(ground) {}

Sight Visibility::sight(const Landmark& landmark, const Pose2& pose) const {
  const double distance = range(landmark, pose);
  if (distance < params_.min_range_m) return Sight::too_near;
  if (distance > params_.max_range_m) return Sight::too_far;
  if (view_angle(landmark, pose) > from_deg(params_.max_view_angle_deg)) return Sight::too_oblique;

  const Eigen::Isometry3d wMr = ground_.place(pose);
  const HeadAngles aim = aim_at(head_, wMr.inverse() * landmark.centre_w());
  const bool pan_reaches = within(aim.pan, limits_.pan_min, limits_.pan_max) ||
                           within(aim.pan + 2.0 * kPi, limits_.pan_min, limits_.pan_max) ||
                           within(aim.pan - 2.0 * kPi, limits_.pan_min, limits_.pan_max);
  if (!pan_reaches || !within(aim.tilt, limits_.tilt_min, limits_.tilt_max))
    return Sight::out_of_reach;

  const bool clear = line_of_sight(*plan_, ground_, wMr * head_.mount_r, landmark.centre_w());
  return clear ? Sight::visible : Sight::hidden;
}

double Visibility::range(const Landmark& landmark, const Pose2& pose) const {
  return (ground_.place(pose) * head_.mount_r - landmark.centre_w()).norm();
}

double Visibility::view_angle(const Landmark& landmark, const Pose2& pose) const {
  const Eigen::Vector3d sight_w = ground_.place(pose) * head_.mount_r - landmark.centre_w();
  const Eigen::Vector3d normal_w = landmark.normal_w();
  return std::atan2(normal_w.cross(sight_w).norm(), normal_w.dot(sight_w));
}

}  // namespace vigia::planner
