#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/range_scan.hpp"
#include "vigia/core/round_obstacle.hpp"
#include "vigia/pilot/pilot_params.hpp"

namespace vigia::pilot {

enum class PilotStatus {
  driving,  ///< along the path
  holding,  ///< as ordered
  evading,  ///< beside the path, round something unknown
  waiting,  ///< for something unknown to go away
  blocked,  ///< no progress for AvoidanceParams::blocked_s; said for one step at a time
  arrived,
};

std::string_view to_string(PilotStatus status);

/// How much each behaviour has to say, in [0, 1]; they add up to one.
struct Activations {
  double follow = 1.0;
  double avoid = 0.0;
  double hold = 0.0;
};

struct PilotInput {
  Stamp now;
  const OdometryIncrement& odometry;  ///< since the last step
  const Belief& belief;
  const RangeScan* scan = nullptr;  ///< the latest, if there is a ring
  bool hold = false;                ///< stand still: somebody looks
};

/// A passage of the path into which the robot does not go.
struct PassageRefusal {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double width_m = 0.0;
  double beside_m = 0.0;  ///< of a robot in its middle
  double sigma_m = 0.0;   ///< of the robot's place across it, as good as it became
  /// It would do, but the robot stands aside of its middle: another path may lead in straight.
  bool misaligned = false;
};

struct PilotOutput {
  BaseRates rates;
  PilotStatus status = PilotStatus::driving;
  Activations activations;
  double station_m = 0.0;
  /// The unknown obstacle that blocks the path nearest ahead, if any.
  std::optional<Eigen::Vector2d> obstacle_ahead;
  /// Said for one step; the robot stands before it.
  std::optional<PassageRefusal> refused;
};

/// Drives the base along a path and round what stands in it, after the AFREB architecture (Salichs,
/// Gachet, Moreno, Pimentel 1994; Armingol §2): behaviour primitives answer what they would do,
/// a fusion supervisor says how much each has to say, and an executor turns the weighted mean into
/// rates with which the base can always stop before what the ring sees.
///
/// Echoes that the floor plan explains from where the belief has the robot are walls, and the path
/// keeps clear of those by itself. Others are remembered in the robot's frame, carried by odometry.
class Pilot {
 public:
  /// @p plan must outlive the pilot; @p robot_radius_m is of the base.
  Pilot(Path path, const FloorPlan& plan, double robot_radius_m, BaseLimits limits,
        PilotParams params);
  ~Pilot();
  Pilot(Pilot&&) noexcept;
  Pilot& operator=(Pilot&&) noexcept;
  Pilot(const Pilot&) = delete;
  Pilot& operator=(const Pilot&) = delete;

  PilotOutput step(const PilotInput& input);

  /// Another path from here on; what was seen is kept.
  void follow(Path path);
  bool arrived() const;
  double station() const;
  const Path& path() const;
  /// How long there has been no progress because of something unknown, s.
  double stalled_s() const;
  /// The unknown things that are remembered, in the world's frame for a robot at @p base.
  std::vector<RoundObstacle> obstacles(const Pose2& base) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vigia::pilot
