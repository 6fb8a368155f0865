#pragma once

#include "echo_memory.hpp"
#include "executor.hpp"
#include "known_walls.hpp"
#include "ring_fix.hpp"

#include <optional>
#include <vector>

#include "vigia/core/passage.hpp"
#include "vigia/pilot/pilot.hpp"

namespace vigia::pilot {

/// What a path's narrow passages ask of whoever drives it.
struct PassageOrder {
  double speed = 0.0;  ///< m/s, at most
  bool hold = false;   ///< before the passage: where it is, is not known well enough yet
  std::optional<PassageRefusal> refused;
};

/// Takes a robot through the narrow passages of its path: before one, the ring's scans are matched
/// with the walls (RingFix), the speed falls to what the room beside the robot allows for, and the
/// robot goes in only where three standard deviations of its place across the passage fit beside
/// it.
class PassageGuard {
 public:
  /// @p plan must outlive it.
  PassageGuard(const FloorPlan& plan, double robot_radius_m, BaseLimits limits,
               const RingParams& ring);

  void follow(const Path& path);
  const std::vector<Passage>& passages() const { return passages_; }

  /// A tick: the robot is about @p station of its path.
  void sense(const PilotInput& input, double station);
  /// Where the base is: by the ring near a passage, by the belief elsewhere.
  const Pose2& base(const Belief& belief) const;
  /// Whether the robot is in a passage or about to go in: there is no way round things there.
  bool inside(double station) const;
  PoseDoubt doubt(const Belief& belief) const;
  PassageOrder order(const Belief& belief, double station, double dt);
  /// What must not be touched. Near a passage the walls are where the plan has them, not where a
  /// wide beam's middle ends, and other things are those that several scans have shown; elsewhere
  /// it is what the latest scan has @p seen.
  std::vector<Hazard> hazards(const std::vector<Hazard>& seen, const EchoMemory& memory,
                              const Belief& belief) const;
  /// What must stay free beside the robot, m.
  double beside_m() const;

 private:
  double room_beside(const Passage& passage) const;
  /// Whether the path comes from outside of it and leads on beyond it.
  bool leads_through(const Passage& passage) const;
  /// How far from its middle line the path leads through it, m.
  double path_off(const Passage& passage) const;
  bool fixed() const { return near_ != nullptr && fix_.agrees(); }

  const FloorPlan* plan_;
  double robot_radius_m_;
  BaseLimits limits_;
  RingFix fix_;
  std::vector<Passage> passages_;
  Path path_;
  const Passage* near_ = nullptr;  ///< the passage that is driven or comes next
  std::optional<Stamp> scanned_;
  double disagreed_s_ = 0.0;
  double held_s_ = 0.0;
};

}  // namespace vigia::pilot
