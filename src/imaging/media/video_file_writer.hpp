#pragma once

#include <filesystem>
#include <memory>

#include "vigia/imaging/video_writer.hpp"

namespace vigia::imaging {

/// What Media's write_video does.
std::unique_ptr<VideoWriter> video_file_writer(const std::filesystem::path& mp4, int width,
                                               int height, double pictures_hz);

}  // namespace vigia::imaging
