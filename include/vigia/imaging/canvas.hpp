#pragma once

#include <vector>

#include "vigia/imaging/frame.hpp"

namespace vigia::imaging {

/// A full-size grey image of which only a rectangle is computed, for trackers that read absolute
/// pixels (vpDot2). Pixels outside that rectangle hold a sentinel; a result that touches the
/// rectangle's edge is not to be trusted: widen and try again.
class Canvas {
 public:
  static constexpr unsigned char kSentinel = 255;

  /// Starts over with another exposure, which must outlive its use here. Nothing is computed.
  void attach(const Frame& frame);

  /// Computes what is missing of @p window (clipped to the frame). The computed part stays one
  /// rectangle: it becomes the union's bounding box.
  void require(const Window& window);

  /// Computes pixels in the frame without making them part of the computed rectangle.
  void require(const std::vector<Run>& runs);

  const vpImage<unsigned char>& image() const { return image_; }
  const Window& computed() const { return computed_; }
  const Frame& frame() const { return *frame_; }

  /// Whether @p window reaches pixels that are inside the frame but not computed, or the last
  /// computed column or row beside such pixels.
  bool leaves_computed(const Window& window) const;

 private:
  void fill(const Window& window);
  void wipe();

  const Frame* frame_ = nullptr;
  vpImage<unsigned char> image_;
  Window computed_;
  std::vector<Run> runs_;  ///< that hold pixels beside the rectangle
  std::vector<unsigned char> room_;
};

}  // namespace vigia::imaging
