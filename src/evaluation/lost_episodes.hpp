#pragma once

#include <vector>

#include "vigia/evaluation/loss_score.hpp"

namespace vigia::evaluation {

/// How far off a position may be whose claimed √λ_max is @p sigma_m. Of a claim no more than half a
/// metre is believed: who claims more knows nothing.
double allowed_error_m(double sigma_m);

/// See LossScore.
bool is_astray(double error_m, double sigma_m);

/// Keeps the episodes of a localizer up to date with one instant: opens one when it says that it is
/// lost or its error passes LostEpisode::kLost_m and what the claimed @p sigma_m allows for, closes
/// it when it tracks again with half of the former.
void update_episodes(std::vector<LostEpisode>& episodes, double now_s, bool says_lost,
                     double error_m, double sigma_m);

}  // namespace vigia::evaluation
