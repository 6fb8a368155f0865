#pragma once

#include <cstdint>
#include <vector>

#include "vigia/mission/listener.hpp"

namespace vigia::mission {

/// Runs one mission to its end in the calling thread. The same setup and seed give the same calls
/// of the listeners (but for Tick::timing), whatever else runs in the process.
Outcome run_mission(const MissionSetup& setup, std::uint64_t seed,
                    const std::vector<Listener*>& listeners);

}  // namespace vigia::mission
