#include "vigia/core/observation.hpp"

namespace vigia {

const SensorSnapshot& sensor_of(const Observation& observation) {
  return std::visit([](const auto& seen) -> const SensorSnapshot& { return seen.sensor; },
                    observation);
}

}  // namespace vigia
