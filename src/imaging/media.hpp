#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <visp3/core/vpDisplay.h>

#include "vigia/imaging/picture_source.hpp"
#include "vigia/imaging/stream_address.hpp"
#include "vigia/imaging/video_writer.hpp"

namespace vigia::imaging {

/// Picture formats, videos, cameras and windows: what OpenCV's imgcodecs and videoio and ViSP's gui
/// do. They need 200 shared libraries, which take 0.3 s to load, and most runs of a program use
/// none of them. They stand in a module (vigia_media) that is loaded when it is first asked for.
class Media {
 public:
  Media() = default;
  Media(const Media&) = delete;
  Media& operator=(const Media&) = delete;
  virtual ~Media() = default;

  /// Grey or B, G, R; empty when @p bytes are no picture that OpenCV knows.
  virtual cv::Mat decode(std::string_view bytes) const = 0;
  /// Empty when it cannot be encoded. @p ending names the format (".png"), @p params are
  /// imencode's.
  virtual std::vector<unsigned char> encode(const std::string& ending, const cv::Mat& bgr,
                                            const std::vector<int>& params) const = 0;
  /// The pictures of a video file, with the times that it states.
  virtual std::unique_ptr<PictureSource> open_video(const std::filesystem::path& file) const = 0;
  /// A V4L2 camera, /dev/video and a number; times are those of arrival.
  virtual std::unique_ptr<PictureSource> open_device(const std::string& device,
                                                     const SourceParams& params) const = 0;
  /// A network camera, reached again when it falls silent; times are those of arrival. A recording
  /// behind an address, which states its length, ends where it ends.
  virtual std::unique_ptr<PictureSource> open_stream(const StreamAddress& address,
                                                     const SourceParams& params) const = 0;
  /// What vigia::imaging::write_video does.
  virtual std::unique_ptr<VideoWriter> write_video(const std::filesystem::path& mp4, int width,
                                                   int height, double pictures_hz) const = 0;
  /// An X window that shows @p picture. @throws vpDisplayException without a display
  virtual std::unique_ptr<vpDisplay> open_window(vpImage<vpRGBa>& picture,
                                                 const std::string& title) const = 0;
};

/// The module, loaded by the first call. @throws std::runtime_error where it is not installed
const Media& media();

}  // namespace vigia::imaging

/// What the module exports.
extern "C" const vigia::imaging::Media* vigia_media();
