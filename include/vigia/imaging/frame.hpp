#pragma once

#include <cstddef>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

namespace vigia::imaging {

/// A rectangle of whole pixels: columns [u, u+width), rows [v, v+height).
struct Window {
  int u = 0;
  int v = 0;
  int width = 0;
  int height = 0;

  bool empty() const { return width <= 0 || height <= 0; }
  int right() const { return u + width; }
  int bottom() const { return v + height; }
};

Window intersect(const Window& a, const Window& b);
/// The smallest window that holds both; an empty one counts for nothing.
Window unite(const Window& a, const Window& b);
bool contains(const Window& outer, const Window& inner);

/// A stretch of one row of whole pixels: columns [u_begin, u_end) of row v.
struct Run {
  int v = 0;
  int u_begin = 0;
  int u_end = 0;

  int width() const { return u_end - u_begin; }
};

/// How many pixels the runs have together.
std::size_t pixels_in(const std::vector<Run>& runs);

/// One exposure of a camera, as a function: only the pixels that are asked for are computed. A
/// window and a run equal the crop of the full frame byte for byte. const calls on one Frame come
/// from one thread.
class Frame {
 public:
  virtual ~Frame() = default;
  virtual int width() const = 0;
  virtual int height() const = 0;
  Window full() const { return {0, 0, width(), height()}; }

  /// Writes the grey values of @p window, which lies inside the frame, row by row to @p out.
  /// @p stride is the distance of two rows in @p out, in pixels.
  virtual void read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const = 0;
  virtual void read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const = 0;

  /// Writes the grey values of @p runs, which lie inside the frame and are not empty, one after the
  /// other to @p out. They are those of the full frame byte for byte; a scan along a ray or a
  /// circle pays for what it reads and little more.
  virtual void read_grey_runs(const std::vector<Run>& runs, unsigned char* out) const;
  virtual void read_colour_runs(const std::vector<Run>& runs, vpRGBa* out) const;
};

/// The whole frame, computed.
vpImage<unsigned char> grey_image(const Frame& frame);
vpImage<vpRGBa> colour_image(const Frame& frame);

}  // namespace vigia::imaging
