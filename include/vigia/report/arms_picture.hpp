#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vigia::report {

/// A mean with its 95 % interval.
struct ArmValue {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// An arm of a campaign: what it costs against what it brings.
struct ArmPoint {
  std::string name;
  std::string group;  ///< arms of a group share colour and shape
  ArmValue looks;
  ArmValue path_rms_cm;
};

/// What the picture of a campaign shows.
struct ArmsPicture {
  std::string title;
  std::string subtitle;
  std::vector<ArmPoint> arms;
};

/// Draws every arm as a labelled point with its intervals: path RMS over the number of looks, lower
/// left is better. The vertical axis is logarithmic when the arms span more than a factor of eight.
/// The ending of @p file (.png, .svg, .pdf) chooses the format; the same arms give the same bytes.
/// Throws InputError when it can't be written, std::invalid_argument without arms or with a value
/// that is not finite.
void draw_arms(const ArmsPicture& picture, const std::filesystem::path& file);

}  // namespace vigia::report
