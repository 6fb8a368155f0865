#include "usage_mistake.hpp"

#include "command_tree.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/suggestion.hpp"

namespace vigia::app {
namespace {

/// The command that the line reached: "landmark tag" in `vigia landmark tag --idd 5`.
const CLI::App& reached(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : reached(*parsed.back());
}

}  // namespace

std::string usage_mistake(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining(true);
  if (unknown.empty()) return error.what();
  const CLI::App& command = reached(app);
  const std::string& word = unknown.front();
  if (word.front() == '-') {
    const auto options = long_options_of(command);
    const std::string name = word.substr(0, word.find('='));
    return fmt::format("unknown option '{}'{} (options: {})", name, suggestion(name, options),
                       joined(options));
  }
  const auto commands = names_of(commands_below(command));
  if (commands.empty()) return fmt::format("'{}' is one argument too many", word);
  return fmt::format("unknown command '{}'{} (commands: {})", word, suggestion(word, commands),
                     joined(commands));
}

CLI::Validator one_of(std::vector<std::string> names) {
  const auto mistake = [names = std::move(names)](const std::string& given) -> std::string {
    if (std::find(names.begin(), names.end(), given) != names.end()) return {};
    return fmt::format("found '{}', must be one of {}{}", given, joined(names),
                       suggestion(given, names));
  };
  return {mistake, ""};
}

}  // namespace vigia::app
