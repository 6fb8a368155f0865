#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace vigia::app {

/// A script for bash that completes the program's commands and options, and file names elsewhere.
std::string bash_completion(const CLI::App& app);

}  // namespace vigia::app
