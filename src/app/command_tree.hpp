#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace vigia::app {

/// The commands right below one, in the order in which they were added.
std::vector<const CLI::App*> commands_below(const CLI::App& app);
std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands);
/// The long options of a command, "--seed" and so on.
std::vector<std::string> long_options_of(const CLI::App& app);

}  // namespace vigia::app
