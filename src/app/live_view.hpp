#pragma once

#include "camera_wall.hpp"
#include "overlay_window.hpp"

#include <chrono>
#include <map>
#include <optional>

#include "vigia/mission/listener.hpp"
#include "vigia/report/live_map.hpp"

namespace vigia::app {

enum class Pace { real, fast };  ///< in real time, or as fast as it goes

/// A window with a mission's cameras and map as it is driven. Where there is no display, a warning
/// says so and the mission goes on without; a right click closes the window.
class LiveView : public mission::Listener {
 public:
  explicit LiveView(Pace pace) : pace_(pace) {}

  void on_start(const mission::MissionStart& start) override;
  void on_tick(const mission::Tick& tick) override;

 private:
  using Clock = std::chrono::steady_clock;

  void show(const mission::Tick& tick);
  void wait_until(Stamp now);

  Pace pace_;
  std::optional<OverlayWindow> window_;  ///< nothing once it is closed
  std::optional<CameraWall> wall_;
  std::optional<report::LiveMap> map_;
  std::map<CameraId, Clock::time_point> due_;  ///< when a camera's next picture is worth computing
  Clock::time_point next_;                     ///< when the window's next picture is
  Clock::time_point start_;                    ///< of the mission, on the clock
};

}  // namespace vigia::app
