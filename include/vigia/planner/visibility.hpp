#pragma once

#include <Eigen/Core>

#include "vigia/core/actuation.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/pose.hpp"

namespace vigia::planner {

struct VisibilityParams {
  double max_view_angle_deg = 65.0;  ///< between the landmark's normal and the line of sight
  double min_range_m = 0.6;
  double max_range_m = 9.0;
};

enum class Sight { visible, too_near, too_far, too_oblique, out_of_reach, hidden };

/// Whether the head of a robot at a pose can see a landmark of the map.
class Visibility {
 public:
  Visibility(const FloorPlan& plan, HeadGeometry head, HeadLimits limits, VisibilityParams params,
             const Ground& ground = {});

  Sight sight(const Landmark& landmark, const Pose2& pose) const;
  /// Distance from the head to the landmark, m.
  double range(const Landmark& landmark, const Pose2& pose) const;
  /// Angle between the landmark's normal and the line of sight, rad.
  double view_angle(const Landmark& landmark, const Pose2& pose) const;

 private:
  const FloorPlan* plan_;
  HeadGeometry head_;
  HeadLimits limits_;
  VisibilityParams params_;
  Ground ground_;
};

}  // namespace vigia::planner
