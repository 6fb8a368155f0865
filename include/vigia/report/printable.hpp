#pragma once

#include <filesystem>
#include <optional>
#include <variant>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"

namespace vigia::report {

/// A patch of a ceiling: a strip, with a tongue at its forward end where it has a polarity mark.
struct PatchShape {
  double length_m = 0.09;
  double width_m = 0.03;
  bool polarity = true;
};

/// What can be printed.
using LandmarkShape = std::variant<DiscShape, PatternShape, TagShape, PatchShape>;

/// A page with a landmark at true scale, metres: the landmark's sheet at the top, below it what the
/// landmark is, in words, and a bar to check the scale of the print.
struct PrintedPage {
  double width_m = 0.0;
  double height_m = 0.0;
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  ///< of the landmark, from the upper left
  double half_width_m = 0.0;                           ///< of the landmark's sheet
};
/// On a sheet of @p paper, upright, the page is that sheet.
enum class Paper { a4, a3, letter };
PrintedPage printed_page(const LandmarkShape& shape, std::optional<Paper> paper = {});

/// The landmark as large as @p paper takes it.
LandmarkShape fitted_to(const LandmarkShape& shape, Paper paper);

/// Prints a landmark to a .svg, .pdf or .png file. A PNG has @p dpi pixels an inch and says so.
/// Throws InputError for another ending, for a PNG that is too large, for a landmark that is larger
/// than the paper, and when the file cannot be written; std::invalid_argument for a code or tag
/// outside its range.
void print_landmark(const LandmarkShape& shape, const std::filesystem::path& file,
                    double dpi = 300.0, std::optional<Paper> paper = {});

}  // namespace vigia::report
