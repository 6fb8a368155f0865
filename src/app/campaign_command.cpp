#include "campaign_output.hpp"
#include "campaign_progress.hpp"
#include "cluster_scripts.hpp"
#include "commands.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"
#include "vigia/core/shell.hpp"
#include "vigia/evaluation/campaign_shard.hpp"
#include "vigia/evaluation/text_table.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;
using evaluation::ShardState;
using evaluation::ShardStatus;

struct CampaignOptions {
  std::string campaign;
  std::vector<std::string> overrides;
  std::string folder;
  int shards = 0;
  int shard = 0;
  int threads = 0;
  bool slurm = false;
  bool parallel = false;
  std::vector<std::string> hosts;
  bool restart = false;
  bool any_version = false;
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
  CampaignOutput output;
};

/// A line for each shard that is not as the plan wants it, and why.
void print_unfinished(const std::vector<ShardState>& states) {
  for (const ShardState& s : states)
    if (s.status != ShardStatus::whole)
      fmt::print("shard {}: {}{}\n", s.shard, to_string(s.status),
                 s.why.empty() ? "" : ", " + s.why);
}

// ---- plan
// -----------------------------------------------------------------------------------------

/// What planning would leave of a folder that holds a plan.
void print_stale(const fs::path& folder, const evaluation::CampaignPlan& plan) {
  if (!fs::exists(folder / "plan.json")) return;
  const auto there = evaluation::read_plan(folder);
  const std::string differs = difference(plan.provenance, there.provenance, false);
  if (!differs.empty())
    fmt::print("{} holds another plan: {}\n", folder.string(), differs);
  else if (there.shards != plan.shards)
    fmt::print("{} holds a plan of {} shards\n", folder.string(), there.shards);
  print_unfinished(shard_states(folder, plan, false));
}

/// Writes the scripts that are asked for, and says how each is started.
void write_scripts(const CampaignOptions& options, const evaluation::CampaignPlan& plan,
                   const evaluation::Campaign& campaign) {
  const fs::path folder = options.folder;
  const int threads = std::max(1, options.threads);
  if (options.slurm) {
    const TrialFigures trial = try_shard(plan, campaign);
    write_file(folder / "slurm.sh", slurm_script(folder, plan, trial, threads));
    fmt::print("sbatch {}\n", shell_word((folder / "slurm.sh").string()));
  }
  if (!options.parallel && options.hosts.empty()) return;
  const std::string line = parallel_line(folder, plan, options.hosts, threads);
  write_file(folder / "parallel.sh", line);
  fmt::print("{}", line);
}

int plan_campaign(const CampaignOptions& options) {
  const auto campaign = evaluation::read_campaign(options.campaign, options.overrides);
  const fs::path folder = options.folder;
  const auto plan = options.dry_run
                        ? evaluation::plan_of(campaign, options.shards)
                        : evaluation::write_plan(folder, campaign, options.shards, options.restart);
  const std::size_t least = plan.missions / static_cast<std::size_t>(plan.shards);
  const bool even = least * static_cast<std::size_t>(plan.shards) == plan.missions;
  fmt::print("{}: {} arms × {} seeds, {} shards of {} missions\n", campaign.name,
             campaign.arms.size(), campaign.seeds, plan.shards,
             even ? std::to_string(least) : fmt::format("{} or {}", least, least + 1));
  if (options.dry_run)
    print_stale(folder, plan);
  else
    write_scripts(options, plan, campaign);
  return 0;
}

void add_plan_options(CLI::App& command, CampaignOptions& options) {
  command.add_option("campaign", options.campaign, "Campaign file (YAML)")->required();
  command.add_option("--shards", options.shards, "How many shards")
      ->required()
      ->check(CLI::Range(1, 99999));
  command.add_option("--out", options.folder, "The campaign's folder")->required();
  command.add_option("--set", options.overrides, "Override a key of the mission in every arm")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_flag("--slurm", options.slurm,
                   "Write slurm.sh, an array script with time and memory from a trial");
  command.add_flag("--parallel", options.parallel,
                   "Print the line for GNU parallel, and write it as parallel.sh");
  command
      .add_option("--ssh", options.hosts, "Hosts for GNU parallel, as its --sshlogin takes them")
      ->type_name("HOST")
      ->allow_extra_args(false);
  command.add_option("-j,--threads", options.threads, "Threads of each shard in those (default 1)")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--restart", options.restart, "Replace the plan that the folder holds");
  command.add_flag("--dry-run", options.dry_run,
                   "Write nothing; say which shards are stale, and why");
}

// ---- run-shard
// ------------------------------------------------------------------------------------

int run_shard(const CampaignOptions& options) {
  const fs::path folder = options.folder;
  const auto plan = evaluation::read_plan(folder);
  if (options.shard > plan.shards)
    throw InputError(fmt::format("found shard {}, must be 1 … {}", options.shard, plan.shards));
  if (!options.any_version) evaluation::require_same_program(plan);
  const ShardState state =
      evaluation::shard_state(folder, plan, options.shard, options.any_version);
  if (options.dry_run) {
    fmt::print("shard {}: {}, {} of {} missions{}\n", state.shard, to_string(state.status),
               state.finished, plan.of_shard(state.shard).count(),
               state.why.empty() ? "" : "; " + state.why);
    return 0;
  }
  if (state.status == ShardStatus::whole) {
    if (!options.quiet) spdlog::info("shard {} is whole already", options.shard);
    return 0;
  }
  if (!state.why.empty())
    spdlog::warn("{} is driven again: {}", evaluation::shard_file(folder, state.shard).string(),
                 state.why);
  const auto campaign = evaluation::planned_campaign(folder);
  const int threads = threads_of(options.threads);
  CampaignLine line(options.quiet);
  evaluation::run_shard(folder, plan, campaign, options.shard, threads, options.any_version,
                        std::ref(line));
  line.finish(threads);
  return 0;
}

void add_any_version(CLI::App& command, CampaignOptions& options) {
  command.add_flag("--any-version", options.any_version,
                   "Take shards of other versions and builds of the program, too");
}

void add_run_shard_options(CLI::App& command, CampaignOptions& options) {
  command.add_option("folder", options.folder, "The campaign's folder")->required();
  command.add_option("shard", options.shard, "Its number, from 1")
      ->required()
      ->check(CLI::Range(1, 99999));
  add_threads(command, options.threads);
  add_any_version(command, options);
  command.add_flag("--dry-run", options.dry_run, "Only say what would be driven, and why");
  command.add_flag("--quiet", options.quiet, "No progress line");
}

// ---- status and merge
// -----------------------------------------------------------------------------

nlohmann::ordered_json status_json(const evaluation::CampaignPlan& plan,
                                   const std::vector<ShardState>& states) {
  nlohmann::ordered_json json{
      {"campaign", plan.provenance.campaign},     {"version", plan.provenance.version},
      {"build", plan.provenance.build},           {"configuration", plan.provenance.configuration},
      {"command", plan.provenance.command},       {"missions", plan.missions},
      {"shards", nlohmann::ordered_json::array()}};
  for (const ShardState& s : states)
    json["shards"].push_back({{"shard", s.shard},
                              {"status", to_string(s.status)},
                              {"missions", plan.of_shard(s.shard).count()},
                              {"finished", s.finished},
                              {"why", s.why}});
  return json;
}

int status_of_campaign(const CampaignOptions& options) {
  const fs::path folder = options.folder;
  const auto plan = evaluation::read_plan(folder);
  const auto states = shard_states(folder, plan, options.any_version);
  if (options.json) {
    fmt::print("{}\n", status_json(plan, states).dump(2));
    return 0;
  }
  std::size_t whole = 0;
  std::size_t finished = 0;
  for (const ShardState& s : states) {
    whole += s.status == ShardStatus::whole ? 1 : 0;
    finished += s.finished;
  }
  fmt::print("{}: {} of {} shards whole, {} of {} missions finished\n", plan.provenance.campaign,
             whole, plan.shards, finished, plan.missions);
  print_unfinished(states);
  return 0;
}

int merge(const CampaignOptions& options) {
  const fs::path folder = options.folder;
  const auto plan = evaluation::read_plan(folder);
  if (!options.any_version) evaluation::require_same_program(plan);
  if (options.dry_run) {
    print_unfinished(shard_states(folder, plan, options.any_version));
    return 0;
  }
  const auto lock = evaluation::lock_folder(folder);
  const auto campaign = evaluation::planned_campaign(folder);
  auto merged = evaluation::read_shards(folder, plan, campaign, options.any_version);
  std::vector<std::string> programs;
  if (merged.programs.size() > 1) programs.assign(merged.programs.begin(), merged.programs.end());
  return write_campaign(folder, campaign, std::move(merged.finished), options.output, programs);
}

void add_folder(CLI::App& command, CampaignOptions& options) {
  command.add_option("folder", options.folder, "The campaign's folder")->required();
  add_any_version(command, options);
}

void add_status_options(CLI::App& command, CampaignOptions& options) {
  add_folder(command, options);
  command.add_flag("--json", options.json, "Print every shard's state as JSON");
}

void add_merge_options(CLI::App& command, CampaignOptions& options) {
  add_folder(command, options);
  command.add_flag("--dry-run", options.dry_run, "Only say which shards stand in the way, and why");
  options.output.add_options(command);
}

/// One command below `campaign`.
struct Step {
  const char* name;
  const char* does;
  void (*add_options)(CLI::App& command, CampaignOptions& options);
  int (*run)(const CampaignOptions& options);
};

constexpr Step kSteps[] = {
    {"plan", "Cut a campaign into shards: missions and routes into a folder", add_plan_options,
     plan_campaign},
    {"run-shard", "Drive the missions of one shard; resumes when repeated", add_run_shard_options,
     run_shard},
    {"status", "Say which shards are whole", add_status_options, status_of_campaign},
    {"merge", "Make of all shards what `vigia evaluate` makes", add_merge_options, merge},
};

}  // namespace

void add_campaign(CLI::App& app, int& status) {
  CLI::App* campaign = app.add_subcommand("campaign", "A campaign in shards, for several machines");
  campaign->require_subcommand(1);
  for (const Step& step : kSteps) {
    auto options = std::make_shared<CampaignOptions>();
    CLI::App* command = campaign->add_subcommand(step.name, step.does);
    step.add_options(*command, *options);
    command->callback([options, &status, &step] { status = step.run(*options); });
  }
}

}  // namespace vigia::app
