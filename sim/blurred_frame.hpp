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

/// The mean of several instants, with the noise of one exposure.
class BlurredFrame : public imaging::Frame {
 public:
  BlurredFrame(std::vector<std::unique_ptr<Radiance>> instants, int width, int height,
               const PixelNoise& noise, const ImagingParams& params);

  int width() const override { return width_; }
  int height() const override { return height_; }
  void read_grey(const imaging::Window& window, unsigned char* out,
                 std::ptrdiff_t stride) const override;
  void read_colour(const imaging::Window& window, vpRGBa* out,
                   std::ptrdiff_t stride) const override;

 private:
  /// The mean's rows with noise, as bytes.
  void finish(const imaging::Window& window, int channel, std::vector<float>& sum,
              unsigned char* out, std::ptrdiff_t stride) const;

  std::vector<std::unique_ptr<Radiance>> instants_;
  int width_;
  int height_;
  PixelNoise noise_;
  ImagingParams params_;
};

}  // namespace vigia::sim
