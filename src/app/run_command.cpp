#include "commands.hpp"
#include "drive_picture.hpp"
#include "frame_album.hpp"
#include "interrupt.hpp"
#include "live_view.hpp"
#include "progress.hpp"
#include "replay_recorder.hpp"
#include "video_recorder.hpp"

#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/mission.hpp"
#include "vigia/mission/run_folder.hpp"

namespace vigia::app {
namespace {

constexpr const char* kVideo = "camera.mp4";

struct RunOptions {
  std::string mission;
  std::optional<std::uint64_t> seed;
  std::string out;
  std::vector<std::string> overrides;
  bool json = false;
  bool quiet = false;
  bool no_pictures = false;
  bool no_report = false;  ///< or no pictures, which it is full of
  bool video = false;
  std::string view;  ///< the pace, or empty
};

void print_summary(const evaluation::DriveScore& score, const RunOptions& options,
                   const std::string& folder) {
  fmt::print("{}  seed {}  {} after {:.1f} s\n\n", score.mission, score.seed,
             to_string(score.outcome), score.sim_s);
  fmt::print("{:<10} {:>10} {:>10} {:>10} {:>9} {:>9} {:>7} {:>8} {:>9}\n", "localizer", "final cm",
             "rms cm", "max cm", "final °", "rms °", "NEES/3", "limit cm", "lost s");
  for (const auto& [name, s] : score.localizers) {
    fmt::print(
        "{:<10} {:>10.2f} {:>10.2f} {:>10.2f} {:>9.3f} {:>9.3f} {:>7.2f} {:>8.2f} {:>9.1f}\n", name,
        100 * s.position_final_m, 100 * s.position_rmse_m, 100 * s.position_max_m,
        to_deg(s.heading_final_rad), to_deg(s.heading_rmse_rad), s.nees_mean / 3.0,
        100 * s.pcrlb_position_rms_m, s.lost_s);
  }
  const auto& p = score.perception;
  fmt::print("\n{} looks, {} stops ({:.1f} s), centring {:.2f} px rms, {:.1f} px max, {} losses\n",
             p.looks, p.stops, p.stopped_s, p.centring_rms_px, p.centring_max_px, p.target_losses);
  fmt::print("\nrun folder: {}\n", folder);
  if (!options.no_pictures) fmt::print("picture:    {}/map.png\n", folder);
  if (!options.no_report) fmt::print("replay:     {}/report.html\n", folder);
  if (options.video) fmt::print("video:      {}/{}\n", folder, kVideo);
}

/// For a shell.
std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// What repeats the run, but for where its folder lies.
std::string command_of(const RunOptions& options) {
  std::string command = "vigia run " + quoted(options.mission);
  if (options.seed) command += fmt::format(" --seed {}", *options.seed);
  for (const std::string& key : options.overrides) command += " --set " + quoted(key);
  return command;
}

int run(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  const mission::MissionSetup setup = mission::load_mission(options.mission, overrides);
  const std::string out =
      options.out.empty() ? fmt::format("runs/{}-{}", setup.name, setup.seed) : options.out;
  Interruption interruption;
  mission::RunFolder folder(out);
  evaluation::DriveScorer scorer;
  DrivePicture picture;
  FrameAlbum album;
  Progress progress(options.quiet || options.json);
  ReplayRecorder replay(scorer);
  VideoRecorder video(folder.folder().staging() / kVideo);
  LiveView view(options.view == "fast" ? Pace::fast : Pace::real);
  std::vector<mission::Listener*> listeners{&interruption, &scorer, &progress, &folder};
  if (!options.no_pictures) listeners.insert(listeners.end(), {&picture, &album});
  if (!options.no_report) listeners.push_back(&replay);
  if (options.video) listeners.push_back(&video);
  if (!options.view.empty()) listeners.push_back(&view);
  const auto outcome = mission::run_mission(setup, setup.seed, listeners);
  const std::string summary = evaluation::summary_json(scorer.score());
  folder.folder().add("summary.json", summary);
  if (!options.no_pictures) {
    folder.folder().make("frames");
    album.write(folder.folder().staging() / "frames");
    picture.draw(scorer.score(), folder.folder().staging() / "map.png");
  }
  if (!options.no_report)
    folder.folder().add("report.html", report::replay_page({replay.run(command_of(options))}));
  folder.folder().commit();
  if (options.json)
    std::cout << summary;
  else
    print_summary(scorer.score(), options, out);
  return outcome == mission::Outcome::arrived ? 0 : 1;
}

/// CLI11 alone would wrap a negative seed and cut one that is too large.
std::string seed_mistake(const std::string& text) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (digits && text.size() <= 19 && std::stoull(text) <= 9'000'000'000'000'000) return {};
  return fmt::format("found '{}', must be a whole number in [0, 9e+15]", text);
}

}  // namespace

void add_run(CLI::App& app, int& status) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run one mission and write its run folder");
  command->add_option("mission", options->mission, "Mission file (YAML)")->required();
  command->add_option("--seed", options->seed, "Seed of every random stream")
      ->check(CLI::Validator(seed_mistake, ""));
  command->add_option("--out", options->out, "Run folder (default runs/<mission>-<seed>)");
  command
      ->add_option("--set", options->overrides,
                   "Override a key of the resolved mission, e.g. --set planner.policy=random")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "Print summary.json on stdout");
  command->add_flag("--no-report", options->no_report, "Write no report.html");
  command->add_flag(
      "--no-pictures", options->no_pictures,
      "Write no frames/, no map.png and no report.html: the run starts and ends sooner");
  command->add_flag("--video", options->video,
                    "Write camera.mp4, H.264: the cameras with overlay, a picture a tick");
  command
      ->add_flag("--view{real}", options->view,
                 "Show cameras and map in a window, in real time; --view=fast as fast as the "
                 "mission goes; a right click closes the window")
      ->check(CLI::IsMember({"real", "fast"}));
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->callback([options, &status] {
    options->no_report = options->no_report || options->no_pictures;
    try {
      status = run(*options);
    } catch (const Interrupted& interrupt) {
      spdlog::error("interrupted at t = {:.1f} s of the mission; no run folder was written",
                    interrupt.at.seconds());
      status = kInterrupted;
    }
  });
}

}  // namespace vigia::app
