#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "vigia/evaluation/drive_score.hpp"

namespace vigia::evaluation {

/// Runs a mission once for each of the seeds first, first + 1, … on @p threads threads. The scores
/// come in the order of the seeds and do not depend on the number of threads. @p done is called
/// after each mission, one call at a time.
std::vector<DriveScore> run_seeds(const mission::MissionSetup& setup, std::uint64_t first,
                                  int count, int threads,
                                  const std::function<void(const DriveScore&)>& done = {});

}  // namespace vigia::evaluation
