#pragma once

#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

/// The colour pixels of one window of a frame.
class ColourBlock {
 public:
  /// Reads @p window, which lies inside the frame.
  void read(const imaging::Frame& frame, const imaging::Window& window);

  const imaging::Window& window() const { return window_; }
  /// Pixels of row @p v, from the window's first column on.
  const vpRGBa* row(int v) const {
    return pixels_.data() + static_cast<std::ptrdiff_t>(v - window_.v) * window_.width;
  }

  /// The luma (Rec. 709), with its first pixel at the window's corner.
  void luma(vpImage<unsigned char>& out) const;

 private:
  imaging::Window window_;
  std::vector<vpRGBa> pixels_;
};

/// Means over squares of two by two pixels: half the size, a quarter of the noise's variance. An
/// odd last row or column is left out.
void halve(vpImage<unsigned char>& image, vpImage<unsigned char>& out);

}  // namespace vigia::tracking
