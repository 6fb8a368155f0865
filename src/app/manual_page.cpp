#include "manual_page.hpp"

#include "command_tree.hpp"

#include <fmt/format.h>

namespace vigia::app {
namespace {

/// Words that stand as they are: neither a request, nor an escape, and hyphens that can be copied.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool request = (c == '.' || c == '\'') && (out.empty() || out.back() == '\n');
    if (request) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string value_of(const CLI::Option& option) {
  if (option.get_type_size() == 0) return "";
  return fmt::format(" \\fI{}\\fR", plain(option.get_type_name()));
}

/// A positional has no dashes before its name.
std::string heading_of(const CLI::Option& option) {
  if (option.get_positional()) return fmt::format("\\fI{}\\fR", plain(option.get_name()));
  std::string heading;
  for (const std::string& name : option.get_snames())
    heading += fmt::format("{}\\fB\\-{}\\fR", heading.empty() ? "" : ", ", plain(name));
  for (const std::string& name : option.get_lnames())
    heading += fmt::format("{}\\fB\\-\\-{}\\fR", heading.empty() ? "" : ", ", plain(name));
  return heading + value_of(option);
}

void add_options(const CLI::App& command, std::string& page) {
  for (const CLI::Option* option : command.get_options()) {
    page += fmt::format(".TP\n{}\n{}", heading_of(*option), plain(option->get_description()));
    const std::string usual = option->get_default_str();
    page += usual.empty() ? "\n" : fmt::format(" (default: {})\n", plain(usual));
  }
}

void add_command(const CLI::App& command, const std::string& path, std::string& page) {
  const std::string name = path + " " + command.get_name();
  page += fmt::format(".SS \"{}\"\n{}.\n", plain(name), plain(command.get_description()));
  add_options(command, page);
  for (const CLI::App* below : commands_below(command)) add_command(*below, name, page);
}

constexpr const char* kAbout =
    ".SH DESCRIPTION\n"
    "A simulated mobile robot with cameras drives through a known building or field. "
    "\\fBvigia\\fR\n"
    "renders what the cameras see, tracks landmarks in these images, keeps the watched one "
    "centred,\n"
    "plans which one to watch, and localizes the robot by several methods side by side, each with\n"
    "its error beside the theoretical limit.\n"
    ".PP\n"
    "Missions, worlds, robots and campaigns are YAML files; \\fBvigia help keys\\fR explains "
    "every\n"
    "key, and \\fBvigia check\\fR \\fIfile\\fR says what is wrong with one.\n";

constexpr const char* kEnd =
    ".SH FILES\n"
    ".TP\n\\fIruns/<mission>\\-<seed>/\\fR\n"
    "What \\fBvigia run\\fR writes: summary.json, ticks.csv, events.jsonl, the trajectories in "
    "the\n"
    "TUM format, map.png, frames/ and report.html.\n"
    ".SH \"EXIT STATUS\"\n"
    ".TP\n\\fB0\\fR\ndone\n"
    ".TP\n\\fB1\\fR\nthe mission failed, or a check did\n"
    ".TP\n\\fB2\\fR\nwrong input or usage: the message has file, line, what was found and what "
    "would be right\n"
    ".TP\n\\fB3\\fR\nsomething unexpected\n"
    ".SH EXAMPLES\n"
    ".nf\n"
    "vigia run config/missions/armingol\\-room.yaml \\-\\-seed 7\n"
    "vigia plan config/missions/armingol\\-room.yaml\n"
    "vigia evaluate config/campaigns/armingol\\-100.yaml\n"
    "vigia track \\-\\-tracker disc video.mp4 \\-\\-out found\n"
    ".fi\n";

}  // namespace

std::string manual_page(const CLI::App& app) {
  std::string page =
      fmt::format(".TH VIGIA 1 \"\" \"vigia {}\" \"User commands\"\n", VIGIA_VERSION);
  page += ".SH NAME\nvigia \\- visual servoing and active perception for mobile robots\n";
  page += ".SH SYNOPSIS\n\\fBvigia\\fR \\fIcommand\\fR [\\fIoption\\fR...] [\\fIfile\\fR...]\n";
  page += kAbout;
  page += ".SH OPTIONS\n";
  add_options(app, page);
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_below(app)) add_command(*command, "vigia", page);
  return page + kEnd;
}

}  // namespace vigia::app
