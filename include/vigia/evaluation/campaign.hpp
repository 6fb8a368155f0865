#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "vigia/mission/setup.hpp"

namespace vigia {
struct KeyRow;
}

namespace vigia::evaluation {

/// One way to drive the campaign's mission. Every arm drives it with the same seeds, and each
/// consumer of randomness has its stream by name: what two arms do alike is alike to the byte.
struct Arm {
  std::string name;                    ///< of the parts in which the arms differ, e.g. "fuzzy/all"
  std::string disturbance;             ///< empty: as the mission has them
  std::string variant;                 ///< empty: none
  std::vector<std::string> overrides;  ///< "key.path=value", in the order in which they apply
  mission::MissionSetup setup;         ///< shared by all missions of the arm
};

/// One mission of a campaign.
struct CampaignTask {
  std::size_t arm = 0;
  std::uint64_t seed = 0;
  bool operator<(const CampaignTask& other) const {
    return std::tie(seed, arm) < std::tie(other.seed, other.arm);
  }
};

/// Seeds × policies × localizers × disturbances × variants of one mission.
struct Campaign {
  std::string name;
  std::string command;  ///< that drives it in one process
  std::uint64_t first_seed = 1;
  int seeds = 100;
  std::vector<Arm> arms;
  std::size_t baseline = 0;  ///< the arm from which differences count

  std::size_t missions() const { return arms.size() * static_cast<std::size_t>(seeds); }
  /// Mission @p number of 0 … missions() − 1. Seed by seed: stopped early, every arm has as many
  /// drives as the others, give or take one.
  CampaignTask task(std::size_t number) const {
    return {number % arms.size(), first_seed + number / arms.size()};
  }
};

/// The reference of a campaign's keys.
std::vector<KeyRow> campaign_keys();

/// Reads a campaign file (see campaign_keys()): each of its lists multiplies the arms. @p overrides
/// apply last, to every arm. Throws InputError with the place in the campaign file.
Campaign read_campaign(const std::filesystem::path& file,
                       const std::vector<std::string>& overrides = {});

}  // namespace vigia::evaluation
