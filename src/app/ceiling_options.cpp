#include "ceiling_options.hpp"

#include <charconv>
#include <tuple>

#include <fmt/format.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/camera_file.hpp"
#include "vigia/core/error.hpp"

namespace vigia::app {
namespace {

constexpr double kMaxPatch_m = 1.0;
constexpr double kMaxLengthByPitch = 0.4;
constexpr const char* kUsualPlacement = "0.005:1.3";  // of whoever hangs them by a string

std::optional<double> parsed_number(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

void parse_placement(const std::string& text, CeilingGrid& grid) {
  const auto sigma = parsed_pair(text);
  if (!sigma || !(sigma->first >= 0.0) || !(sigma->first <= 0.1) || !(sigma->second >= 0.0) ||
      !(sigma->second <= 20.0))
    throw InputError(
        fmt::format("--placement: found '{}', must be METRES:DEGREES, 0–0.1 m and 0–20°", text));
  grid.placement_m = sigma->first;
  grid.placement_turn = from_deg(sigma->second);
}

}  // namespace

std::optional<std::pair<double, double>> parsed_pair(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto first = parsed_number(text.substr(0, colon));
  const auto second = parsed_number(text.substr(colon + 1));
  if (!first || !second) return std::nullopt;
  return std::pair{*first, *second};
}

std::pair<double, double> parse_patch(const char* option, const std::string& text, double min,
                                      double max) {
  const auto size = parsed_pair(text);
  if (!size || !(size->second >= min) || !(size->first >= 1.5 * size->second) ||
      !(size->first <= max))
    throw InputError(
        fmt::format("{}: found '{}', must be LENGTH:WIDTH with {} ≤ WIDTH, 1.5 WIDTH ≤ LENGTH ≤ {}",
                    option, text, min, max));
  return *size;
}

perception::CeilingView ceiling_view(const CeilingOptions& options, const std::string& camera) {
  if (!(options.rise_m > 0.0))
    throw InputError("--camera: how far is the ceiling from the camera? Give --rise-m H");
  perception::CeilingView view;
  view.camera = read_camera(camera);
  view.rise_m = options.rise_m;
  view.tilt_sigma = from_deg(options.tilt_deg);
  view.height_sigma = 0.01 * options.height_percent;
  view.max_speed_mps = options.max_speed_mps;
  view.grid.pitch_m = options.pitch_m;
  view.grid.polarity = !options.plain;
  if (!options.patch_m.empty())
    std::tie(view.grid.length_m, view.grid.width_m) =
        parse_patch("--patch-m", options.patch_m, 0.005, kMaxPatch_m);
  if (view.grid.length_m > kMaxLengthByPitch * options.pitch_m)
    throw InputError(
        fmt::format("--pitch-m {}: patches of {} m would not lie apart; the pitch must be at least "
                    "{} of their length (--patch-m)",
                    options.pitch_m, view.grid.length_m, 1.0 / kMaxLengthByPitch));
  parse_placement(options.placement.empty() ? kUsualPlacement : options.placement, view.grid);
  return view;
}

void add_ceiling_options(CLI::App& command, CeilingOptions& options) {
  command
      .add_option("--rise-m", options.rise_m,
                  "ceiling, with --camera: from the camera to the ceiling, m")
      ->check(CLI::Range(0.05, 100.0));
  command.add_option("--patch-m", options.patch_m,
                     "ceiling, with --camera: LENGTH:WIDTH of a patch, m (0.09:0.03)");
  command
      .add_option("--pitch-m", options.pitch_m, "ceiling, with --camera: from patch to patch, m")
      ->check(CLI::Range(0.05, 100.0))
      ->capture_default_str();
  command.add_option("--placement", options.placement,
                     "ceiling, with --camera: METRES:DEGREES, σ of a patch's place beside its node "
                     "of the grid and of its direction (0.005:1.3)");
  command
      .add_option("--rate-hz", options.rate_hz,
                  "ceiling, with --camera: of pictures that have no time of their own")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  command
      .add_option("--max-speed", options.max_speed_mps,
                  "ceiling, with --camera: of the camera, m/s, which is all that is known between "
                  "pictures that do not match")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  command
      .add_option(
          "--tilt-deg", options.tilt_deg,
          "ceiling, with --camera: σ of the camera's tilt about either axis, estimated from "
          "the patches")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command
      .add_option("--height-percent", options.height_percent,
                  "ceiling, with --camera: σ of --rise-m, estimated from the patches")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  command.add_flag("--plain", options.plain, "ceiling: the patches have no tongue at one end");
}

}  // namespace vigia::app
