#pragma once

#include <vector>

#include "vigia/core/actuation.hpp"
#include "vigia/core/passage.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/pilot/pursuit.hpp"

namespace vigia::pilot {

struct PathFollowerParams {
  double lookahead_m = 0.30;        ///< distance of the pursued point ahead on the path
  double turn_in_place_deg = 40.0;  ///< heading error above which the base turns on the spot
  double corner_deg = 30.0;         ///< the path's bends above this are turned on the spot
  double goal_tolerance_m = 0.05;   ///< arrived when the estimate is this near to the path's end
  double slow_down_m = 0.3;         ///< speed falls linearly over this distance before the end
};

/// Follows a path from the estimated pose: pure pursuit with a turn on the spot at sharp corners.
///
/// Corners cut the path into stretches that are driven one after the other. The station never goes
/// back and never leaves the stretch, so that a path that crosses itself or returns on itself is
/// followed in its order.
class PathFollower {
 public:
  /// Into one of @p passages the path is followed straight: any bend before it is turned on the
  /// spot.
  PathFollower(Path path, BaseLimits limits, PathFollowerParams params,
               const std::vector<Passage>& passages = {});

  /// The rates for now; zero once arrived().
  BaseRates step(const Pose2& estimate);
  bool arrived() const { return arrived_; }
  /// Arc length reached.
  double station() const { return station_; }
  /// Goes on from @p station, further along the path: somebody else drove the robot there.
  void skip_to(double station);
  const Path& path() const { return path_; }

 private:
  /// The point to drive towards, in the base frame.
  Eigen::Vector2d pursued(const Pose2& estimate) const;
  void advance(const Pose2& estimate);
  double speed_limit() const;

  Path path_;
  BaseLimits limits_;
  PathFollowerParams params_;
  std::vector<double> stops_;  ///< stations at which the stretches end, the path's end last
  std::size_t stretch_ = 0;
  double station_ = 0.0;
  Pursuit pursuit_;
  bool arrived_ = false;
};

}  // namespace vigia::pilot
