#pragma once

#include "recording.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vigia/mission/listener.hpp"
#include "vigia/report/foxglove.hpp"
#include "vigia/report/mcap_writer.hpp"

namespace vigia::app {

/// Writes a drive as messages of Foxglove's schemas: in every tick the frames and the poses, and at
/// most so often as asked the cameras' pictures with what their eyes made of them.
class McapRecorder : public mission::Listener {
 public:
  static constexpr double kBeliefs_hz = 5.0;  ///< of the ellipses, and of hypotheses
  static constexpr int kQuality = 80;         ///< of JPEG

  /// @p writer outlives the recorder and is the caller's to finish. @p images_hz: 0 for none.
  McapRecorder(report::McapWriter& writer, double images_hz);

  void on_start(const mission::MissionStart& start) override;
  void on_tick(const mission::Tick& tick) override;
  void on_event(const mission::Event& event) override;

 private:
  using ChannelId = report::McapWriter::ChannelId;
  struct CameraChannels {
    std::string frame;
    ChannelId image = 0;
    ChannelId annotations = 0;
    std::optional<ChannelId> calibration;  ///< nothing where the schema does not know the optics
    Schedule schedule;
    Duration delay;  ///< from an exposure to its delivery
  };
  struct LocalizerChannels {
    ChannelId pose = 0;
    ChannelId odometry = 0;
    ChannelId hypotheses = 0;
  };

  void add_camera(const Camera& camera);
  void add_localizer(const std::string& name);
  void write_frames(const mission::Tick& tick, const Eigen::Isometry3d& wMr);
  void write_beliefs(const mission::Tick& tick);
  void write_ellipses(const mission::Tick& tick);
  void write_picture(const mission::Tick& tick, const mission::EyeTick& shown);

  report::McapWriter& writer_;
  double images_hz_;
  Schedule ellipses_{1.0 / kBeliefs_hz};
  const mission::MissionSetup* setup_ = nullptr;
  Rig rig_;
  ChannelId frames_ = 0;
  ChannelId truth_ = 0;
  ChannelId beliefs_ = 0;
  ChannelId events_ = 0;
  std::map<CameraId, CameraChannels> cameras_;
  std::vector<LocalizerChannels> localizers_;  ///< in the setup's order
};

}  // namespace vigia::app
