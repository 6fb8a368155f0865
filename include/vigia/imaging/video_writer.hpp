#pragma once

#include <filesystem>
#include <memory>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

namespace vigia::imaging {

/// A video that is being written, picture by picture.
class VideoWriter {
 public:
  VideoWriter() = default;
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  virtual ~VideoWriter() = default;

  /// Of the video's size.
  virtual void add(const vpImage<vpRGBa>& picture) = 0;
  /// Ends the file. Throws InputError where it does not hold every picture, as on a full disk.
  virtual void finish() = 0;
};

/// H.264 in MP4, pictures 4:2:0, which browsers play while they load it. @p width and @p height are
/// even. Throws InputError where the file cannot be made or there is no encoder.
std::unique_ptr<VideoWriter> write_video(const std::filesystem::path& mp4, int width, int height,
                                         double pictures_hz);

}  // namespace vigia::imaging
