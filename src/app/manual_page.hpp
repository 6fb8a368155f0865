#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace vigia::app {

/// The program's manual page in the language of man(7): every command with its options, as they
/// are declared.
std::string manual_page(const CLI::App& app);

}  // namespace vigia::app
