#pragma once

#include <cstddef>
#include <filesystem>

#include "vigia/evaluation/provenance.hpp"

namespace vigia::evaluation {

/// A campaign that is driven in shards, as plan.json in its folder has it.
struct CampaignPlan {
  Provenance provenance;  ///< of the program that planned it
  int shards = 1;
  std::size_t missions = 0;

  /// The missions of shard 1 … shards: Campaign::task(first) … Campaign::task(last − 1).
  struct Missions {
    std::size_t first;
    std::size_t last;
    std::size_t count() const { return last - first; }
  };
  Missions of_shard(int shard) const;
};

CampaignPlan plan_of(const Campaign& campaign, int shards);

/// Writes the plan, the resolved missions and their routes into @p folder, which is made. A folder
/// that holds the same plan stays as it is. Throws InputError when it holds another one, unless
/// @p restart, and when it is no folder of ours.
CampaignPlan write_plan(const std::filesystem::path& folder, const Campaign& campaign, int shards,
                        bool restart);

/// Throws InputError when there is no plan or it is damaged.
CampaignPlan read_plan(const std::filesystem::path& folder);

/// The campaign of the plan, from what the folder alone holds; no route is planned again. Throws
/// InputError when a mission is not the one that was planned.
Campaign planned_campaign(const std::filesystem::path& folder);

/// Refuses another version or build of the program than the one that planned. Throws InputError.
void require_same_program(const CampaignPlan& plan);

}  // namespace vigia::evaluation
