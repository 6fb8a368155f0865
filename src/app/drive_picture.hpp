#pragma once

#include "look_follower.hpp"

#include <filesystem>
#include <vector>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/listener.hpp"
#include "vigia/report/map_picture.hpp"

namespace vigia::app {

/// Collects what map.png shows of a drive.
class DrivePicture : public mission::Listener {
 public:
  void on_start(const mission::MissionStart& start) override;
  void on_tick(const mission::Tick& tick) override;
  void on_event(const mission::Event& event) override;

  /// What was collected, with title and figures. Refers to the mission's world.
  report::MapDrive drive(const evaluation::DriveScore& score) const;
  void draw(const evaluation::DriveScore& score, const std::filesystem::path& png) const;

 private:
  void note_look(const mission::Tick& tick);

  const mission::MissionSetup* setup_ = nullptr;
  std::vector<Pose2> truth_;
  std::vector<report::MapPose> estimate_;
  std::vector<Pose2> odometry_;
  std::vector<std::size_t> jumps_;
  std::vector<report::MapMark> marks_;
  std::vector<report::MapLook> looks_;
  LookFollower follower_;
  LookId look_ = 0;
};

}  // namespace vigia::app
