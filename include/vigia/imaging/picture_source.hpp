#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vigia/imaging/frame.hpp"

namespace vigia::imaging {

/// One picture of a sequence.
struct Picture {
  std::string name;              ///< the file's path, or the input's name and the picture's number
  std::optional<double> time_s;  ///< since the first picture of a video or camera
  std::unique_ptr<Frame> frame;
};

struct SourceParams {
  double timeout_s = 10.0;     ///< of a live camera's opening, and of each picture
  int reconnections = 3;       ///< attempts in a row to reach a live camera again
  double reconnect_s = 1.0;    ///< pause before each of them
  std::function<bool()> stop;  ///< asked while waiting; true ends the sequence
};

/// Pictures one after the other.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  /// The next picture; nothing at the end. Throws InputError for a picture that cannot be read and
  /// for a camera that is lost.
  virtual std::optional<Picture> next() = 0;
};

/// Opens what @p input names:
///   -                         pictures on stdin, one after the other (JPEG, PNG, binary PNM)
///   rtsp://…  http://…        a live camera (see parse_address())
///   /dev/video0               a V4L2 camera
///   a folder                  its pictures in the order of their names
///   frames/%04d.png           the files that have a number there, in its order (%d: any width)
///   a video, a picture
/// Throws InputError when there is no such thing.
std::unique_ptr<PictureSource> open_pictures(const std::string& input,
                                             const SourceParams& params = {});

/// The files of a folder whose names are @p pattern's with a number in place of its one %d or %0Nd,
/// in the order of the numbers. Throws InputError when the pattern has no such place or two, or no
/// file fits it.
std::vector<std::filesystem::path> numbered_files(const std::string& pattern);

}  // namespace vigia::imaging
