#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vigia/core/output_file.hpp"
#include "vigia/mission/listener.hpp"

namespace vigia::mission {

/// The run folder's text files that grow tick by tick: ticks.csv, *.tum, events.jsonl, timing.csv.
class Tables {
 public:
  Tables(const std::filesystem::path& folder, const MissionStart& start);

  void tick(const Tick& tick);
  void event(const Event& event);
  void close();

  /// timing.json: percentiles of each part of a tick.
  std::string timing_json(double wall_s, double sim_s) const;

 private:
  std::vector<const perception::Eye*> eyes_;
  Ground ground_;
  OutputFile ticks_;
  OutputFile events_;
  OutputFile timing_;
  OutputFile truth_;
  std::vector<OutputFile> localizers_;
  std::vector<TickTiming> timings_;
};

}  // namespace vigia::mission
