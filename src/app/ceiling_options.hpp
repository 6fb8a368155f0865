#pragma once

#include "usage_mistake.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "vigia/perception/ceiling_follower.hpp"

namespace vigia::app {

/// What a command is told of a ceiling of patches and of the camera under it.
struct CeilingOptions {
  std::string patch_m;
  double rise_m = 0.0;
  double pitch_m = 1.0;
  std::string placement;
  double rate_hz = 25.0;  ///< of pictures that have no time of their own
  double max_speed_mps = 1.5;
  double tilt_deg = 1.0;        ///< σ of the camera's tilt about either axis
  double height_percent = 2.0;  ///< σ of the rise
  bool plain = false;

  /// Whether any of them was given, but for the pitch.
  bool given() const { return !patch_m.empty() || rise_m > 0.0 || !placement.empty() || plain; }
};

void add_ceiling_options(CLI::App& command, CeilingOptions& options);

/// Two numbers with a colon between them.
std::optional<std::pair<double, double>> parsed_pair(std::string_view text);

/// A patch's LENGTH:WIDTH. Throws InputError, naming the option.
std::pair<double, double> parse_patch(const char* option, const std::string& text, double min,
                                      double max);

/// The camera of a calibration file under that ceiling. Throws InputError.
perception::CeilingView ceiling_view(const CeilingOptions& options, const std::string& camera);

}  // namespace vigia::app
