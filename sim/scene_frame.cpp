#include "scene_frame.hpp"

#include <algorithm>

namespace vigia::sim {
namespace {

using imaging::Run;
using imaging::Window;

Run row_run(const Window& window, int v) {
  return {v, window.u, window.right()};
}

int longest(const std::vector<Run>& runs) {
  int longest_run = 0;
  for (const Run& run : runs) longest_run = std::max(longest_run, run.width());
  return longest_run;
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

void SceneFrame::grey_row(const Run& run, PixelRow& row, unsigned char* out) const {
  view().see(run.u_begin, run.v, run.width(), row);
  view().expose(run.u_begin, run.v, run.width(), row, kGrey, row.grey.data());
  noise_.add_and_round(row.grey.data(), static_cast<float>(params_.noise_sigma), run.u_begin, run.v,
                       0, run.width(), out);
}

void SceneFrame::colour_row(const Run& run, PixelRow& row, ChannelRow& channel, vpRGBa* out) const {
  const int count = run.width();
  std::vector<float>& levels = channel.levels;
  std::vector<unsigned char>& bytes = channel.bytes;
  view().see(run.u_begin, run.v, count, row);
  for (int c = 0; c < 3; ++c) {
    view().expose(run.u_begin, run.v, count, row, params_.colour ? c : kGrey, levels.data());
    noise_.add_and_round(levels.data(), static_cast<float>(params_.noise_sigma), run.u_begin, run.v,
                         params_.colour ? c : 0, count, bytes.data());
    for (int i = 0; i < count; ++i) {
      (c == 0 ? out[i].R : c == 1 ? out[i].G : out[i].B) = bytes[static_cast<std::size_t>(i)];
      out[i].A = vpRGBa::alpha_default;
    }
  }
}

void SceneFrame::read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const {
  if (window.empty()) return;
  PixelRow row = view().row_of(window.width);
  for (int v = window.v; v < window.bottom(); ++v, out += stride)
    grey_row(row_run(window, v), row, out);
}

void SceneFrame::read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const {
  if (window.empty()) return;
  PixelRow row = view().row_of(window.width);
  ChannelRow channel(window.width);
  for (int v = window.v; v < window.bottom(); ++v, out += stride)
    colour_row(row_run(window, v), row, channel, out);
}

void SceneFrame::read_grey_runs(const std::vector<Run>& runs, unsigned char* out) const {
  PixelRow row = view().row_of(longest(runs));
  for (const Run& run : runs) {
    grey_row(run, row, out);
    out += run.width();
  }
}

void SceneFrame::read_colour_runs(const std::vector<Run>& runs, vpRGBa* out) const {
  PixelRow row = view().row_of(longest(runs));
  ChannelRow channel(longest(runs));
  for (const Run& run : runs) {
    colour_row(run, row, channel, out);
    out += run.width();
  }
}

void SceneFrame::add_grey(const Window& window, std::vector<float>& sum) const {
  add_channel(window, kGrey, sum);
}

void SceneFrame::add_channel(const Window& window, int channel, std::vector<float>& sum) const {
  if (window.empty()) return;
  PixelRow row = view().row_of(window.width);
  float* out = sum.data();
  for (int v = window.v; v < window.bottom(); ++v, out += window.width) {
    view().see(window.u, v, window.width, row);
    view().expose(window.u, v, window.width, row, params_.colour ? channel : kGrey,
                  row.grey.data());
    for (int i = 0; i < window.width; ++i) out[i] += row.grey[static_cast<std::size_t>(i)];
  }
}

}  // namespace vigia::sim
