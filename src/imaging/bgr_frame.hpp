#pragma once

#include <opencv2/core/mat.hpp>

#include "vigia/imaging/frame.hpp"

namespace vigia::imaging {

/// A picture as OpenCV captures it, grey or B, G, R; converted only where it is read. Grey from
/// colour to the byte as ViSP converts it, on the calling thread.
class BgrFrame : public Frame {
 public:
  explicit BgrFrame(cv::Mat bgr);

  int width() const override { return bgr_.cols; }
  int height() const override { return bgr_.rows; }
  void read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const override;
  void read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const override;

 private:
  cv::Mat bgr_;
};

}  // namespace vigia::imaging
