#include "vigia/mission/delays.hpp"

#include <algorithm>
#include <cstdint>

namespace vigia::mission {
namespace {

std::int64_t ticks_to_cover(Duration time, Duration tick) {
  return (time.ns + tick.ns - 1) / tick.ns;
}

}  // namespace

Duration longest_delay(const MissionSetup& setup, const Camera& camera) {
  const Duration tick = Duration::from_seconds(setup.tick_s);
  const auto& late = setup.disturbances.latency;
  const Duration latency{Duration::from_seconds(camera.latency_s).ns +
                         Duration::from_seconds(late ? late->latency_s : 0.0).ns};
  const Duration processing = Duration::from_seconds(late ? late->processing_s : 0.0);
  const Duration period = Duration::from_seconds(camera.period_s);
  const std::int64_t arrives = ticks_to_cover(latency, tick);
  const std::int64_t processed = ticks_to_cover(processing, tick);
  // Of the images that come meanwhile the newest waits: less than the time from one to the next.
  const std::int64_t apart = std::max<std::int64_t>(1, ticks_to_cover(period, tick));
  const bool waits = processed > std::max<std::int64_t>(1, period.ns / tick.ns);
  const std::int64_t wait = waits ? std::min(processed, apart) - 1 : 0;
  return {(arrives + wait + processed) * tick.ns};
}

Duration longest_delay(const MissionSetup& setup) {
  Duration longest;
  for (const Camera& camera : setup.robot.rig().cameras)
    longest = std::max(longest, longest_delay(setup, camera));
  return longest;
}

}  // namespace vigia::mission
