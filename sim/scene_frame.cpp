#include "scene_frame.hpp"

#include <algorithm>

namespace vigia::sim {
namespace {

using imaging::Run;
using imaging::Window;

int longest(const std::vector<Run>& runs) {
  int longest_run = 0;
  for (const Run& run : runs) longest_run = std::max(longest_run, run.width());
  return longest_run;
}

Window bounds_of(const std::vector<Run>& runs) {
  Window bounds;
  for (const Run& run : runs) bounds = unite(bounds, {run.u_begin, run.v, run.width(), 1});
  return bounds;
}

/// Pixels of the largest batch: of a row or of a tile.
std::size_t room_for(int width) {
  return static_cast<std::size_t>(std::max(width, kTile * kTile));
}

}  // namespace

SceneFrame::SceneFrame(const SceneContent& content, const Exposure::Instant& instant,
                       const std::optional<LightNow>& light, const CameraModel& model,
                       const PixelNoise& noise, const ImagingParams& params)
    : content_(content),
      instant_(instant),
      light_(light),
      model_(model),
      noise_(noise),
      params_(params) {}

SceneView& SceneFrame::view() const {
  if (!view_) view_.emplace(content_, instant_, light_, model_, params_);
  return *view_;
}

template <typename Use>
void SceneFrame::for_each_tile(const TileBatches& batches, const Use& use) const {
  PixelRow row = view().row_of(kTile * kTile);
  for (std::size_t i = 0; i < batches.size(); ++i) {
    row.take(batches[i]);
    use(row);
  }
}

template <typename Use>
void SceneFrame::for_each_batch(const Window& window, std::ptrdiff_t stride, const Use& use) const {
  if (window.empty()) return;
  view().expect(window);
  if (!is_perspective(model_)) {
    for_each_tile(TileBatches(window, stride, width()), use);
    return;
  }
  PixelRow row = view().row_of(window.width);
  for (int v = window.v; v < window.bottom(); ++v) {
    const Piece piece{window.u, v, window.width, (v - window.v) * stride};
    row.take({&piece, &piece + 1});
    use(row);
  }
}

template <typename Use>
void SceneFrame::for_each_batch(const std::vector<Run>& runs, const Use& use) const {
  view().expect(bounds_of(runs));
  if (!is_perspective(model_)) {
    for_each_tile(TileBatches(runs, width()), use);
    return;
  }
  PixelRow row = view().row_of(longest(runs));
  std::ptrdiff_t out = 0;
  for (const Run& run : runs) {
    const Piece piece{run.u_begin, run.v, run.width(), out};
    row.take({&piece, &piece + 1});
    use(row);
    out += run.width();
  }
}

void SceneFrame::add_noise(const PixelRow& row, int channel, const float* levels,
                           unsigned char* bytes) const {
  const auto sigma = static_cast<float>(params_.noise_sigma);
  if (is_perspective(model_)) {
    const Piece& piece = row.pieces.front();
    noise_.add_and_round(levels, sigma, piece.u, piece.v, channel, row.count, bytes);
    return;
  }
  std::vector<std::uint32_t>& keys = row_keys_[static_cast<std::size_t>(channel)];
  if (keys.empty()) keys = noise_.row_keys(channel, height());
  PixelNoise::add_and_round(levels, sigma, keys.data(), row.u.data(), row.v.data(), row.count,
                            bytes);
}

void SceneFrame::expose_grey(PixelRow& row, ChannelRow& room, unsigned char* out) const {
  view().see(row);
  view().expose(row, kGrey, row.grey.data());
  add_noise(row, 0, row.grey.data(), room.bytes.data());
  const unsigned char* byte = room.bytes.data();
  for (const Piece& piece : row.pieces) {
    std::copy_n(byte, piece.count, out + piece.out);
    byte += piece.count;
  }
}

void SceneFrame::expose_colour(PixelRow& row, ChannelRow& room, vpRGBa* out) const {
  view().see(row);
  for (int c = 0; c < 3; ++c) {
    view().expose(row, params_.colour ? c : kGrey, room.levels.data());
    add_noise(row, params_.colour ? c : 0, room.levels.data(), room.bytes.data());
    const unsigned char* byte = room.bytes.data();
    for (const Piece& piece : row.pieces) {
      vpRGBa* pixel = out + piece.out;
      for (int i = 0; i < piece.count; ++i, ++byte, ++pixel) {
        (c == 0 ? pixel->R : c == 1 ? pixel->G : pixel->B) = *byte;
        pixel->A = vpRGBa::alpha_default;
      }
    }
  }
}

void SceneFrame::read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const {
  ChannelRow room(room_for(window.width));
  for_each_batch(window, stride, [&](PixelRow& row) { expose_grey(row, room, out); });
}

void SceneFrame::read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const {
  ChannelRow room(room_for(window.width));
  for_each_batch(window, stride, [&](PixelRow& row) { expose_colour(row, room, out); });
}

void SceneFrame::read_grey_runs(const std::vector<Run>& runs, unsigned char* out) const {
  ChannelRow room(room_for(longest(runs)));
  for_each_batch(runs, [&](PixelRow& row) { expose_grey(row, room, out); });
}

void SceneFrame::read_colour_runs(const std::vector<Run>& runs, vpRGBa* out) const {
  ChannelRow room(room_for(longest(runs)));
  for_each_batch(runs, [&](PixelRow& row) { expose_colour(row, room, out); });
}

void SceneFrame::add_grey(const Window& window, std::vector<float>& sum) const {
  add_channel(window, kGrey, sum);
}

void SceneFrame::add_channel(const Window& window, int channel, std::vector<float>& sum) const {
  for_each_batch(window, window.width, [&](PixelRow& row) {
    view().see(row);
    view().expose(row, params_.colour ? channel : kGrey, row.grey.data());
    const float* level = row.grey.data();
    for (const Piece& piece : row.pieces)
      for (int i = 0; i < piece.count; ++i)
        sum[static_cast<std::size_t>(piece.out + i)] += *level++;
  });
}

}  // namespace vigia::sim
