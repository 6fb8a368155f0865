#pragma once

#include "stopwatch.hpp"

#include "vigia/imaging/frame.hpp"

namespace vigia::mission {

/// A frame that sums up the time spent on computing its pixels.
class TimedFrame : public imaging::Frame {
 public:
  explicit TimedFrame(const imaging::Frame& frame) : frame_(frame) {}

  int width() const override { return frame_.width(); }
  int height() const override { return frame_.height(); }
  void read_grey(const imaging::Window& window, unsigned char* out,
                 std::ptrdiff_t stride) const override {
    const Stopwatch stopwatch;
    frame_.read_grey(window, out, stride);
    render_ms_ += stopwatch.elapsed_ms();
  }
  void read_colour(const imaging::Window& window, vpRGBa* out,
                   std::ptrdiff_t stride) const override {
    const Stopwatch stopwatch;
    frame_.read_colour(window, out, stride);
    render_ms_ += stopwatch.elapsed_ms();
  }
  void read_grey_runs(const std::vector<imaging::Run>& runs, unsigned char* out) const override {
    const Stopwatch stopwatch;
    frame_.read_grey_runs(runs, out);
    render_ms_ += stopwatch.elapsed_ms();
  }
  void read_colour_runs(const std::vector<imaging::Run>& runs, vpRGBa* out) const override {
    const Stopwatch stopwatch;
    frame_.read_colour_runs(runs, out);
    render_ms_ += stopwatch.elapsed_ms();
  }
  double render_ms() const { return render_ms_; }

 private:
  const imaging::Frame& frame_;
  mutable double render_ms_ = 0.0;
};

}  // namespace vigia::mission
