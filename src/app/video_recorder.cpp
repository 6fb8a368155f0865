#include "video_recorder.hpp"

namespace vigia::app {

void VideoRecorder::on_start(const mission::MissionStart& start) {
  wall_.emplace(start.setup);
  const auto& picture = wall_->picture();
  video_ = imaging::write_video(mp4_, static_cast<int>(picture.getWidth()),
                                static_cast<int>(picture.getHeight()), 1.0 / start.setup.tick_s);
}

void VideoRecorder::on_tick(const mission::Tick& tick) {
  for (const mission::EyeTick& shown : tick.eyes) wall_->show(tick, shown);
  video_->add(wall_->picture());
}

void VideoRecorder::on_finish(mission::Outcome /*outcome*/, Stamp /*end*/) {
  video_->finish();
}

}  // namespace vigia::app
