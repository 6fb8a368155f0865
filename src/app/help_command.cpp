#include "command_tree.hpp"
#include "commands.hpp"
#include "manual_page.hpp"
#include "shell_completion.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "vigia/core/error.hpp"
#include "vigia/core/key_reference.hpp"
#include "vigia/core/suggestion.hpp"
#include "vigia/evaluation/campaign.hpp"
#include "vigia/evaluation/text_table.hpp"
#include "vigia/mission/localizers.hpp"
#include "vigia/perception/eye.hpp"
#include "vigia/planner/look_policy.hpp"
#include "vigia/tracking/trackers.hpp"

namespace vigia::app {
namespace {

using evaluation::Cells;
using evaluation::TextRows;

enum class Form { text, json, markdown };

struct HelpOptions {
  std::string topic;
  std::string prefix;
  bool flat = false;
  bool json = false;
  bool markdown = false;

  Form form() const { return json ? Form::json : markdown ? Form::markdown : Form::text; }
};

void print_table(const TextRows& rows, Form form) {
  fmt::print("{}", form == Form::markdown ? evaluation::markdown_table(rows, Cells::words)
                                          : evaluation::aligned_table(rows, Cells::words));
}

// ---- keys ---------------------------------------------------------------------------------------

std::vector<KeyRow> all_keys() {
  std::vector<KeyRow> rows = mission::mission_keys();
  const std::vector<KeyRow> campaign = evaluation::campaign_keys();
  rows.insert(rows.end(), campaign.begin(), campaign.end());
  return rows;
}

/// The rest of a key behind the path of a map or a list; empty for a key that lies elsewhere.
std::string rest_of(const std::string& key, const std::string& path) {
  if (path.empty()) return key;
  if (key.size() <= path.size() + 1 || key.compare(0, path.size(), path) != 0) return "";
  const std::size_t item = key.compare(path.size(), 2, "[]") == 0 ? 2 : 0;
  const std::size_t dot = path.size() + item;
  return dot < key.size() && key[dot] == '.' ? key.substr(dot + 1) : "";
}

/// A path as the reference writes it: of an item of a list, cameras[0], what all have.
std::string without_places(const std::string& path) {
  static const std::regex place("\\[[0-9]+\\]");
  return std::regex_replace(path, place, "[]");
}

/// The keys at or below a path; @p flat: not those of the maps below it.
std::vector<KeyRow> keys_below(const std::string& path, bool flat) {
  std::vector<KeyRow> found;
  const std::vector<KeyRow> all = all_keys();
  for (const KeyRow& row : all) {
    const std::string rest = rest_of(row.key, path);
    const bool below = !rest.empty() && (!flat || rest.find('.') == std::string::npos);
    if (below || (!flat && row.key == path)) found.push_back(row);
  }
  if (!found.empty()) return found;
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const KeyRow& row : all) names.push_back(row.key);
  throw InputError(fmt::format("there is no key '{}'{}", path, suggestion(path, names)));
}

std::string values_of(const KeyRow& row) {
  const std::string unit = row.unit.empty() ? "" : " " + row.unit;
  if (row.kind == "number") return row.range + unit;
  if (row.kind == "one of") return row.range;
  return row.kind + (row.range.empty() ? "" : ": " + row.range) + unit;
}

std::string usual_of(const KeyRow& row) {
  if (row.required) return "required";
  return row.usual.empty() ? "–" : row.usual;
}

std::string meaning_of(const KeyRow& row) {
  return row.meaning + (row.where.empty() ? "" : " (where " + row.where + ")");
}

nlohmann::ordered_json json_of(const KeyRow& row) {
  return {{"key", row.key},     {"kind", row.kind},      {"unit", row.unit},
          {"range", row.range}, {"default", row.usual},  {"required", row.required},
          {"where", row.where}, {"meaning", row.meaning}};
}

void print_keys(const HelpOptions& options) {
  const std::string prefix = without_places(options.prefix);
  const std::vector<KeyRow> keys = keys_below(prefix, options.flat);
  if (options.form() == Form::json) {
    auto list = nlohmann::ordered_json::array();
    std::transform(keys.begin(), keys.end(), std::back_inserter(list), json_of);
    fmt::print("{}\n", list.dump(2));
    return;
  }
  const bool markdown = options.form() == Form::markdown;
  TextRows rows{{"key", "default", "values", "meaning"}};
  for (const KeyRow& row : keys) {
    const std::string rest = rest_of(row.key, prefix);
    // Below its heading in a page a map needs no row of its own.
    if (markdown && rest.empty() && keys.size() > 1) continue;
    rows.push_back({markdown ? "`" + (rest.empty() ? row.key : rest) + "`" : row.key, usual_of(row),
                    values_of(row), meaning_of(row)});
  }
  print_table(rows, options.form());
}

// ---- tables of names ----------------------------------------------------------------------------

template <typename Entry>
void print_names(const std::vector<Entry>& entries, Form form) {
  if (form == Form::json) {
    auto list = nlohmann::ordered_json::array();
    for (const NameEntry& entry : entries)
      list.push_back({{"name", entry.name}, {"meaning", entry.meaning}, {"needs", entry.needs}});
    fmt::print("{}\n", list.dump(2));
    return;
  }
  TextRows rows{{"name", "meaning", "needs"}};
  for (const NameEntry& entry : entries)
    rows.push_back(
        {form == Form::markdown ? "`" + entry.name + "`" : entry.name, entry.meaning, entry.needs});
  print_table(rows, form);
}

struct Topic {
  std::string name;
  std::string meaning;
  void (*print)(const CLI::App& app, const HelpOptions& options);
};

const std::vector<Topic>& topics() {
  static const std::vector<Topic> table{
      {"keys", "every key of a mission, its world and robot, and of a campaign",
       [](const CLI::App&, const HelpOptions& options) { print_keys(options); }},
      {"localizers", "who may estimate the pose",
       [](const CLI::App&, const HelpOptions& options) {
         print_names(mission::localizers(), options.form());
       }},
      {"trackers", "who may find landmarks in a picture",
       [](const CLI::App&, const HelpOptions& options) {
         print_names(tracking::trackers(), options.form());
       }},
      {"eyes", "who may turn a camera's pictures into observations",
       [](const CLI::App&, const HelpOptions& options) {
         print_names(perception::eyes(), options.form());
       }},
      {"policies", "who may choose the next landmark",
       [](const CLI::App&, const HelpOptions& options) {
         print_names(planner::look_policies(), options.form());
       }},
      {"man", "the manual page, for man(1)",
       [](const CLI::App& app, const HelpOptions&) { fmt::print("{}", manual_page(app)); }},
      {"completion", "completes commands, options and file names in bash",
       [](const CLI::App& app, const HelpOptions&) { fmt::print("{}", bash_completion(app)); }},
  };
  return table;
}

void print_overview(const CLI::App& app) {
  // CLI::App::help() would be that of the command which is running.
  const std::string all = app.get_formatter()->make_help(&app, "vigia", CLI::AppFormatMode::Normal);
  fmt::print("{}\nTopics of `vigia help`:\n", all);
  for (const Topic& topic : topics()) fmt::print("  {:<27} {}\n", topic.name, topic.meaning);
}

void help(const CLI::App& app, const HelpOptions& options) {
  if (options.topic.empty()) return print_overview(app);
  std::vector<std::string> names = names_of(commands_below(app));
  if (std::find(names.begin(), names.end(), options.topic) != names.end()) {
    fmt::print("{}", app.get_subcommand(options.topic)->help());
    return;
  }
  for (const Topic& topic : topics()) {
    if (topic.name == options.topic) return topic.print(app, options);
    names.push_back(topic.name);
  }
  throw InputError(fmt::format("there is no help on '{}'{} (known: {})", options.topic,
                               suggestion(options.topic, names), joined(names)));
}

}  // namespace

void add_help(CLI::App& app, int& status) {
  auto options = std::make_shared<HelpOptions>();
  CLI::App* command = app.add_subcommand(
      "help",
      "Explain a command, the keys of the YAML files, localizers, trackers, eyes, policies");
  command->add_option("topic", options->topic,
                      "A command, keys, localizers, trackers, eyes, policies, man or completion");
  command->add_option("prefix", options->prefix, "Of the keys, e.g. planner.fuzzy");
  command->add_flag("--flat", options->flat, "Not the keys of the maps below the prefix");
  command->add_flag("--json", options->json, "Print as JSON");
  command->add_flag("--markdown", options->markdown, "Print as a table in Markdown");
  command->callback([options, &app, &status] {
    help(app, *options);
    status = 0;
  });
}

}  // namespace vigia::app
