#include "vigia/imaging/frame.hpp"

#include <algorithm>

namespace vigia::imaging {

Window intersect(const Window& a, const Window& b) {
  const int u = std::max(a.u, b.u);
  const int v = std::max(a.v, b.v);
  return {u, v, std::max(0, std::min(a.right(), b.right()) - u),
          std::max(0, std::min(a.bottom(), b.bottom()) - v)};
}

Window unite(const Window& a, const Window& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int u = std::min(a.u, b.u);
  const int v = std::min(a.v, b.v);
  return {u, v, std::max(a.right(), b.right()) - u, std::max(a.bottom(), b.bottom()) - v};
}

bool contains(const Window& outer, const Window& inner) {
  return inner.empty() || (inner.u >= outer.u && inner.v >= outer.v &&
                           inner.right() <= outer.right() && inner.bottom() <= outer.bottom());
}

std::size_t pixels_in(const std::vector<Run>& runs) {
  std::size_t count = 0;
  for (const Run& run : runs) count += static_cast<std::size_t>(run.width());
  return count;
}

void Frame::read_grey_runs(const std::vector<Run>& runs, unsigned char* out) const {
  for (const Run& run : runs) {
    read_grey({run.u_begin, run.v, run.width(), 1}, out, run.width());
    out += run.width();
  }
}

void Frame::read_colour_runs(const std::vector<Run>& runs, vpRGBa* out) const {
  for (const Run& run : runs) {
    read_colour({run.u_begin, run.v, run.width(), 1}, out, run.width());
    out += run.width();
  }
}

vpImage<unsigned char> grey_image(const Frame& frame) {
  vpImage<unsigned char> image(static_cast<unsigned>(frame.height()),
                               static_cast<unsigned>(frame.width()));
  frame.read_grey(frame.full(), image.bitmap, frame.width());
  return image;
}

vpImage<vpRGBa> colour_image(const Frame& frame) {
  vpImage<vpRGBa> image(static_cast<unsigned>(frame.height()),
                        static_cast<unsigned>(frame.width()));
  frame.read_colour(frame.full(), image.bitmap, frame.width());
  return image;
}

}  // namespace vigia::imaging
