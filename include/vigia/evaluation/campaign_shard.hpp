#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "vigia/evaluation/campaign_plan.hpp"
#include "vigia/evaluation/campaign_run.hpp"

namespace vigia::evaluation {

enum class ShardStatus {
  whole,    ///< finished
  begun,    ///< some missions are finished
  missing,  ///< nothing is there
  stale,    ///< of another campaign, plan or version
  damaged,  ///< cut off or changed
};
std::string_view to_string(ShardStatus status);

/// What the folder holds of a shard.
struct ShardState {
  int shard = 0;
  ShardStatus status = ShardStatus::missing;
  std::size_t finished = 0;  ///< of its missions
  std::string why;           ///< of stale and damaged
};

/// Where the folder keeps a shard that is finished.
std::filesystem::path shard_file(const std::filesystem::path& folder, int shard);

/// Looks at the ends of the shard's file, not at its missions. @p any_version: those of other
/// versions and builds count.
ShardState shard_state(const std::filesystem::path& folder, const CampaignPlan& plan, int shard,
                       bool any_version);
std::vector<ShardState> shard_states(const std::filesystem::path& folder, const CampaignPlan& plan,
                                     bool any_version);

/// Drives what the folder lacks of the shard on @p threads threads. Finished missions are appended
/// to a file of this process's own, beside those of others: what a process that was killed had
/// finished is not driven again, and two processes at once, on one machine or on two, do no harm.
/// The whole shard is written aside and renamed; whoever writes it, its bytes are the same.
void run_shard(const std::filesystem::path& folder, const CampaignPlan& plan,
               const Campaign& campaign, int shard, int threads, bool any_version,
               const std::function<void(const CampaignProgress&)>& told = {});

/// The missions of all shards.
struct MergedShards {
  std::map<CampaignTask, DriveScore> finished;
  std::set<std::string> programs;  ///< "version (build)" of those that drove them
};

/// Throws InputError naming every shard that is missing, begun, stale or damaged.
MergedShards read_shards(const std::filesystem::path& folder, const CampaignPlan& plan,
                         const Campaign& campaign, bool any_version);

}  // namespace vigia::evaluation
