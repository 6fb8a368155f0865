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

/// Frames on their way from the camera: each arrives a fixed time after its exposure.
class LateFrames {
 public:
  explicit LateFrames(Duration latency) : latency_(latency) {}

  void expose(ExposedFrame frame) { on_the_way_.push_back(std::move(frame)); }
  /// The newest frame that has arrived by @p now and was not taken before, if any.
  std::unique_ptr<ExposedFrame> take(Stamp now);
  /// The frame that was exposed last, while it is on its way.
  const ExposedFrame* newest() const { return on_the_way_.empty() ? nullptr : &on_the_way_.back(); }

 private:
  Duration latency_;
  std::deque<ExposedFrame> on_the_way_;
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
