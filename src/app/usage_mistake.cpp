#include "usage_mistake.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/suggestion.hpp"

namespace vigia::app {
namespace {

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

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
    const auto options = options_of(command);
    const std::string name = word.substr(0, word.find('='));
    return fmt::format("unknown option '{}'{} (options: {})", name, suggestion(name, options),
                       joined(options));
  }
  const auto commands = commands_of(command);
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
