#include "camera_feed.hpp"

#include <utility>

namespace vigia::mission {

CameraFeed::CameraFeed(const Camera& camera, Duration delay, Duration processing,
                       std::unique_ptr<perception::Eye> eye)
    : camera_(camera.id),
      period_(Duration::from_seconds(camera.period_s)),
      phase_(Duration::from_seconds(camera.phase_s)),
      late_(Duration{Duration::from_seconds(camera.latency_s).ns + delay.ns}, processing),
      eye_(std::move(eye)) {}

bool CameraFeed::due(Stamp now) {
  if (period_.ns == 0) return true;
  const std::int64_t since = now.ns - phase_.ns;
  if (since < 0 || since / period_.ns < exposures_) return false;
  exposures_ = since / period_.ns + 1;
  return true;
}

void CameraFeed::expose(const sim::Simulator& simulator, const Shot& shot) {
  if (due(shot.stamp)) late_.expose({simulator.expose(camera_), shot, simulator.robot().truth()});
}

}  // namespace vigia::mission
