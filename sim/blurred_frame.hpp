#pragma once

#include "pixel_noise.hpp"

#include <memory>
#include <vector>

#include "vigia/imaging/frame.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {

/// Light that falls on the sensor at one instant, before noise and rounding.
class Radiance {
 public:
  virtual ~Radiance() = default;
  /// Adds the grey levels of @p window, row by row, to @p sum.
  virtual void add_grey(const imaging::Window& window, std::vector<float>& sum) const = 0;
  /// Adds those of a colour channel (0 red, 1 green, 2 blue).
  virtual void add_channel(const imaging::Window& window, int channel,
                           std::vector<float>& sum) const = 0;
};

/// The mean of several instants or samples of a pixel, blurred by the lens, with the noise of one
/// exposure.
class BlurredFrame : public imaging::Frame {
 public:
  /// @p lens_px: σ of the blur of the mean; 0 where the instants are blurred.
  BlurredFrame(std::vector<std::unique_ptr<Radiance>> instants, int width, int height,
               const PixelNoise& noise, const ImagingParams& params, double lens_px = 0.0);

  int width() const override { return width_; }
  int height() const override { return height_; }
  void read_grey(const imaging::Window& window, unsigned char* out,
                 std::ptrdiff_t stride) const override;
  void read_colour(const imaging::Window& window, vpRGBa* out,
                   std::ptrdiff_t stride) const override;

 private:
  /// The light of @p window, of a channel or grey, through the lens.
  template <typename Add>
  std::vector<float> light_of(const imaging::Window& window, const Add& add) const;
  /// Its rows with noise, as bytes.
  void finish(const imaging::Window& window, int channel, const std::vector<float>& light,
              unsigned char* out, std::ptrdiff_t stride) const;

  std::vector<std::unique_ptr<Radiance>> instants_;
  int width_;
  int height_;
  PixelNoise noise_;
  ImagingParams params_;
  std::vector<float> lens_;  ///< weights from the middle outwards; empty: no blur
};

}  // namespace vigia::sim
