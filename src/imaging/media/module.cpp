#include "capture_source.hpp"
#include "media.hpp"
#include "video_file_writer.hpp"

#include <opencv2/imgcodecs.hpp>
#include <visp3/gui/vpDisplayX.h>

namespace vigia::imaging {
namespace {

class LoadedMedia final : public Media {
 public:
  cv::Mat decode(std::string_view bytes) const override {
    const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1,
                      const_cast<char*>(bytes.data()));  // imdecode only reads it
    try {
      return cv::imdecode(raw, cv::IMREAD_ANYCOLOR);
    } catch (const cv::Exception&) {
      return {};
    }
  }

  std::vector<unsigned char> encode(const std::string& ending, const cv::Mat& bgr,
                                    const std::vector<int>& params) const override {
    std::vector<unsigned char> bytes;
    if (bgr.empty() || !cv::imencode(ending, bgr, bytes, params)) bytes.clear();
    return bytes;
  }

  std::unique_ptr<PictureSource> open_video(const std::filesystem::path& file) const override {
    return capture_video(file);
  }

  std::unique_ptr<PictureSource> open_device(const std::string& device,
                                             const SourceParams& params) const override {
    return capture_device(device, params);
  }

  std::unique_ptr<PictureSource> open_stream(const StreamAddress& address,
                                             const SourceParams& params) const override {
    return capture_stream(address, params);
  }

  std::unique_ptr<VideoWriter> write_video(const std::filesystem::path& mp4, int width, int height,
                                           double pictures_hz) const override {
    return video_file_writer(mp4, width, height, pictures_hz);
  }

  std::unique_ptr<vpDisplay> open_window(vpImage<vpRGBa>& picture,
                                         const std::string& title) const override {
    return std::make_unique<vpDisplayX>(picture, -1, -1, title);
  }
};

}  // namespace
}  // namespace vigia::imaging

extern "C" const vigia::imaging::Media* vigia_media() {
  static const vigia::imaging::LoadedMedia media;
  return &media;
}
