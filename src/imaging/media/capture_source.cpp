#include "capture_source.hpp"

#include "bgr_frame.hpp"
#include "opencv_log.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>
#include <vector>

#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

#include "vigia/core/error.hpp"

namespace vigia::imaging {
namespace {

using Clock = std::chrono::steady_clock;

std::string numbered(const std::string& label, int number) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "#%05d", number);
  return label + digits;
}

bool has_ffmpeg() {
  const auto back_ends = cv::videoio_registry::getStreamBackends();
  return std::find(back_ends.begin(), back_ends.end(), cv::CAP_FFMPEG) != back_ends.end();
}

class VideoFile : public PictureSource {
 public:
  explicit VideoFile(const std::filesystem::path& file) : file_(file) {
    silence_opencv();
    // An absolute path is neither an address nor an option of a back end.
    const std::string path = std::filesystem::absolute(file).string();
    if (!capture_.open(path, cv::CAP_FFMPEG)) capture_.open(path, cv::CAP_GSTREAMER);
    if (!capture_.isOpened()) throw InputError({file.string()}, "no video that can be read");
  }

  std::optional<Picture> next() override {
    cv::Mat bgr;
    if (!capture_.read(bgr) || bgr.empty()) {
      if (number_ == 0) throw InputError({file_.string()}, "a video without a picture");
      return std::nullopt;
    }
    ++number_;
    return Picture{numbered(file_.stem().string(), number_), time_of_picture(),
                   std::make_unique<BgrFrame>(std::move(bgr))};
  }

 private:
  // Streams without a container, as MPEG-1 video, lack time stamps, at their end at least: such
  // pictures follow at the stated rate.
  std::optional<double> time_of_picture() {
    constexpr double kLongestGap = 3600.0;  // s; what lies further ahead is no stamp
    const double stamp_s = 1e-3 * capture_.get(cv::CAP_PROP_POS_MSEC);
    const double rate = capture_.get(cv::CAP_PROP_FPS);
    if (number_ == 1)
      first_s_ = last_s_ = stamp_s;
    else if (stamp_s > last_s_ && stamp_s < last_s_ + kLongestGap)
      last_s_ = stamp_s;
    else if (rate > 0.0)
      last_s_ += 1.0 / rate;
    else
      return std::nullopt;
    return last_s_ - first_s_;
  }

  std::filesystem::path file_;
  cv::VideoCapture capture_;
  double first_s_ = 0.0;
  double last_s_ = 0.0;
  int number_ = 0;
};

/// A camera that gives pictures as time goes by.
class LiveCamera : public PictureSource {
 public:
  LiveCamera(StreamAddress address, int back_end, const SourceParams& params)
      : address_(std::move(address)), back_end_(back_end), params_(params) {
    silence_opencv();
    if (!open()) throw InputError({address_.label}, "no camera that can be opened");
  }

  std::optional<Picture> next() override {
    cv::Mat bgr;
    while (!stopped() && (!capture_.read(bgr) || bgr.empty())) {
      if (stopped() || is_recording()) return std::nullopt;
      if (!reach_again())
        throw InputError({address_.label},
                         "the camera gives no more pictures and cannot be "
                         "reached again");
    }
    if (stopped()) return std::nullopt;
    const Clock::time_point now = Clock::now();
    if (number_ == 0) first_ = now;
    return Picture{numbered(address_.label, ++number_),
                   std::chrono::duration<double>(now - first_).count(),
                   std::make_unique<BgrFrame>(std::move(bgr))};
  }

 private:
  bool open() {
    if (back_end_ == cv::CAP_V4L2) return capture_.open(address_.url, back_end_);
    const int timeout_ms = static_cast<int>(1e3 * params_.timeout_s);
    return capture_.open(address_.url, cv::CAP_FFMPEG,
                         {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, timeout_ms,
                          cv::CAP_PROP_READ_TIMEOUT_MSEC, timeout_ms}) ||
           (!has_ffmpeg() && capture_.open(address_.url, cv::CAP_GSTREAMER));
  }

  // Streams state no length, or a negative one.
  bool is_recording() const { return capture_.get(cv::CAP_PROP_FRAME_COUNT) > 0.0; }
  bool stopped() const { return params_.stop && params_.stop(); }

  bool reach_again() {
    for (int attempt = 0; attempt < params_.reconnections && !stopped(); ++attempt) {
      capture_.release();
      std::this_thread::sleep_for(std::chrono::duration<double>(params_.reconnect_s));
      if (!stopped() && open()) return true;
    }
    return stopped();
  }

  StreamAddress address_;
  int back_end_;
  SourceParams params_;
  cv::VideoCapture capture_;
  Clock::time_point first_;
  int number_ = 0;
};

}  // namespace

std::unique_ptr<PictureSource> capture_video(const std::filesystem::path& file) {
  return std::make_unique<VideoFile>(file);
}

std::unique_ptr<PictureSource> capture_device(const std::string& device,
                                              const SourceParams& params) {
  return std::make_unique<LiveCamera>(StreamAddress{device, device}, cv::CAP_V4L2, params);
}

std::unique_ptr<PictureSource> capture_stream(const StreamAddress& address,
                                              const SourceParams& params) {
  return std::make_unique<LiveCamera>(address, cv::CAP_FFMPEG, params);
}

}  // namespace vigia::imaging
