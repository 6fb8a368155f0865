#pragma once

#include "palette.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <cairo.h>

namespace vigia::report {

/// A rectangle on a sheet, y down.
struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

struct Font {
  double size = 13.0;
  bool bold = false;
};

/// Where a text's reference point lies in the text: 0 left or top, 1 right or bottom.
struct TextAnchor {
  double x = 0.0;
  double y = 0.5;
};

struct Stroke {
  Colour colour = palette::kInk;
  double width = 1.0;
  std::vector<double> dashes = {};
};

/// Units of a sheet in an inch of an SVG or PDF page.
inline constexpr double kVectorUnitsPerInch = 144.0;

/// A drawing surface in units of a PNG's pixels, with what the figures are made of.
class Sheet {
 public:
  using Clip = std::unique_ptr<cairo_t, decltype(&cairo_restore)>;

  /// The ending of @p file chooses the format. Throws InputError for one that is not known.
  Sheet(const std::filesystem::path& file, double width, double height);
  /// Draws on an existing surface, which must outlive the sheet.
  explicit Sheet(cairo_surface_t* surface);

  /// The underlying context, for what the methods below do not cover.
  cairo_t* context() const { return context_.get(); }

  void fill(Colour colour) const;
  void stroke(const Stroke& stroke) const;
  void polyline(const std::vector<Eigen::Vector2d>& points, bool closed = false) const;
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Stroke& stroke) const;
  void circle(const Eigen::Vector2d& centre, double radius) const;
  void rectangle(const Box& box) const;
  /// Makes @p box the clip until the guard goes.
  [[nodiscard]] Clip clip(const Box& box) const;

  Eigen::Vector2d text_size(const std::string& text, const Font& font) const;
  void text(const std::string& text, const Eigen::Vector2d& at, const Font& font, Colour colour,
            TextAnchor anchor = {}) const;
  /// Text that reads upwards, centred on @p centre.
  void upright_text(const std::string& text, const Eigen::Vector2d& centre, const Font& font,
                    Colour colour) const;
  /// Text with an outline of @p halo round it, legible on any ground.
  void outlined_text(const std::string& text, const Eigen::Vector2d& at, const Font& font,
                     Colour colour, Colour halo, double halo_width, TextAnchor anchor = {}) const;

  /// Writes into a PNG how large its pixels are.
  void set_resolution(double dots_per_inch) { dots_per_inch_ = dots_per_inch; }

  /// Finishes the drawing and writes it aside, then renames it to the file given at construction.
  /// Throws InputError when that fails.
  void save();

 private:
  using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
  using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

  void prepare(const Font& font) const;
  Eigen::Vector2d baseline(const std::string& text, const Eigen::Vector2d& at,
                           TextAnchor anchor) const;

  std::filesystem::path file_;
  double dots_per_inch_ = 0.0;  // 0: not said
  // Cairo writes to it while the surface lives, so it is declared before the surface.
  std::unique_ptr<std::string> bytes_ = std::make_unique<std::string>();
  Surface surface_{nullptr, &cairo_surface_destroy};
  Context context_{nullptr, &cairo_destroy};
};

}  // namespace vigia::report
