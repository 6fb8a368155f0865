#include "video_file_writer.hpp"

#include "fast_start.hpp"
#include "opencv_log.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <opencv2/videoio.hpp>
#include <visp3/core/vpImageConvert.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"

namespace vigia::imaging {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class H264File : public VideoWriter {
 public:
  H264File(std::filesystem::path mp4, int width, int height, double pictures_hz)
      : file_(std::move(mp4)) {
    silence_opencv();
    // An absolute path is neither an address nor an option of the back end.
    const std::string path = std::filesystem::absolute(file_).string();
    if (!writer_.open(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('a', 'v', 'c', '1'),
                      pictures_hz, {width, height}))
      throw InputError("cannot write " + file_.string() +
                       ": OpenCV's ffmpeg makes no H.264 file there");
  }

  void add(const vpImage<vpRGBa>& picture) override {
    vpImageConvert::convert(picture, bgr_);
    writer_.write(bgr_);
    ++pictures_;
  }

  // The writer says nothing of what it could not write.
  void finish() override {
    writer_.release();
    const cv::VideoCapture written(std::filesystem::absolute(file_).string(), cv::CAP_FFMPEG);
    const auto held = written.isOpened() ? std::lround(written.get(cv::CAP_PROP_FRAME_COUNT)) : 0;
    if (held != pictures_)
      throw InputError("cannot write " + file_.string() + ": " + std::to_string(held) + " of " +
                       std::to_string(pictures_) + " pictures are in it; is the disk full?");
    write_file(file_, with_index_first(bytes_of(file_)));
  }

 private:
  std::filesystem::path file_;
  cv::VideoWriter writer_;
  cv::Mat bgr_;
  long pictures_ = 0;
};

}  // namespace

std::unique_ptr<VideoWriter> video_file_writer(const std::filesystem::path& mp4, int width,
                                               int height, double pictures_hz) {
  return std::make_unique<H264File>(mp4, width, height, pictures_hz);
}

}  // namespace vigia::imaging
