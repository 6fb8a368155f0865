#pragma once

#include "blurred_frame.hpp"
#include "pixel_noise.hpp"
#include "scene_view.hpp"

#include <optional>
#include <vector>

namespace vigia::sim {

/// One instant of an exposure as a frame. What it sees is found when the first pixel is asked for.
class SceneFrame : public imaging::Frame, public Radiance {
 public:
  SceneFrame(const SceneContent& content, const Exposure::Instant& instant,
             const std::optional<LightNow>& light, const CameraModel& model,
             const PixelNoise& noise, const ImagingParams& params);

  int width() const override { return image_width(model_); }
  int height() const override { return image_height(model_); }

  void read_grey(const imaging::Window& window, unsigned char* out,
                 std::ptrdiff_t stride) const override;
  void read_colour(const imaging::Window& window, vpRGBa* out,
                   std::ptrdiff_t stride) const override;
  void read_grey_runs(const std::vector<imaging::Run>& runs, unsigned char* out) const override;
  void read_colour_runs(const std::vector<imaging::Run>& runs, vpRGBa* out) const override;
  void add_grey(const imaging::Window& window, std::vector<float>& sum) const override;
  void add_channel(const imaging::Window& window, int channel,
                   std::vector<float>& sum) const override;

 private:
  SceneView& view() const;
  void grey_row(const imaging::Run& run, PixelRow& row, unsigned char* out) const;
  /// Room for a channel of a row.
  struct ChannelRow {
    explicit ChannelRow(int count)
        : levels(static_cast<std::size_t>(count)), bytes(levels.size()) {}
    std::vector<float> levels;
    std::vector<unsigned char> bytes;
  };
  void colour_row(const imaging::Run& run, PixelRow& row, ChannelRow& channel, vpRGBa* out) const;

  const SceneContent& content_;
  Exposure::Instant instant_;
  std::optional<LightNow> light_;
  CameraModel model_;
  PixelNoise noise_;
  ImagingParams params_;
  mutable std::optional<SceneView> view_;
};

}  // namespace vigia::sim
