#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace vigia::app {

/// What is wrong with a command line that could not be parsed: an unknown command or option with
/// the nearest one that there is, or what @p error says.
std::string usage_mistake(const CLI::App& app, const CLI::ParseError& error);

/// Of an option that takes one of some names.
CLI::Validator one_of(std::vector<std::string> names);

}  // namespace vigia::app
