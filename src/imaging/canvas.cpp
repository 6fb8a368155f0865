#include "vigia/imaging/canvas.hpp"

#include <algorithm>

namespace vigia::imaging {

void Canvas::attach(const Frame& frame) {
  const auto rows = static_cast<unsigned>(frame.height());
  const auto columns = static_cast<unsigned>(frame.width());
  if (image_.getHeight() != rows || image_.getWidth() != columns) {
    image_.resize(rows, columns, kSentinel);
  } else {
    wipe();
  }
  frame_ = &frame;
  computed_ = {};
  runs_.clear();
}

void Canvas::wipe() {
  for (int v = computed_.v; v < computed_.bottom(); ++v)
    std::fill_n(image_[static_cast<unsigned>(v)] + computed_.u, computed_.width, kSentinel);
  for (const Run& run : runs_)
    std::fill_n(image_[static_cast<unsigned>(run.v)] + run.u_begin, run.width(), kSentinel);
}

void Canvas::require(const std::vector<Run>& runs) {
  const auto is_computed = [&](const Run& run) {
    return contains(computed_, {run.u_begin, run.v, run.width(), 1});
  };
  if (std::all_of(runs.begin(), runs.end(), is_computed)) return;
  room_.resize(pixels_in(runs));
  frame_->read_grey_runs(runs, room_.data());
  const unsigned char* next = room_.data();
  for (const Run& run : runs) {
    std::copy_n(next, run.width(), image_[static_cast<unsigned>(run.v)] + run.u_begin);
    next += run.width();
  }
  runs_.insert(runs_.end(), runs.begin(), runs.end());
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
