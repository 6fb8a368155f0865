#include "vigia/report/printable.hpp"

#include "png_resolution.hpp"
#include "sheet.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "vigia/core/ceiling_grid.hpp"
#include "vigia/core/error.hpp"
#include "vigia/core/overloaded.hpp"
#include "vigia/imaging/tag_bitmap.hpp"

namespace vigia::report {
namespace {

constexpr double kPlateFactor = 1.6;     // half a disc's sheet over its radius, as the simulator's
constexpr double kPatchPlate = 0.65;     // half a patch's sheet over its length
constexpr double kNarrowest = 0.12;      // m, so that the words have room
constexpr double kStrip = 0.034;         // m below the sheet
constexpr double kMargin = 0.006;        // m
constexpr double kTextSize = 0.0038;     // m
constexpr double kLongestPng = 32767.0;  // px, Cairo's limit

// Inks well apart for a camera, each dark against paper.
Colour ink_of(DotColour colour) {
  switch (colour) {
    case DotColour::red:
      return palette::hex(0xcc2429);
    case DotColour::green:
      return palette::hex(0x1f8c40);
    case DotColour::blue:
      return palette::hex(0x2438b8);
    case DotColour::black:
      break;
  }
  return palette::hex(0x1a1a1a);
}

std::string word(DotColour colour) {
  const char* words[] = {"black", "red", "green", "blue"};
  return words[static_cast<int>(colour)];
}

/// Millimetres with at most one digit after the point.
std::string millimetres(double metres) {
  const long tenths = std::lround(metres * 1e4);
  std::string text = std::to_string(tenths / 10);
  if (tenths % 10 != 0) text += '.' + std::to_string(tenths % 10);
  return text + " mm";
}

/// What the landmark is: a headline, and lines that explain it.
struct Words {
  std::vector<std::string> operator()(const DiscShape& disc) const {
    return {"Disc, radius " + millimetres(disc.radius_m), "Hang it on a light wall, flat."};
  }
  std::vector<std::string> operator()(const PatternShape& shape) const {
    const PatternColours colours = encode(shape.code);
    std::string ring = "Centre " + word(colours.centre) + "; rings, clockwise from the top: ";
    for (std::size_t i = 0; i < colours.ring.size(); ++i)
      ring += (i > 0 ? ", " : "") + word(colours.ring[i]);
    return {"Floor " + std::to_string(shape.code.floor) + ", room " +
                std::to_string(shape.code.room) + ", pattern " + std::to_string(shape.code.pattern),
            ring + ".",
            "Ring radii " + millimetres(shape.outer_radius_m) + " and " +
                millimetres(shape.inner_radius_m) + ". Hang it flat, black points upwards."};
  }
  std::vector<std::string> operator()(const TagShape& tag) const {
    return {
        "AprilTag 36h11, number " + std::to_string(tag.tag),
        "Side of the black square " + millimetres(tag.side_m) + ". Hang it flat, this line below."};
  }
  std::vector<std::string> operator()(const PatchShape& patch) const {
    return {"Ceiling patch, " + millimetres(patch.length_m) + " × " + millimetres(patch.width_m),
            patch.polarity ? "Cut it out. Its narrow end points along the grid's x."
                           : "Cut it out. Its long axis lies along the grid's x."};
  }
};

template <typename Shape>
double landmark_half_width(const Shape& shape) {
  Landmark landmark;
  landmark.shape = shape;
  return half_width(landmark);
}

double sheet_half_width(const LandmarkShape& shape) {
  return std::visit(
      Overloaded{[](const DiscShape& disc) { return landmark_half_width(disc) * kPlateFactor; },
                 [](const PatternShape& pattern) { return landmark_half_width(pattern); },
                 [](const TagShape& tag) { return landmark_half_width(tag); },
                 [](const PatchShape& patch) { return patch.length_m * kPatchPlate; }},
      shape);
}

/// Draws in metres from the landmark's centre, x right, y down.
struct Picture {
  const Sheet& sheet;
  Eigen::Vector2d centre;
  double scale;

  void dot(double x, double y, double radius, Colour colour) const {
    sheet.circle(centre + scale * Eigen::Vector2d(x, y), scale * radius);
    sheet.fill(colour);
  }

  void operator()(const DiscShape& disc) const {
    dot(0.0, 0.0, disc.radius_m, ink_of(DotColour::black));
  }

  void operator()(const PatternShape& pattern) const {
    for (const PatternDot& d : pattern_dots(pattern))
      dot(d.centre_l.x(), -d.centre_l.y(), d.radius_m, ink_of(d.colour));
  }

  // One path for all black fields, so that no seam shows between two of them.
  void operator()(const TagShape& tag) const {
    const imaging::TagBitmap black = imaging::tag_bitmap(tag.tag);
    const double field = scale * tag.side_m / imaging::kTagFields;
    const Eigen::Vector2d corner = centre - Eigen::Vector2d::Constant(0.5 * scale * tag.side_m);
    cairo_new_path(sheet.context());
    for (std::size_t row = 0; row < black.size(); ++row)
      for (std::size_t column = 0; column < black.size(); ++column)
        if (black[row][column])
          cairo_rectangle(sheet.context(), corner.x() + static_cast<double>(column) * field,
                          corner.y() + static_cast<double>(row) * field, field, field);
    sheet.fill(ink_of(DotColour::black));
  }

  // Forward is up.
  void operator()(const PatchShape& patch) const {
    const double half = 0.5 * patch.length_m;
    const double side = 0.5 * patch.width_m;
    const double shoulder = patch.polarity ? half - kTongueLength * patch.length_m : half;
    const double tongue = patch.polarity ? 0.5 * kTongueWidth * patch.width_m : side;
    cairo_new_path(sheet.context());
    for (const auto& [x, y] : {std::pair{-side, half},
                               {side, half},
                               {side, -shoulder},
                               {tongue, -shoulder},
                               {tongue, -half},
                               {-tongue, -half},
                               {-tongue, -shoulder},
                               {-side, -shoulder}})
      cairo_line_to(sheet.context(), centre.x() + scale * x, centre.y() + scale * y);
    cairo_close_path(sheet.context());
    sheet.fill(ink_of(DotColour::black));
  }
};

/// Text that is made smaller where it would leave the page.
void fitted_text(const Sheet& sheet, const std::string& text, const Eigen::Vector2d& at, Font font,
                 double room) {
  font.size *= std::min(1.0, room / sheet.text_size(text, font).x());
  sheet.text(text, at, font, palette::kInk, {0.0, 0.0});
}

void scale_bar(const Sheet& sheet, const PrintedPage& page, double scale, double y) {
  const double length = page.width_m > 0.2 ? 0.1 : 0.05;
  const double x = kMargin;
  const Stroke stroke{palette::kInk, 0.0003 * scale};
  const auto at = [&](double px, double py) { return Eigen::Vector2d(scale * px, scale * py); };
  sheet.line(at(x, y), at(x + length, y), stroke);
  for (const double end : {x, x + length})
    sheet.line(at(end, y - 0.0015), at(end, y + 0.0015), stroke);
  fitted_text(sheet, "This bar is " + millimetres(length) + " long in a print at 100 %.",
              at(x + length + 0.003, y - 0.5 * kTextSize), {0.8 * kTextSize * scale},
              scale * (page.width_m - length - 2.0 * kMargin - 0.003));
}

void write_words(const Sheet& sheet, const LandmarkShape& shape, const PrintedPage& page,
                 double scale) {
  const double top = page.height_m - kStrip;
  sheet.line({0.0, scale * top}, {scale * page.width_m, scale * top},
             {palette::kGrid, 0.0002 * scale, {0.002 * scale, 0.002 * scale}});
  double y = top + 0.004;
  bool headline = true;
  for (const std::string& line : std::visit(Words{}, shape)) {
    const double size = headline ? 1.2 * kTextSize : kTextSize;
    fitted_text(sheet, line, {scale * kMargin, scale * y}, {size * scale, headline},
                scale * (page.width_m - 2.0 * kMargin));
    y += 1.6 * size;
    headline = false;
  }
  scale_bar(sheet, page, scale, page.height_m - 0.005);
}

/// Width and height of a sheet, upright, m.
Eigen::Vector2d size_of(Paper paper) {
  switch (paper) {
    case Paper::a4:
      return {0.210, 0.297};
    case Paper::a3:
      return {0.297, 0.420};
    case Paper::letter:
      return {0.2159, 0.2794};
  }
  return {0.210, 0.297};
}

/// Half the largest landmark's sheet that a paper takes beside the words.
double largest_half_width(Paper paper) {
  const Eigen::Vector2d size = size_of(paper);
  return 0.5 * std::min(size.x(), size.y() - kStrip);
}

struct Scaled {
  double scale;

  LandmarkShape operator()(DiscShape disc) const {
    disc.radius_m *= scale;
    return disc;
  }
  LandmarkShape operator()(const PatternShape& pattern) const { return scaled(pattern, scale); }
  LandmarkShape operator()(TagShape tag) const {
    tag.side_m *= scale;
    return tag;
  }
  LandmarkShape operator()(PatchShape patch) const {
    patch.length_m *= scale;
    patch.width_m *= scale;
    return patch;
  }
};

}  // namespace

PrintedPage printed_page(const LandmarkShape& shape, std::optional<Paper> paper) {
  PrintedPage page;
  page.half_width_m = sheet_half_width(shape);
  page.width_m = std::max(kNarrowest, 2.0 * page.half_width_m);
  page.height_m = 2.0 * page.half_width_m + kStrip;
  if (paper) {
    page.width_m = size_of(*paper).x();
    page.height_m = size_of(*paper).y();
  }
  page.centre_m << 0.5 * page.width_m, page.half_width_m;
  return page;
}

LandmarkShape fitted_to(const LandmarkShape& shape, Paper paper) {
  return std::visit(Scaled{largest_half_width(paper) / sheet_half_width(shape)}, shape);
}

void print_landmark(const LandmarkShape& shape, const std::filesystem::path& file, double dpi,
                    std::optional<Paper> paper) {
  constexpr double kRounding = 1e-9;  // m
  const PrintedPage page = printed_page(shape, paper);
  if (paper && page.half_width_m > largest_half_width(*paper) + kRounding)
    throw InputError({file.string()}, "the landmark's sheet is " +
                                          millimetres(2.0 * page.half_width_m) +
                                          " wide, more than the paper takes");
  const bool pixels = file.extension() == ".png";
  const double scale = (pixels ? dpi : kVectorUnitsPerInch) / kMetresPerInch;
  if (pixels && std::max(page.width_m, page.height_m) * scale > kLongestPng)
    throw InputError({file.string()},
                     "a PNG of this size has more than 32767 pixels in a row: "
                     "ask for fewer dots per inch, or a .pdf or .svg");
  // A PNG's last column and row are whole, or paper would end within them.
  const auto extent = [&](double metres) {
    return pixels ? std::round(metres * scale) : metres * scale;
  };
  Sheet sheet(file, extent(page.width_m), extent(page.height_m));
  if (pixels) sheet.set_resolution(dpi);
  std::visit(Picture{sheet, scale * page.centre_m, scale}, shape);
  write_words(sheet, shape, page, scale);
  sheet.save();
}

}  // namespace vigia::report
