#include "frame_album.hpp"

#include "recording.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "vigia/imaging/image_frame.hpp"
#include "vigia/report/overlay.hpp"

namespace vigia::app {
namespace {

/// A tracked landmark has settled in the middle of the picture after this long.
constexpr double kSettled_s = 0.5;

}  // namespace

void FrameAlbum::on_start(const mission::MissionStart& start) {
  count_ = start.setup.recorded_frames;
  spacing_m_ = start.setup.path.length() / std::max(1, count_);
  first_eye_ = start.eyes.empty() ? nullptr : start.eyes.front();
}

void FrameAlbum::on_tick(const mission::Tick& tick) {
  if (tick.estimator.observations.empty() || tick.station_m < due_m_) return;
  if (tick.attention && tick.attention->tracked_s < kSettled_s) return;
  for (const mission::EyeTick& shown : tick.eyes) {
    if (!shown.observed || static_cast<int>(pictures_.size()) >= count_) continue;
    due_m_ = tick.station_m + spacing_m_;
    const std::string camera =
        shown.eye == first_eye_ ? "" : fmt::format("_camera{}", shown.camera);
    Picture picture{fmt::format("frame_{:03}_t{:06.2f}s{}.png", pictures_.size(),
                                tick.estimator.now.seconds(), camera),
                    imaging::colour_image(*shown.frame)};
    report::draw_overlay(picture.image, overlay_of(tick, *shown.eye));
    pictures_.push_back(std::move(picture));
  }
}

void FrameAlbum::write(const std::filesystem::path& folder) const {
  for (const auto& picture : pictures_) imaging::write_png(folder / picture.name, picture.image);
}

}  // namespace vigia::app
