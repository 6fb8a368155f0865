#pragma once

#include "camera_wall.hpp"

#include <filesystem>
#include <memory>
#include <optional>

#include "vigia/imaging/video_writer.hpp"
#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// Writes the cameras' pictures as a video with a picture for every tick: it lasts as long as the
/// mission.
class VideoRecorder : public mission::Listener {
 public:
  explicit VideoRecorder(std::filesystem::path mp4) : mp4_(std::move(mp4)) {}

  void on_start(const mission::MissionStart& start) override;
  void on_tick(const mission::Tick& tick) override;
  void on_finish(mission::Outcome outcome, Stamp end) override;

 private:
  std::filesystem::path mp4_;
  std::optional<CameraWall> wall_;
  std::unique_ptr<imaging::VideoWriter> video_;
};

}  // namespace vigia::app
