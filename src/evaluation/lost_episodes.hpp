#pragma once

#include <vector>

#include "vigia/evaluation/estimator_score.hpp"

namespace vigia::evaluation {

/// Keeps the episodes of a localizer up to date with one instant: opens one when it says that it is
/// lost or its error passes LostEpisode::kLost_m, closes it when it tracks again with half of that.
void update_episodes(std::vector<LostEpisode>& episodes, double now_s, bool says_lost,
                     double error_m);

}  // namespace vigia::evaluation
