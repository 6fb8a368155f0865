#include "commands.hpp"
#include "usage_mistake.hpp"

#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/report/printable.hpp"

namespace vigia::app {
namespace {

struct LandmarkOptions {
  PatternShape pattern;
  TagShape tag;
  DiscShape disc;
  report::PatchShape patch;
  bool plain = false;
  std::string out;
  std::string paper;
  double dpi = 300.0;
};

std::optional<report::Paper> parse_paper(const std::string& text) {
  if (text == "a4") return report::Paper::a4;
  if (text == "a3") return report::Paper::a3;
  if (text == "letter") return report::Paper::letter;
  return std::nullopt;
}

void check_number(const char* option, int value, int count, const char* things) {
  if (value < 0 || value >= count)
    throw InputError(fmt::format("{} {}: {} are 0–{}", option, value, things, count - 1));
}

void check_metres(const char* option, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw InputError(fmt::format("{} {}: must lie in [{}, {}]", option, value, low, high));
}

int print(const report::LandmarkShape& asked, const LandmarkOptions& options) {
  check_metres("--dpi", options.dpi, 36.0, 2400.0);
  const auto paper = parse_paper(options.paper);
  const report::LandmarkShape shape = paper ? report::fitted_to(asked, *paper) : asked;
  report::print_landmark(shape, options.out, options.dpi, paper);
  const report::PrintedPage page = report::printed_page(shape, paper);
  fmt::print(stderr, "{}: {:.0f} × {:.0f} mm\n", options.out, 1e3 * page.width_m,
             1e3 * page.height_m);
  return 0;
}

CLI::App* add_kind(CLI::App& command, const char* name, const char* what,
                   const std::shared_ptr<LandmarkOptions>& options) {
  CLI::App* kind = command.add_subcommand(name, what);
  kind->add_option("-o,--out", options->out, "A .pdf, .svg or .png file")->required();
  kind->add_option("--dpi", options->dpi, "Pixels per inch of a .png")->capture_default_str();
  kind->add_option("--paper", options->paper,
                   "As large as a sheet takes it: a4, a3 or letter; the print says its size")
      ->check(one_of({"a4", "a3", "letter"}));
  return kind;
}

void add_disc(CLI::App& command, const std::shared_ptr<LandmarkOptions>& options, int& status) {
  CLI::App* kind = add_kind(command, "disc", "A dark disc", options);
  kind->add_option("--radius-m", options->disc.radius_m, "Radius, m")->capture_default_str();
  kind->callback([options, &status] {
    check_metres("--radius-m", options->disc.radius_m, 0.005, 1.0);
    status = print(options->disc, *options);
  });
}

void add_pattern(CLI::App& command, const std::shared_ptr<LandmarkOptions>& options, int& status) {
  CLI::App* kind = add_kind(command, "pattern", "A colour pattern that says its place", options);
  PatternCode& code = options->pattern.code;
  kind->add_option("--floor", code.floor, "0–11")->required();
  kind->add_option("--room", code.room, "0–80")->required();
  kind->add_option("--pattern", code.pattern, "0–8")->required();
  kind->callback([options, &status] {
    const PatternCode& asked = options->pattern.code;
    check_number("--floor", asked.floor, kFloors, "floors");
    check_number("--room", asked.room, kRooms, "rooms");
    check_number("--pattern", asked.pattern, kPatterns, "patterns");
    status = print(options->pattern, *options);
  });
}

void add_tag(CLI::App& command, const std::shared_ptr<LandmarkOptions>& options, int& status) {
  CLI::App* kind = add_kind(command, "tag", "An AprilTag of the family 36h11", options);
  kind->add_option("--id", options->tag.tag, "0–586")->required();
  kind->add_option("--side-m", options->tag.side_m, "Side of the black square, m")
      ->capture_default_str();
  kind->callback([options, &status] {
    check_number("--id", options->tag.tag, kTags, "tags of this family");
    check_metres("--side-m", options->tag.side_m, 0.01, 1.0);
    status = print(options->tag, *options);
  });
}

void add_ceiling(CLI::App& command, const std::shared_ptr<LandmarkOptions>& options, int& status) {
  CLI::App* kind = add_kind(command, "ceiling", "A patch of a ceiling", options);
  kind->add_option("--length-m", options->patch.length_m, "Length, tongue and all, m")
      ->capture_default_str();
  kind->add_option("--width-m", options->patch.width_m, "Width, m")->capture_default_str();
  kind->add_flag("--plain", options->plain, "Without the tongue that tells its ends apart");
  kind->callback([options, &status] {
    report::PatchShape& patch = options->patch;
    check_metres("--length-m", patch.length_m, 0.02, 1.0);
    check_metres("--width-m", patch.width_m, 0.01, 0.5 * patch.length_m);
    patch.polarity = !options->plain;
    status = print(patch, *options);
  });
}

}  // namespace

void add_landmark(CLI::App& app, int& status) {
  auto options = std::make_shared<LandmarkOptions>();
  CLI::App* command =
      app.add_subcommand("landmark", "Print a landmark at true scale, as PDF, SVG or PNG");
  command->require_subcommand(1);
  add_disc(*command, options, status);
  add_pattern(*command, options, status);
  add_tag(*command, options, status);
  add_ceiling(*command, options, status);
}

}  // namespace vigia::app
