#include "frame_album.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "vigia/imaging/image_frame.hpp"
#include "vigia/report/overlay.hpp"

namespace vigia::app {
namespace {

/// A tracked landmark has settled in the middle of the picture after this long.
constexpr double kSettled_s = 0.5;

report::Overlay overlay_of(const mission::Tick& tick) {
  report::Overlay overlay;
  overlay.predicted = tick.predicted;
  if (tick.observation != nullptr) {
    const Intrinsics& camera = pinhole(shot_of(*tick.observation));
    if (const auto* disc = std::get_if<EllipseObservation>(tick.observation))
      overlay.measured = disc->ellipse;
    if (const auto* seen = std::get_if<PointsObservation>(tick.observation))
      for (const LabelledPoint& point : seen->points) overlay.points.push_back(point.uv);
    overlay.principal_point = Eigen::Vector2d(camera.u0, camera.v0);
  }
  overlay.lines.push_back(
      fmt::format("t = {:.2f} s   {}", tick.now.seconds(), to_string(tick.gaze)));
  if (tick.order)
    overlay.lines.push_back(fmt::format("landmark {}   look {}   zoom {:.1f} mm",
                                        tick.order->landmark, tick.look, tick.head.zoom_mm));
  if (tick.centring_px)
    overlay.lines.push_back(fmt::format("off centre {:.2f} px", *tick.centring_px));
  return overlay;
}

}  // namespace

void FrameAlbum::on_start(const mission::MissionSetup& setup, std::uint64_t /*seed*/) {
  count_ = setup.recorded_frames;
  spacing_m_ = setup.path.length() / std::max(1, count_);
}

void FrameAlbum::on_tick(const mission::Tick& tick) {
  if (static_cast<int>(pictures_.size()) >= count_) return;
  if (tick.observation == nullptr || tick.tracked_s < kSettled_s || tick.station_m < due_m_) return;
  due_m_ = tick.station_m + spacing_m_;
  Picture picture{fmt::format("frame_{:03}_t{:06.2f}s.png", pictures_.size(), tick.now.seconds()),
                  imaging::colour_image(tick.frame)};
  report::draw_overlay(picture.image, overlay_of(tick));
  pictures_.push_back(std::move(picture));
}

void FrameAlbum::write(const std::filesystem::path& folder) const {
  for (const auto& picture : pictures_) imaging::write_png(folder / picture.name, picture.image);
}

}  // namespace vigia::app
