#include "lost_episodes.hpp"

#include <algorithm>

namespace vigia::evaluation {

double LostEpisode::began_s() const {
  return std::min(said_s.value_or(*passed_s), passed_s.value_or(*said_s));
}

void update_episodes(std::vector<LostEpisode>& episodes, double now_s, bool says_lost,
                     double error_m) {
  const bool astray = error_m > LostEpisode::kLost_m;
  const bool open = !episodes.empty() && !episodes.back().ended_s;
  if (!open && (says_lost || astray)) episodes.emplace_back();
  if (episodes.empty() || episodes.back().ended_s) return;
  LostEpisode& episode = episodes.back();
  if (says_lost && !episode.said_s) episode.said_s = now_s;
  if (astray && !episode.passed_s) episode.passed_s = now_s;
  if (!says_lost && error_m < 0.5 * LostEpisode::kLost_m) episode.ended_s = now_s;
}

}  // namespace vigia::evaluation
