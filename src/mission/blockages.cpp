#include "blockages.hpp"

#include <algorithm>

namespace vigia::mission {
namespace {

constexpr double kSamePlace = 0.5;  // m
constexpr double kKept = 60.0;      // s

}  // namespace

void Blockages::note(Stamp now, const std::vector<RoundObstacle>& things) {
  const auto replaced = [&](const std::pair<Stamp, RoundObstacle>& old) {
    return std::any_of(things.begin(), things.end(), [&](const RoundObstacle& thing) {
      return (thing.centre - old.second.centre).norm() < kSamePlace;
    });
  };
  things_.erase(std::remove_if(things_.begin(), things_.end(), replaced), things_.end());
  for (const RoundObstacle& thing : things) things_.emplace_back(now, thing);
}

std::vector<RoundObstacle> Blockages::recent(Stamp now) const {
  std::vector<RoundObstacle> result;
  for (const auto& [noted, thing] : things_)
    if (now - noted <= Duration::from_seconds(kKept)) result.push_back(thing);
  return result;
}

}  // namespace vigia::mission
