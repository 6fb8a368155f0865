#include "cluster_scripts.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <sys/resource.h>

#include "vigia/core/error.hpp"
#include "vigia/core/shell.hpp"
#include "vigia/evaluation/campaign_run.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTried = 20;
constexpr int kMaxTasks = 1000;      // Slurm's MaxArraySize is 1001 unless the site says otherwise
constexpr double kTimeMargin = 3.0;  // nodes differ, and share their memory's bandwidth
constexpr double kMemoryMargin = 1.5;
constexpr double kStart_s = 60.0;      // of a process on a cold node
constexpr double kMission_mb = 0.016;  // what a shard keeps of a finished mission

/// The absolute name of a path; @p forbidden are characters that what reads the script cannot
/// quote.
std::string named(const fs::path& path, std::string_view forbidden) {
  std::string text = fs::absolute(path).lexically_normal().string();
  if (text.size() > 1 && text.back() == '/') text.pop_back();
  if (text.find_first_of(forbidden) != std::string::npos)
    throw InputError(fmt::format("no script can name the path {}: it has one of the characters {}",
                                 text, forbidden == "\n" ? "line feed" : forbidden));
  return text;
}

std::string program() {
  return fs::read_symlink("/proc/self/exe").string();
}

/// A value of an #SBATCH line, in which %a and the like stand for numbers.
std::string sbatch_value(const std::string& text) {
  std::string value;
  for (const char c : text) {
    if (c == '"' || c == '\\') value += '\\';
    if (c == '%') value += '%';
    value += c;
  }
  return value;
}

std::string time_limit(double seconds) {
  const auto minutes = static_cast<long>(std::ceil(seconds / 60.0));
  return fmt::format("{}:{:02}:00", minutes / 60, minutes % 60);
}

}  // namespace

TrialFigures try_shard(const evaluation::CampaignPlan& plan, const evaluation::Campaign& campaign) {
  const auto missions = plan.of_shard(1);
  std::vector<evaluation::CampaignTask> tasks;
  for (std::size_t i = missions.first; i < std::min(missions.last, missions.first + kTried); ++i)
    tasks.push_back(campaign.task(i));
  const auto begin = std::chrono::steady_clock::now();
  evaluation::run_missions(campaign, tasks, 1, [](const auto&, const auto&) {});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return {took.count() / static_cast<double>(tasks.size()),
          static_cast<double>(usage.ru_maxrss) / 1024.0};
}

std::string slurm_script(const fs::path& folder, const evaluation::CampaignPlan& plan,
                         const TrialFigures& trial, int threads) {
  const std::string where = named(folder, "\n");
  const int tasks = std::min(plan.shards, kMaxTasks);
  const int shards_a_task = (plan.shards + tasks - 1) / tasks;
  const auto missions = static_cast<double>(plan.missions) / plan.shards;
  const double shard_s = trial.mission_s * missions / threads;
  const double memory_mb =
      kMemoryMargin * trial.memory_mb + kMission_mb * missions + 32.0 * (threads - 1);
  return fmt::format(R"SH(#!/bin/bash
# Drives the shards of the campaign {0}: sbatch {1}
# A trial took {2:.3f} s a mission and {3:.0f} MB.
#SBATCH --job-name="{0}"
#SBATCH --array=1-{4}
#SBATCH --cpus-per-task={5}
#SBATCH --time={6}
#SBATCH --mem={7}M
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output="{8}/logs/%a.log"
#SBATCH --mail-type=NONE
set -euo pipefail
for ((shard = SLURM_ARRAY_TASK_ID; shard <= {9}; shard += {4})); do
  echo "shard $shard on $(hostname)"
  {10} campaign run-shard {11} "$shard" -j {5}
done
)SH",
                     plan.provenance.campaign, shell_word(where + "/slurm.sh"), trial.mission_s,
                     trial.memory_mb, tasks, threads,
                     time_limit(kStart_s + kTimeMargin * shards_a_task * shard_s),
                     64 * static_cast<long>(std::ceil(memory_mb / 64.0)), sbatch_value(where),
                     plan.shards, shell_word(named(program(), "\n")), shell_word(where));
}

std::string parallel_line(const fs::path& folder, const evaluation::CampaignPlan& plan,
                          const std::vector<std::string>& hosts, int threads) {
  // Braces are parallel's own: {} is the shard's number.
  const std::string where = named(folder, "{}\n");
  const std::string shard = fmt::format(
      "{} campaign run-shard {} {{}} -j {} >>{}/logs/{{}}.log 2>&1",
      shell_word(named(program(), "{}\n")), shell_word(where), threads, shell_word(where));
  std::string line = fmt::format("seq {} | parallel --retries 3 --joblog {}", plan.shards,
                                 shell_word(where + "/logs/parallel.log"));
  for (const std::string& host : hosts) line += " --sshlogin " + shell_word(host);
  return line + " " + shell_word(shard) + "\n";
}

}  // namespace vigia::app
