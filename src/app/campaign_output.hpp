#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "vigia/evaluation/campaign_run.hpp"

namespace vigia::app {

/// What `evaluate` and `campaign merge` make of a finished campaign beside its folder's files.
struct CampaignOutput {
  std::string csv;     ///< empty: no copy
  std::string sqlite;  ///< empty: none
  std::string ompl;    ///< empty: none
  bool json = false;

  void add_options(CLI::App& command);
};

/// Writes results.csv, summary.json, table.md, arms.png and report.html into the folder and prints
/// the statistics. Gives the program's exit status: 1 when a mission did not arrive. @p programs as
/// campaign_json() takes them.
int write_campaign(const std::filesystem::path& folder, const evaluation::Campaign& campaign,
                   std::map<evaluation::CampaignTask, evaluation::DriveScore> finished,
                   const CampaignOutput& output, const std::vector<std::string>& programs = {});

/// Adds -j; 0 stands for all cores.
void add_threads(CLI::App& command, int& threads);
int threads_of(int asked);

}  // namespace vigia::app
