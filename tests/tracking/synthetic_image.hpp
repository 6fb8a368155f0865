#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpImage.h>

#include "vigia/core/observation.hpp"
#include "vigia/core/random.hpp"

namespace vigia::tracking::testing {

/// A picture in light, before noise and digitising, into which things are painted one after the
/// other. Edges are blurred by a Gaussian and then integrated over the pixel, as lens and sensor
/// do, on a three times finer grid. Nothing here uses the trackers' edge model.
class SyntheticImage {
 public:
  SyntheticImage(int width, int height, double ground, double blur = 0.7, int fine = 3);

  /// Grain (value noise of two scales) and a slope of light, rms about @p amplitude.
  void add_texture(double amplitude, std::uint64_t seed);

  /// Multiplies the light by 1 at the middle of the picture and a slope: @p per_px of it a pixel,
  /// in the direction of @p angle.
  void slope_light(double per_px, double angle);
  /// Multiplies the light.
  void expose_longer(double factor);

  /// Paints one shape that is inside where @p signed_distance (px) is positive.
  template <typename SignedDistance>
  void paint(const Ellipse& extent, double level, SignedDistance signed_distance) {
    begin_patch(extent);
    for (int y = 0; y < fine_height_; ++y)
      for (int x = 0; x < fine_width_; ++x) {
        const double d = signed_distance(Eigen::Vector2d(fine_u(x), fine_v(y))) * fine_scale_;
        fine_[fine_pixel(x, y)] = static_cast<float>(d > 0.5 ? 1.0 : d < -0.5 ? 0.0 : d + 0.5);
      }
    end_patch(level);
  }

  void paint_ellipse(const Ellipse& ellipse, double level);
  void paint_ring(const Ellipse& ellipse, double hole, double level);
  void paint_half_disc(const Ellipse& ellipse, double angle, double level);
  void paint_rectangle(double u, double v, double width, double height, double angle, double level);
  /// A dark blob of three to six overlapping discs.
  void paint_blob(double u, double v, double size, double level, RandomStream& random);
  /// Dark clutter of every kind, @p count pieces, none of them within @p clearance of @p keep_free.
  void paint_clutter(int count, const std::vector<Ellipse>& keep_free, RandomStream& random);

  /// The digitised picture with Gaussian noise.
  vpImage<unsigned char> expose(double noise, RandomStream& random) const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  std::size_t pixel(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(u);
  }
  std::size_t fine_pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(fine_width_) +
           static_cast<std::size_t>(x);
  }
  void begin_patch(const Ellipse& extent);
  void end_patch(double level);
  double fine_u(int x) const { return left_ + (x + 0.5) / fine_scale_ - 0.5; }
  double fine_v(int y) const { return top_ + (y + 0.5) / fine_scale_ - 0.5; }

  int width_;
  int height_;
  double blur_;
  int fine_scale_;
  std::vector<float> light_;
  int left_ = 0;
  int top_ = 0;
  int fine_width_ = 0;
  int fine_height_ = 0;
  std::vector<float> fine_;
  std::vector<float> across_;
};

}  // namespace vigia::tracking::testing
