#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "vigia/imaging/picture_source.hpp"
#include "vigia/imaging/stream_address.hpp"

namespace vigia::imaging {

/// The pictures of a video file, with the times that it states.
std::unique_ptr<PictureSource> open_video(const std::filesystem::path& file);

/// A V4L2 camera, /dev/video and a number; times are those of arrival.
std::unique_ptr<PictureSource> open_device(const std::string& device, const SourceParams& params);

/// A network camera, reached again when it falls silent; times are those of arrival. A recording
/// behind an address, which states its length, ends where it ends.
std::unique_ptr<PictureSource> open_stream(const StreamAddress& address,
                                           const SourceParams& params);

}  // namespace vigia::imaging
