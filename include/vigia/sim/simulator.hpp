#pragma once

#include <optional>
#include <string>

#include "vigia/sim/range_ring.hpp"
#include "vigia/sim/robot.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {

/// Everything that a mission's file says of its robot: the robot, its camera and its zoom.
struct RobotSetup {
  std::string name;
  RobotParams robot;
  ZoomCalibration zoom;  ///< what the robot believes; per-look focal error on top is the truth
  ImagingParams imaging;
  double initial_zoom_mm = 8.0;
  std::optional<RangeRingParams> range_ring;
};

/// Reads a robot file: keys `name`, `base`, `head`, `zoom`, `camera`, `odometry`, `sensor`,
/// `range_ring`. Throws InputError with the place of what is wrong.
RobotSetup read_robot_setup(MapReader& reader);

/// The simulated world with the robot in it.
class Simulator {
 public:
  Simulator(const RobotSetup& setup, const WorldMap& world,
            const std::shared_ptr<const Appearance>& appearance, const Pose2& start,
            std::uint64_t seed);

  Robot& robot() { return robot_; }
  const Robot& robot() const { return robot_; }
  const Scene& scene() const { return scene_; }

  /// The camera's exposure at the robot's present true state.
  std::unique_ptr<imaging::Frame> expose() const;
  /// The camera's true intrinsics now: calibrated at the zoom's position, scaled by the look's
  /// focal error.
  Intrinsics true_intrinsics() const;
  /// Distance from the robot's hull to the nearest true face, m; negative: collided.
  double clearance() const;
  /// What the ring of range sensors says now; without a ring, no readings.
  RangeScan scan();

 private:
  RobotSetup setup_;
  FloorPlan plan_;
  Robot robot_;
  Scene scene_;
  std::optional<RangeRing> ring_;
};

}  // namespace vigia::sim
