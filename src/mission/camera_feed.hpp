#pragma once

#include "late_frames.hpp"
#include "timed_frame.hpp"

#include <memory>
#include <optional>
#include <vector>

#include "vigia/core/rig.hpp"
#include "vigia/perception/eye.hpp"
#include "vigia/sim/simulator.hpp"

namespace vigia::mission {

/// One camera of the rig with the eye that its captures are for: when it exposes, and what of that
/// has arrived.
class CameraFeed {
 public:
  /// @p delay: of every delivery, on top of the camera's own latency. @p processing: of a frame.
  CameraFeed(const Camera& camera, Duration delay, Duration processing,
             std::unique_ptr<perception::Eye> eye);

  CameraId id() const { return camera_; }
  Duration latency() const { return late_.latency(); }
  perception::Eye& eye() const { return *eye_; }

  /// Exposes when it is time. @p shot: what is read now.
  void expose(const sim::Simulator& simulator, const Shot& shot);
  /// The newest frame that has arrived and was not taken before, if any.
  std::unique_ptr<ExposedFrame> take(Stamp now) { return late_.take(now); }

 private:
  bool due(Stamp now);

  CameraId camera_;
  Duration period_;  ///< 0: in every tick
  Duration phase_;
  std::int64_t exposures_ = 0;  ///< that were due so far
  LateFrames late_;
  std::unique_ptr<perception::Eye> eye_;
};

/// What a camera delivered in a tick.
struct Delivery {
  Delivery(perception::Eye& looking, std::unique_ptr<ExposedFrame> exposed, bool of_this_look)
      : eye(&looking),
        exposure(std::move(exposed)),
        frame(std::make_unique<TimedFrame>(*exposure->frame)),
        present(of_this_look) {}

  perception::Capture capture() const { return {*frame, exposure->shot}; }

  perception::Eye* eye;
  std::unique_ptr<ExposedFrame> exposure;
  std::unique_ptr<TimedFrame> frame;
  bool present;  ///< exposed since the present look began: an earlier one says nothing of this one
};

}  // namespace vigia::mission
