#pragma once

#include <filesystem>

namespace vigia::app {

/// The folder with the missions, worlds and robots that come with the program: @p given when it is
/// not empty, else the installed one beside the program, the source tree's above a build, or
/// ./config. Throws InputError when there is none.
std::filesystem::path config_folder(const std::filesystem::path& given);

}  // namespace vigia::app
