#include "vigia/mission/run_folder.hpp"

#include "stopwatch.hpp"
#include "tables.hpp"

namespace vigia::mission {

struct RunFolder::Impl {
  explicit Impl(const std::filesystem::path& path) : folder(path, "mission.yaml") {}

  OutputFolder folder;
  std::unique_ptr<Tables> tables;
  double busy_ms = 0.0;  ///< in the mission's ticks and in this recorder
};

RunFolder::RunFolder(const std::filesystem::path& folder) : impl_(std::make_unique<Impl>(folder)) {}

RunFolder::~RunFolder() = default;

void RunFolder::on_start(const MissionStart& start) {
  impl_->folder.add("mission.yaml", start.setup.resolved_yaml);
  impl_->tables = std::make_unique<Tables>(impl_->folder.staging(), start);
  impl_->busy_ms = 0.0;
}

void RunFolder::on_tick(const Tick& tick) {
  const Stopwatch recording;
  impl_->tables->tick(tick);
  impl_->busy_ms += tick.timing.step + recording.elapsed_ms();
}

void RunFolder::on_event(const Event& event) {
  impl_->tables->event(event);
}

void RunFolder::on_finish(Outcome /*outcome*/, Stamp end) {
  impl_->tables->close();
  impl_->folder.add("timing.json",
                    impl_->tables->timing_json(1e-3 * impl_->busy_ms, end.seconds()));
}

OutputFolder& RunFolder::folder() {
  return impl_->folder;
}

}  // namespace vigia::mission
