#pragma once

#include <optional>

#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// A look of the directed camera, as far as it has come.
struct FollowedLook {
  LookId id = 0;
  LandmarkId landmark = 0;  ///< that the primary localizer took it for, or else that is looked for
  bool fused = false;       ///< the primary localizer has used an image of it
};

/// Follows a drive's looks: each belongs to the landmark with which its images are associated,
/// which need not be the one that it was meant for.
class LookFollower {
 public:
  void on_start(const mission::MissionStart& start);
  /// The look of this tick; nothing where none is on.
  std::optional<FollowedLook> process(const mission::Tick& tick);
  /// Whether the directed camera has shown something in the tick.
  bool observed(const mission::Tick& tick) const;

 private:
  std::optional<CameraId> camera_;
  std::optional<FollowedLook> look_;
};

}  // namespace vigia::app
