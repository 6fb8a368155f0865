#pragma once

#include "look_follower.hpp"
#include "recording.hpp"

#include <map>
#include <string>
#include <vector>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/listener.hpp"
#include "vigia/report/replay_page.hpp"

namespace vigia::app {

/// Collects what the replay page shows of a drive. Beside every tick's beliefs that is at most
/// kPictures_hz small pictures a second of every camera, fewer on a long drive: at most kPictures
/// of them.
class ReplayRecorder : public mission::Listener {
 public:
  static constexpr double kPictures_hz = 5.0;
  static constexpr std::size_t kPictures = 460;
  static constexpr int kPictureWidth_px = 240;
  static constexpr int kPictureQuality = 55;  // of JPEG: noisy pictures stay below 5 kB

  /// @p scorer: of the same drive, told of every tick before this recorder.
  explicit ReplayRecorder(const evaluation::DriveScorer& scorer) : scorer_(scorer) {}

  void on_start(const mission::MissionStart& start) override;
  void on_tick(const mission::Tick& tick) override;
  void on_event(const mission::Event& event) override;

  /// The drive, once it has ended. @p command repeats it.
  report::ReplayRun run(const std::string& command) const;

 private:
  void note_cameras(const mission::Tick& tick);
  void note_picture(const mission::EyeTick& shown, double t_s);
  void thin_out(report::ReplayCamera& camera);

  const evaluation::DriveScorer& scorer_;
  const mission::MissionSetup* setup_ = nullptr;
  report::ReplayRun run_;
  LookFollower follower_;
  std::vector<Schedule> schedules_;               ///< of run_.cameras
  std::map<CameraId, std::size_t> camera_index_;  ///< into run_.cameras
};

}  // namespace vigia::app
