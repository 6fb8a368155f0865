#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "vigia/core/belief.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/sim/robot.hpp"

namespace vigia::mission {

/// A frame with what the robot's sensors said, and what was true, when it was exposed.
struct ExposedFrame {
  std::unique_ptr<imaging::Frame> frame;
  Shot shot;
  sim::RobotTruth truth;
};

/// Frames on their way from the camera: each arrives a fixed time after its exposure, and takes a
/// fixed time to process. One is processed at a time: of those that arrive meanwhile the newest is
/// next, the others are dropped.
class LateFrames {
 public:
  explicit LateFrames(Duration latency, Duration processing = {})
      : latency_(latency), processing_(processing) {}

  void expose(ExposedFrame frame) { on_the_way_.push_back(std::move(frame)); }
  /// The newest frame that is processed by @p now and was not taken before, if any.
  std::unique_ptr<ExposedFrame> take(Stamp now);
  /// From the exposure to the end of the processing, where the frame need not wait for another.
  Duration latency() const { return {latency_.ns + processing_.ns}; }

 private:
  std::unique_ptr<ExposedFrame> arrived(Stamp now);

  Duration latency_;
  Duration processing_;
  std::deque<ExposedFrame> on_the_way_;
  std::unique_ptr<ExposedFrame> in_work_;
  Stamp done_;
};

/// Dead reckoning of the last moments: takes the present belief back to when a frame was exposed.
class RecentMotion {
 public:
  explicit RecentMotion(Duration length) : length_(length) {}

  void moved(const OdometryIncrement& u);
  /// The belief at @p stamp, by odometry back from @p now; its covariance is the present one.
  Belief belief_at(Stamp stamp, const Belief& now) const;

 private:
  struct Place {
    Stamp stamp;
    Pose2 oMr;
  };
  Duration length_;
  std::deque<Place> places_{{}};
};

}  // namespace vigia::mission
