/// What a frame of a ceiling costs, 640×480: rendering; patches and flow of this house; and beside
/// them, on the same frames in the same run, OpenCV's phase correlation and pyramidal Lucas–Kanade.
/// Counters give each motion's error in pixels, rms over the frames (turns are left to those that
/// find them).

#include <cmath>
#include <optional>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "vigia/core/angle.hpp"
#include "vigia/evaluation/ceiling_views.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/plane_flow.hpp"

namespace vigia {
namespace {

constexpr int kFrames = 50;
constexpr double kStep_m = 0.012;  // 0.3 m/s at 25 Hz

evaluation::CeilingSetting setting() {
  evaluation::CeilingSetting hall;
  hall.ceiling.grid.placement_m = 0.005;
  return hall;
}

Pose2 pose_at(int i, double turn = 0.0) {
  return {0.3 + kStep_m * i, 0.2, turn * i};
}

/// A straight drive.
const std::vector<vpImage<unsigned char>>& pictures() {
  static const auto all = [] {
    const evaluation::CeilingHall hall(setting());
    std::vector<vpImage<unsigned char>> images;
    for (int i = 0; i < kFrames; ++i)
      images.push_back(imaging::grey_image(*hall.expose(pose_at(i), i)));
    return images;
  }();
  return all;
}

double step_px() {
  const auto known = setting().known_camera();
  return kStep_m / known.rise_m() * std::get<Intrinsics>(known.model).px;
}

cv::Mat mat_of(const vpImage<unsigned char>& image) {
  return cv::Mat(static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()), CV_8U,
                 const_cast<unsigned char*>(image.bitmap));
}

/// Squares of errors of motions, px.
class ShiftErrors {
 public:
  /// @p moved: how what is seen moved; the camera went along u.
  void add(double du, double dv) {
    const double off_u = du + step_px();
    square_ += off_u * off_u + dv * dv;
    ++n_;
  }
  void report(benchmark::State& state) const {
    state.counters["rms_px"] = n_ > 0 ? std::sqrt(square_ / n_) : -1.0;
    state.counters["matched"] = n_;
  }

 private:
  double square_ = 0.0;
  int n_ = 0;
};

void render(benchmark::State& state) {
  const evaluation::CeilingHall hall(setting());
  int i = 0;
  for (auto _ : state) {
    auto image = imaging::grey_image(*hall.expose(pose_at(i % kFrames), i));
    benchmark::DoNotOptimize(image.bitmap);
    ++i;
  }
}
BENCHMARK(render)->Unit(benchmark::kMillisecond);

void patches(benchmark::State& state) {
  const tracking::PatchFinder finder(setting().finder());
  std::size_t i = 0;
  std::size_t found = 0;
  for (auto _ : state) {
    found += finder.find(imaging::ImageFrame(pictures()[i % kFrames])).patches.size();
    ++i;
  }
  state.counters["patches"] = static_cast<double>(found) / static_cast<double>(i);
}
BENCHMARK(patches)->Unit(benchmark::kMillisecond);

void patches_and_flow(benchmark::State& state) {
  const auto hall = setting();
  const auto known = hall.known_camera();
  const tracking::PatchFinder finder(hall.finder());
  const double focal = std::get<Intrinsics>(known.model).px;
  ShiftErrors errors;
  std::optional<tracking::FrameFlow> flow;
  std::size_t i = 0;
  for (auto _ : state) {
    if (i % kFrames == 0) flow.emplace(known.model, known.rMc.linear());
    const auto& picture = pictures()[i++ % kFrames];
    benchmark::DoNotOptimize(finder.find(imaging::ImageFrame(picture)));
    const auto step = flow->next(picture);
    if (step) errors.add(-focal * step->shift.x(), -focal * step->shift.y());
  }
  errors.report(state);
}
BENCHMARK(patches_and_flow)->Unit(benchmark::kMillisecond);

void opencv_phase_correlate(benchmark::State& state) {
  cv::setNumThreads(1);
  cv::Mat window;
  cv::createHanningWindow(window, cv::Size(640, 480), CV_32F);
  ShiftErrors errors;
  cv::Mat before;
  std::size_t i = 0;
  for (auto _ : state) {
    cv::Mat now;
    mat_of(pictures()[i % kFrames]).convertTo(now, CV_32F);
    if (i % kFrames != 0) {
      const cv::Point2d moved = cv::phaseCorrelate(before, now, window);
      errors.add(moved.x, moved.y);
    }
    before = now;
    ++i;
  }
  errors.report(state);
}
BENCHMARK(opencv_phase_correlate)->Unit(benchmark::kMillisecond);

/// 200 corners, found anew in every frame, as a program that follows nothing longer would.
void opencv_lucas_kanade(benchmark::State& state) {
  cv::setNumThreads(1);
  ShiftErrors errors;
  cv::Mat before;
  std::size_t i = 0;
  for (auto _ : state) {
    const cv::Mat now = mat_of(pictures()[i % kFrames]);
    if (i % kFrames != 0) {
      std::vector<cv::Point2f> from;
      cv::goodFeaturesToTrack(before, from, 200, 0.01, 10);
      std::vector<cv::Point2f> to;
      std::vector<unsigned char> status;
      cv::calcOpticalFlowPyrLK(before, now, from, to, status, cv::noArray());
      const cv::Mat motion = cv::estimateAffinePartial2D(from, to);
      if (!motion.empty()) {
        // At the picture's middle.
        const double u = 319.5;
        const double v = 239.5;
        errors.add(
            motion.at<double>(0, 0) * u + motion.at<double>(0, 1) * v + motion.at<double>(0, 2) - u,
            motion.at<double>(1, 0) * u + motion.at<double>(1, 1) * v + motion.at<double>(1, 2) -
                v);
      }
    }
    before = now;
    ++i;
  }
  errors.report(state);
}
BENCHMARK(opencv_lucas_kanade)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vigia

BENCHMARK_MAIN();
