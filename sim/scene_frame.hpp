#pragma once

#include "blurred_frame.hpp"
#include "pixel_noise.hpp"
#include "scene_view.hpp"
#include "tile_batches.hpp"

#include <array>
#include <cstdint>
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
  /// Calls use(row) with what is asked for, in batches of pixels that are computed together.
  template <typename Use>
  void for_each_batch(const imaging::Window& window, std::ptrdiff_t stride, const Use& use) const;
  template <typename Use>
  void for_each_batch(const std::vector<imaging::Run>& runs, const Use& use) const;
  template <typename Use>
  void for_each_tile(const TileBatches& batches, const Use& use) const;

  /// Room for a channel of a batch.
  struct ChannelRow {
    explicit ChannelRow(std::size_t most) : levels(most), bytes(most) {}
    std::vector<float> levels;
    std::vector<unsigned char> bytes;
  };
  void expose_grey(PixelRow& row, ChannelRow& room, unsigned char* out) const;
  void expose_colour(PixelRow& row, ChannelRow& room, vpRGBa* out) const;
  void add_noise(const PixelRow& row, int channel, const float* levels, unsigned char* bytes) const;

  const SceneContent& content_;
  Exposure::Instant instant_;
  std::optional<LightNow> light_;
  CameraModel model_;
  PixelNoise noise_;
  ImagingParams params_;
  mutable std::optional<SceneView> view_;
  mutable std::array<std::vector<std::uint32_t>, 3> row_keys_;  ///< of the channels' noise
};

}  // namespace vigia::sim
