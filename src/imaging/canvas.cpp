#include "vigia/imaging/canvas.hpp"

#include <algorithm>

namespace vigia::imaging {

void Canvas::attach(const Frame& frame) {
  const auto rows = static_cast<unsigned>(frame.height());
  const auto columns = static_cast<unsigned>(frame.width());
  if (image_.getHeight() != rows || image_.getWidth() != columns) {
    image_.resize(rows, columns, kSentinel);
  } else {
    for (int v = computed_.v; v < computed_.bottom(); ++v)
      std::fill_n(image_[static_cast<unsigned>(v)] + computed_.u, computed_.width, kSentinel);
  }
  frame_ = &frame;
  computed_ = {};
}

void Canvas::require(const Window& window) {
  const Window wanted =
      intersect(unite(computed_, intersect(window, frame_->full())), frame_->full());
  if (contains(computed_, wanted)) return;
  if (computed_.empty()) {
    fill(wanted);
  } else {
    // The union's bounding box is the old rectangle and up to four strips round it.
    const Window& old = computed_;
    fill({wanted.u, wanted.v, wanted.width, old.v - wanted.v});
    fill({wanted.u, old.bottom(), wanted.width, wanted.bottom() - old.bottom()});
    fill({wanted.u, old.v, old.u - wanted.u, old.height});
    fill({old.right(), old.v, wanted.right() - old.right(), old.height});
  }
  computed_ = wanted;
}

void Canvas::fill(const Window& window) {
  if (window.empty()) return;
  frame_->read_grey(window, image_[static_cast<unsigned>(window.v)] + window.u, frame_->width());
}

bool Canvas::leaves_computed(const Window& window) const {
  const auto beyond = [](int low, int high, int inner_low, int inner_high, int limit) {
    return (inner_low > 0 && low <= inner_low) || (inner_high < limit && high >= inner_high);
  };
  return beyond(window.u, window.right(), computed_.u, computed_.right(), frame_->width()) ||
         beyond(window.v, window.bottom(), computed_.v, computed_.bottom(), frame_->height());
}

}  // namespace vigia::imaging
