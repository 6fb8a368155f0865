#include "commands.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "vigia/core/config.hpp"
#include "vigia/core/output_file.hpp"
#include "vigia/evaluation/seed_runs.hpp"
#include "vigia/evaluation/seed_statistics.hpp"

namespace vigia::app {
namespace {

struct EvaluateOptions {
  std::string campaign;
  std::vector<std::string> overrides;
  std::string csv;
  int threads = 0;
  bool quiet = false;
};

struct Campaign {
  std::string name;
  mission::MissionSetup mission;
  std::uint64_t first_seed = 1;
  int seeds = 100;
};

Campaign read_campaign(const EvaluateOptions& options) {
  const auto root = load_config(options.campaign);
  MapReader reader(root, "campaign");
  Campaign campaign;
  campaign.name = reader.text("name");
  const std::filesystem::path mission = reader.text("mission");
  const auto folder = std::filesystem::path(options.campaign).parent_path();
  MapReader seeds = reader.map("seeds");
  campaign.first_seed = static_cast<std::uint64_t>(seeds.integer("first", {0, 1e9}, 1));
  campaign.seeds = static_cast<int>(seeds.integer("count", {2, 1e6}, campaign.seeds));
  seeds.finish();
  reader.finish();
  campaign.mission = mission::load_mission(folder / mission, options.overrides);
  return campaign;
}

std::string with_interval(const evaluation::Estimate& e, double factor, int digits) {
  return fmt::format("{:.{}f} [{:.{}f}, {:.{}f}]", factor * e.value, digits,
                     factor * e.interval.low, digits, factor * e.interval.high, digits);
}

void print_statistics(const Campaign& campaign, const evaluation::SeedStatistics& s) {
  fmt::print("{}: {} seeds from {}, policy {}\n", campaign.name, s.runs, campaign.first_seed,
             campaign.mission.look.policy);
  fmt::print("arrived {} of {} [{:.1f} %, {:.1f} %], collided {}\n", s.arrived, s.runs,
             100 * s.arrived_share.low, 100 * s.arrived_share.high, s.collided);
  fmt::print("looks {}, centring {} px rms\n\n", with_interval(s.looks, 1, 1),
             with_interval(s.centring_rms_px, 1, 2));
  fmt::print("means over seeds [95 %]\n");
  for (const auto& [name, l] : s.localizers) {
    fmt::print("{}\n", name);
    fmt::print("  final position  {} cm\n", with_interval(l.position_final, 100, 2));
    fmt::print("  final heading   {} °\n", with_interval(l.heading_final, to_deg(1.0), 3));
    fmt::print("  path RMS        {} cm, the bound's {:.2f} cm\n",
               with_interval(l.position_rmse, 100, 2), 100 * l.bound_rms);
    fmt::print("  path maximum    {} cm\n", with_interval(l.position_max, 100, 2));
    fmt::print("  PCRLB ratio     {}\n", with_interval(l.pcrlb_ratio, 1, 3));
    fmt::print("  NEES per dof    {:.3f} over time", l.nees_per_dof);
    if (!l.anees.empty())
      fmt::print("; ANEES in its 95 % band at {:.0f} % of {} looks:\n                  {:.2f}",
                 100 * l.anees_in_band, l.anees.size(), fmt::join(l.anees, " "));
    fmt::print("\n");
  }
}

/// One row a seed and localizer.
void write_csv(const std::string& file, const std::vector<evaluation::DriveScore>& scores) {
  std::string text =
      "seed,outcome,sim_s,looks,stops,localizer,position_final_m,heading_final_rad,"
      "position_rmse_m,position_max_m,nees_mean,pcrlb_position_rms_m,lost_s\n";
  for (const auto& score : scores)
    for (const auto& [name, l] : score.localizers)
      text += fmt::format(
          "{},{},{:.3f},{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.6f},{:.2f}\n", score.seed,
          to_string(score.outcome), score.sim_s, score.perception.looks, score.perception.stops,
          name, l.position_final_m, l.heading_final_rad, l.position_rmse_m, l.position_max_m,
          l.nees_mean, l.pcrlb_position_rms_m, l.lost_s);
  write_file(file, text);
}

int evaluate(const EvaluateOptions& options) {
  const Campaign campaign = read_campaign(options);
  const int threads = options.threads > 0
                          ? options.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const bool progress = !options.quiet && ::isatty(STDERR_FILENO) != 0;
  int done = 0;
  const auto start = std::chrono::steady_clock::now();
  const auto scores = evaluation::run_seeds(
      campaign.mission, campaign.first_seed, campaign.seeds, threads, [&](const auto&) {
        if (progress) fmt::print(stderr, "\r{} of {} missions", ++done, campaign.seeds);
      });
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  if (progress) fmt::print(stderr, "\r{:40}\r", "");
  if (!options.csv.empty()) write_csv(options.csv, scores);
  const auto statistics = evaluation::summarise(scores);
  print_statistics(campaign, statistics);
  if (!options.quiet)
    fmt::print(stderr, "{:.1f} missions/s on {} threads\n", campaign.seeds / spent.count(),
               threads);
  return statistics.arrived == statistics.runs ? 0 : 1;
}

}  // namespace

void add_evaluate(CLI::App& app, int& status) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Drive a mission with many seeds and print the statistics");
  command->add_option("campaign", options->campaign, "Campaign file (YAML)")->required();
  command->add_option("-j,--threads", options->threads, "Threads (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--set", options->overrides, "Override a key of the mission")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--csv", options->csv, "Write one row a seed and localizer to this file");
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->callback([options, &status] { status = evaluate(*options); });
}

}  // namespace vigia::app
