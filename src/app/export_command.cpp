#include "commands.hpp"
#include "interrupt.hpp"
#include "mcap_recorder.hpp"
#include "progress.hpp"
#include "run_again.hpp"

#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "vigia/core/error.hpp"

namespace vigia::app {
namespace {

constexpr double kMostImages_hz = 1000.0;

struct ExportOptions {
  std::string folder;
  std::string mcap;
  double images_hz = 5.0;
  bool quiet = false;
};

int export_run(const ExportOptions& options) {
  if (!std::isfinite(options.images_hz))  // which CLI11 takes for one in the range
    throw InputError(fmt::format("--images-hz: found '{}', must lie in [0, {}]", options.images_hz,
                                 kMostImages_hz));
  const mission::MissionSetup setup = mission::load_mission(mission_file(options.folder));
  Interruption interruption;
  evaluation::DriveScorer scorer;
  Progress progress(options.quiet);
  report::McapWriter writer(options.mcap);
  McapRecorder recorder(writer, options.images_hz);
  run_again(options.folder, setup, scorer, {&interruption, &progress, &recorder});
  writer.finish();
  fmt::print("{}\n", options.mcap);
  return 0;
}

}  // namespace

void add_export(CLI::App& app, int& status) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export", "Drive a run folder's mission again and write it for Foxglove, Lichtblick, Rerun");
  command->add_option("folder", options->folder, "Run folder")->required();
  command->add_option("--mcap", options->mcap, "The MCAP file")->required();
  command
      ->add_option("--images-hz", options->images_hz,
                   "Pictures of each camera a second, at most (default 5); 0: none")
      ->check(CLI::Range(0.0, kMostImages_hz));
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->callback([options, &status] {
    try {
      status = export_run(*options);
    } catch (const Interrupted& interrupt) {
      spdlog::error("interrupted at t = {:.1f} s of the mission; no file was written",
                    interrupt.at.seconds());
      status = kInterrupted;
    }
  });
}

}  // namespace vigia::app
