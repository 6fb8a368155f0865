#include "vigia/sim/simulator.hpp"

#include <cmath>

namespace vigia::sim {

Simulator::Simulator(const RobotSetup& setup, const WorldMap& world,
                     const std::shared_ptr<const Appearance>& appearance, const Pose2& start,
                     std::uint64_t seed)
    : setup_(setup),
      plan_(world.plan),
      robot_(setup.robot, start, setup.initial_zoom_mm, derive_seed(seed, "robot")),
      scene_(world, appearance, derive_seed(seed, "scene")) {
  robot_.set_zoom_range(setup_.zoom.min_zoom_mm(), setup_.zoom.max_zoom_mm());
  if (setup_.range_ring) ring_.emplace(*setup_.range_ring, seed);
}

Intrinsics Simulator::true_intrinsics() const {
  Intrinsics intrinsics = setup_.zoom.at(robot_.truth().zoom_mm);
  const double scale = std::exp(robot_.truth().look_log_focal_error);
  intrinsics.px *= scale;
  intrinsics.py *= scale;
  return intrinsics;
}

std::unique_ptr<imaging::Frame> Simulator::expose() const {
  return scene_.expose(robot_.camera_pose(), true_intrinsics(), robot_.truth().stamp,
                       setup_.imaging);
}

RangeScan Simulator::scan() {
  const RobotTruth& truth = robot_.truth();
  if (!ring_) return {truth.stamp, 0.0, {}};
  return ring_->scan(truth.stamp, truth.pose, plan_, {});
}

double Simulator::clearance() const {
  return plan_.clearance(robot_.truth().pose.position()) - setup_.robot.radius_m;
}

}  // namespace vigia::sim
