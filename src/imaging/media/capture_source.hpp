#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "vigia/imaging/picture_source.hpp"
#include "vigia/imaging/stream_address.hpp"

namespace vigia::imaging {

/// What Media's open_video, open_device and open_stream do.
/// @{
std::unique_ptr<PictureSource> capture_video(const std::filesystem::path& file);

std::unique_ptr<PictureSource> capture_device(const std::string& device,
                                              const SourceParams& params);

std::unique_ptr<PictureSource> capture_stream(const StreamAddress& address,
                                              const SourceParams& params);
/// @}

}  // namespace vigia::imaging
