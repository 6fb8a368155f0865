#pragma once

#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace vigia {

/// Drives a campaign of two arms whose missions end after a second, by the real program.
class ShortCampaign : public ::testing::Test {
 protected:
  using Path = std::filesystem::path;

  static constexpr const char* kResults[] = {"results.csv", "summary.json", "table.md", "arms.png",
                                             "report.html"};

  void write_campaign(int seeds, const std::string& set = "") const {
    std::ofstream(file_) << "version: 1\nname: short\nmission: " << VIGIA_SOURCE_DIR
                         << "/config/missions/armingol-room-qvga.yaml\n"
                         << "set: [timeout_s=1, planner.trigger.distance_m=0" << set << "]\n"
                         << "policies: [nearest, random]\nseeds: {count: " << seeds << "}\n";
  }
  vigia::testing::ProcessResult vigia(const std::string& arguments) const {
    return vigia::testing::run_process(std::string(VIGIA_PROGRAM) + " " + arguments, dir_.path());
  }
  vigia::testing::ProcessResult plan(const Path& folder, int shards,
                                     const std::string& more = "") const {
    return vigia("campaign plan " + file_.string() + " --shards " + std::to_string(shards) +
                 " --out " + folder.string() + " " + more);
  }
  static std::string step(const std::string& name, const Path& folder) {
    return "campaign " + name + " " + folder.string() + " ";
  }
  vigia::testing::ProcessResult run_shard(const Path& folder, int shard,
                                          const std::string& more = "") const {
    return vigia(step("run-shard", folder) + std::to_string(shard) + " -j 1 --quiet " + more);
  }
  vigia::testing::ProcessResult evaluate(const Path& folder) const {
    return vigia("evaluate " + file_.string() + " --quiet -j 2 --out " + folder.string());
  }
  nlohmann::json status(const Path& folder) const {
    return nlohmann::json::parse(vigia(step("status", folder) + "--json").out);
  }
  static Path shard(const Path& folder, int number) {
    return folder / "shards" / ("0000" + std::to_string(number) + ".jsonl");
  }
  static void expect_same_results(const Path& folder, const Path& reference) {
    for (const char* name : kResults)
      EXPECT_EQ(vigia::testing::read_text(folder / name),
                vigia::testing::read_text(reference / name))
          << name;
  }
  /// Starts the program; stdout and stderr go nowhere.
  static pid_t start(const std::string& arguments) {
    const std::string line = "exec " + std::string(VIGIA_PROGRAM) + " " + arguments;
    const pid_t child = ::fork();
    if (child != 0) return child;
    ::execl("/bin/sh", "sh", "-c", (line + " >/dev/null 2>&1").c_str(),
            static_cast<char*>(nullptr));
    ::_exit(127);
  }
  static int wait_for(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
  }
  vigia::testing::TempDir dir_;
  Path file_ = dir_.path() / "short.yaml";
  Path out_ = dir_.path() / "out";
  Path whole_ = dir_.path() / "whole";
};

}  // namespace vigia
