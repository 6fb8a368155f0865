#pragma once

#include <optional>
#include <string>

#include "vigia/core/rig.hpp"
#include "vigia/sim/camera_errors.hpp"
#include "vigia/sim/disturbances.hpp"
#include "vigia/sim/kidnapping.hpp"
#include "vigia/sim/light_field.hpp"
#include "vigia/sim/range_ring.hpp"
#include "vigia/sim/robot.hpp"
#include "vigia/sim/scene.hpp"
#include "vigia/sim/walkers.hpp"

namespace vigia::sim {

/// What a robot's file may leave out.
RobotParams usual_robot();

/// Everything that a mission's file says of its robot: the robot, its camera and its zoom.
struct RobotSetup {
  std::string name = "robot";
  RobotParams robot = usual_robot();
  ZoomCalibration zoom;  ///< what the robot believes; per-look focal error on top is the truth
  ImagingParams imaging;
  double initial_zoom_mm = 8.0;
  std::optional<RangeRingParams> range_ring;

  /// The robot's cameras: one on the head, with the zoom, of id 0.
  Rig rig() const;
};

/// Reads a robot file; the reader stays the caller's to finish. Throws InputError with the place of
/// what is wrong.
RobotSetup read_robot_setup(MapReader& reader);

/// The simulated world with the robot in it: the room as it truly is, which the disturbances make
/// out of the map that the robot has. Everything is drawn by streams named after what they draw.
class Simulator {
 public:
  Simulator(const RobotSetup& setup, const WorldMap& world,
            const std::shared_ptr<const Appearance>& appearance, const Pose2& start,
            std::uint64_t seed, const DisturbanceParams& disturbances = {});

  Robot& robot() { return robot_; }
  const Robot& robot() const { return robot_; }
  const Scene& scene() const { return scene_; }
  /// The room as it is. Its floor plan is the map's.
  const WorldMap& true_world() const { return world_; }

  /// Moves the robot, then the people, by @p dt.
  void advance(Duration dt);
  /// Puts the robot elsewhere when the time has come, once; says whether it did.
  bool kidnap();

  /// The camera's exposure whose middle is now.
  std::unique_ptr<imaging::Frame> expose() const;
  /// The camera's true intrinsics now: calibrated at the zoom's position, scaled by the look's
  /// focal error, with the errors of the calibration.
  Intrinsics true_intrinsics() const;
  /// How late frames are delivered.
  Duration latency() const { return latency_; }
  /// How long a delivered frame takes to process.
  Duration processing() const { return processing_; }
  /// Distance from the robot's hull to the nearest true face or person, m; negative: collided.
  double clearance() const;
  /// The same of people alone; infinite without any.
  double clearance_of_people() const;
  /// What the ring of range sensors says now; without a ring, no readings.
  RangeScan scan();

 private:
  Bystander bystander() const;
  std::vector<Exposure::Instant> instants(const Intrinsics& intrinsics) const;

  RobotSetup setup_;
  WorldMap world_;
  Robot robot_;
  Scene scene_;
  CameraErrors camera_errors_;
  std::optional<MotionBlurParams> motion_blur_;
  std::optional<LightField> light_;
  std::optional<Walkers> walkers_;
  std::optional<RangeRing> ring_;
  std::optional<Kidnapping> kidnapping_;
  Duration latency_;
  Duration processing_;
};

}  // namespace vigia::sim
