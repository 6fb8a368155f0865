#pragma once

#include "event_log.hpp"

#include <map>
#include <optional>
#include <vector>

#include "vigia/core/observation.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/localization/localizer.hpp"

namespace vigia::mission {

/// Tells of the frames that the primary localizer rejects of cameras which no attention directs:
/// one event for the first of several in a row.
class UndirectedRejections {
 public:
  /// The looks of the camera that the attention directs it judges itself.
  UndirectedRejections(const EventLog& log, const Rig& rig);

  /// What became of a tick's observations.
  void judge(const std::vector<Observation>& observations,
             const std::vector<localization::UpdateResult>& results);

 private:
  const EventLog& log_;
  std::optional<CameraId> directed_;
  std::map<CameraId, int> in_a_row_;
};

}  // namespace vigia::mission
