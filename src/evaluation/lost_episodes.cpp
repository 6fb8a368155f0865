#include "lost_episodes.hpp"

#include <algorithm>

namespace vigia::evaluation {

double LostEpisode::began_s() const {
  return std::min(said_s.value_or(*passed_s), passed_s.value_or(*said_s));
}

double allowed_error_m(double sigma_m) {
  return LossScorer::kAstraySigmas * std::min(sigma_m, LossScorer::kAstray_m);
}

bool is_astray(double error_m, double sigma_m) {
  return error_m > LossScorer::kAstray_m || error_m > LossScorer::kAstraySigmas * sigma_m;
}

void update_episodes(std::vector<LostEpisode>& episodes, double now_s, bool says_lost,
                     double error_m, double sigma_m) {
  const bool passed = error_m > LostEpisode::kLost_m && error_m > allowed_error_m(sigma_m);
  const bool open = !episodes.empty() && !episodes.back().ended_s;
  if (!open && (says_lost || passed)) episodes.emplace_back();
  if (episodes.empty() || episodes.back().ended_s) return;
  LostEpisode& episode = episodes.back();
  if (says_lost && !episode.said_s) {
    episode.said_s = now_s;
    episode.groundless = !is_astray(error_m, sigma_m) && sigma_m <= LostEpisode::kLost_m;
  }
  if (passed && !episode.passed_s) episode.passed_s = now_s;
  if (!says_lost && error_m < 0.5 * LostEpisode::kLost_m) episode.ended_s = now_s;
}

}  // namespace vigia::evaluation
