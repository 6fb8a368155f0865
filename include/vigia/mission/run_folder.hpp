#pragma once

#include <filesystem>
#include <memory>

#include "vigia/core/output_folder.hpp"
#include "vigia/mission/listener.hpp"

namespace vigia::mission {

/// Writes a run folder: mission.yaml, truth.tum, <localizer>.tum, ticks.csv, events.jsonl,
/// timing.json, timing.csv; pictures and the summary are for others to add. wall_s counts the
/// mission's ticks and this recording, not other listeners. The folder takes its name in
/// folder().commit(), or nothing stays of it.
class RunFolder : public Listener {
 public:
  /// Throws InputError when the folder can't be made or would replace something else.
  explicit RunFolder(const std::filesystem::path& folder);
  ~RunFolder() override;

  void on_start(const MissionStart& start) override;
  void on_tick(const Tick& tick) override;
  void on_event(const Event& event) override;
  void on_finish(Outcome outcome, Stamp end) override;

  OutputFolder& folder();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vigia::mission
