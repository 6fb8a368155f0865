#pragma once

#include <map>

#include "vigia/planner/look_policy.hpp"

namespace vigia::planner::test {

/// Information that a test gives out by landmark; nothing for the others.
class GivenInformation final : public InformationModel {
 public:
  std::optional<Eigen::Matrix3d> look_information(const Landmark& landmark,
                                                  const Pose2& pose) const override {
    asked_at[landmark.id] = pose;
    const auto at = information.find(landmark.id);
    return at == information.end() ? std::nullopt : std::optional(at->second);
  }
  std::map<LandmarkId, Eigen::Matrix3d> information;
  mutable std::map<LandmarkId, Pose2> asked_at;
};

/// A room with three discs in sight (ids 1, 2, 3 at growing range) and one hidden by a wall (4).
struct LookRoom {
  LookRoom()
      : plan({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8,
             {{{2.0, 2.5}, {2.0, 4.5}, 2.8}}, {}),
        visibility(plan, HeadGeometry{}, HeadLimits{}, VisibilityParams{}),
        path({{3.0, 3.5}, {9.0, 3.5}}),
        landmarks({{1, wall_mount({4.0, 7.0, 1.6}, -0.5 * kPi), DiscShape{0.1}},
                   {2, wall_mount({6.0, 0.0, 1.6}, 0.5 * kPi), DiscShape{0.1}},
                   {3, wall_mount({12.0, 3.5, 1.6}, kPi), DiscShape{0.1}},
                   {4, wall_mount({0.0, 3.5, 1.6}, 0.0), DiscShape{0.1}}}) {
    belief.pose = {4.0, 3.5, 0.0};
    head_model.zoom =
        ZoomCalibration(640, 480, 319.5, 239.5, {{8.0, 582.0, 0.0}, {48.0, 3491.0, 0.0}});
  }

  LookPolicyParts parts(std::optional<LandmarkId> fixed = {}, std::uint64_t seed = 1) const {
    return {fixed, RandomStream(seed, "look"), landmarks, visibility, head_model, {}, {}};
  }
  LookContext context() const {
    return {Stamp{},     belief,   head,       station_m, path,     landmarks, visibility,
            information, excluded, head_model, speed_mps, standing, odometry};
  }

  FloorPlan plan;
  Visibility visibility;
  Path path;
  LandmarkMap landmarks;
  HeadModel head_model;
  Belief belief;
  HeadReading head;
  GivenInformation information;
  std::vector<LandmarkId> excluded;
  double station_m = 1.0;
  double speed_mps = 0.0;
  bool standing = false;
  OdometryNoise odometry;
};

}  // namespace vigia::planner::test
