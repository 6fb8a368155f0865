#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "vigia/evaluation/campaign_plan.hpp"

namespace vigia::app {

/// What a mission took when it was tried.
struct TrialFigures {
  double mission_s = 0.0;
  double memory_mb = 0.0;  ///< the most that the process had
};

/// Drives missions of shard 1, enough for a mean, on one thread, and forgets their scores.
TrialFigures try_shard(const evaluation::CampaignPlan& plan, const evaluation::Campaign& campaign);

/// The script for sbatch: an array of at most a thousand tasks of @p threads cores each, which take
/// the shards in turn. Three times the measured time and half as much memory again are asked for.
/// Throws InputError for a folder that no script can name.
std::string slurm_script(const std::filesystem::path& folder, const evaluation::CampaignPlan& plan,
                         const TrialFigures& trial, int threads);

/// The line that drives all shards by GNU parallel, here or, where @p hosts are given, on those
/// over ssh. Throws InputError as slurm_script().
std::string parallel_line(const std::filesystem::path& folder, const evaluation::CampaignPlan& plan,
                          const std::vector<std::string>& hosts, int threads);

}  // namespace vigia::app
