#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// A camera of the robot, and how it turns light into grey levels.
struct CameraSetup {
  Camera camera;  ///< what the robot believes; the errors of its calibration on top are the truth
  ImagingParams imaging;
};

/// Everything that a mission's file says of its robot: the base, the head and the cameras.
struct RobotSetup {
  std::string name = "robot";
  RobotParams robot = usual_robot();
  std::vector<CameraSetup> cameras{CameraSetup{}};  ///< at least one; one with a zoom at most
  double initial_zoom_mm = 8.0;
  std::optional<RangeRingParams> range_ring;

  Rig rig() const;
  /// The camera that an attention directs (vigia::directed_camera), or nullptr.
  const CameraSetup* directed_camera() const;
  /// The calibration of that camera, which there must be: std::logic_error.
  ZoomCalibration zoom() const;
};

/// A robot of one pan-tilt-zoom camera, of id 0.
RobotSetup pan_tilt_zoom_robot(const RobotParams& robot, const ZoomCalibration& zoom,
                               const ImagingParams& imaging = {});

/// Reads a robot file, whose cameras stand in the list `cameras` or, of a robot with one
/// pan-tilt-zoom camera, in `camera` and `zoom`; the reader stays the caller's to finish. Throws
/// InputError with the place of what is wrong.
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

  /// The exposure of a camera whose middle is now.
  std::unique_ptr<imaging::Frame> expose(CameraId camera = 0) const;
  /// A camera's true model now: calibrated, at the zoom's position, scaled by the look's focal
  /// error, with the errors of the calibration.
  CameraModel true_model(CameraId camera = 0) const;
  /// How late frames are delivered, beside the cameras' own latency.
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
  struct TrueCamera {
    CameraSetup setup;
    CameraErrors errors;
    CameraMount mount;
  };

  void disturb(const DisturbanceParams& disturbances, std::uint64_t seed);
  Bystander bystander() const;
  const TrueCamera& camera_of(CameraId id) const;
  /// People, other robots, and what the robot sees of itself.
  std::vector<Person> figures() const;
  std::vector<Person> figures_in_plan() const;
  std::vector<Exposure::Instant> instants(const TrueCamera& camera, const CameraModel& model) const;

  RobotSetup setup_;
  WorldMap world_;
  Robot robot_;
  Scene scene_;
  std::vector<TrueCamera> cameras_;
  std::optional<MotionBlurParams> motion_blur_;
  std::optional<LightField> light_;
  std::optional<Walkers> walkers_;
  std::optional<RangeRing> ring_;
  std::optional<Kidnapping> kidnapping_;
  Duration latency_;
  Duration processing_;
};

}  // namespace vigia::sim
