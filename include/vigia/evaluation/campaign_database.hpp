#pragma once

#include <filesystem>
#include <vector>

#include "vigia/evaluation/campaign.hpp"
#include "vigia/evaluation/drive_score.hpp"

namespace vigia::evaluation {

/// Writes a campaign's results as one SQLite file: tables campaign, arms, missions, localizers,
/// looks and losses, whose columns docs/results.md lists. @p scores[arm][seed]. Throws InputError
/// when the file cannot be written.
void write_database(const std::filesystem::path& file, const Campaign& campaign,
                    const std::vector<std::vector<DriveScore>>& scores);

/// The results as a log of OMPL's benchmarks, for ompl_benchmark_statistics and Planner Arena: an
/// arm is a planner, a mission a run, solved is arrived and time that of the drive.
std::string ompl_benchmark_log(const Campaign& campaign,
                               const std::vector<std::vector<DriveScore>>& scores);

}  // namespace vigia::evaluation
