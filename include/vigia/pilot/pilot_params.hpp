#pragma once

#include "vigia/pilot/path_follower.hpp"

namespace vigia::pilot {

/// How the ring of range sensors is read.
struct RingParams {
  double half_angle_deg = 7.5;   ///< of a beam's cone
  double sigma_m = 0.02;         ///< constant part of a reading's σ
  double sigma_relative = 0.01;  ///< part of σ that grows with the range
  double horizon_m = 2.5;        ///< echoes beyond this are nobody's business yet
  int confirmations = 3;         ///< scans that must show a thing before it counts
  double memory_s = 3.0;         ///< how long a thing counts that no beam has seen since
  double thing_radius_m = 0.20;  ///< an echo is taken for the near side of something of this size
};

/// How unknown obstacles are dealt with.
struct AvoidanceParams {
  double notice_m = 1.6;     ///< along the path: what blocks it farther ahead changes nothing yet
  double near_m = 0.7;       ///< what blocks the path at this distance has all the attention
  double corridor_m = 0.05;  ///< beside the robot, free of things for the path to count as free
  double beside_m = 0.10;    ///< kept from a thing that is driven round
  double wall_m = 0.06;      ///< kept from the known walls off the path
  double lane_m = 0.15;      ///< between two lanes beside the path
  double widest_m = 1.2;     ///< the outermost lane
  double horizon_m = 3.0;    ///< of the detour
  double speed = 0.22;       ///< m/s off the path
  double patience_s = 1.5;   ///< waited for somebody to pass before they are driven round
  double brake_m = 0.10;     ///< left before an unknown thing when the robot has stopped
  double brake_known_m = 0.03;  ///< left before anything at all
  double blocked_s = 8.0;       ///< without progress, after which the path counts as blocked
  double give_up_s = 60.0;      ///< without progress, after which whoever plans gives up
  double rejoin_m = 0.08;       ///< from the path: the path is followed again
};

struct PilotParams {
  PathFollowerParams follower;
  RingParams ring;
  AvoidanceParams avoidance;
};

}  // namespace vigia::pilot
