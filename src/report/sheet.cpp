#include "sheet.hpp"

#include "png_resolution.hpp"

#include <cmath>
#include <map>

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"

namespace vigia::report {
namespace {

// Points of a vector page per unit: 1600 units become a page about as wide as A4 across.
constexpr double kPointsPerUnit = 72.0 / kVectorUnitsPerInch;

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

cairo_surface_t* make_surface(const std::filesystem::path& file, std::string* bytes, double width,
                              double height) {
  const std::string ending = file.extension().string();
  if (ending == ".png")
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(width)),
                                      static_cast<int>(std::lround(height)));
  if (ending == ".svg")
    return cairo_svg_surface_create_for_stream(append, bytes, width * kPointsPerUnit,
                                               height * kPointsPerUnit);
  if (ending == ".pdf") {
    cairo_surface_t* surface = cairo_pdf_surface_create_for_stream(
        append, bytes, width * kPointsPerUnit, height * kPointsPerUnit);
    // Without this the file carries the time of day.
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    return surface;
  }
  throw InputError({file.string()},
                   "a picture's name ends in .png, .svg or .pdf, found \"" + ending + "\"");
}

// Cairo names the groups of an SVG "surface" and a number that counts through the process: number
// them anew in the order of their appearance.
std::string renumber_groups(const std::string& svg) {
  const std::string name = "surface";
  std::map<std::string, std::size_t> numbers;
  std::string renumbered;
  std::size_t done = 0;
  for (std::size_t at = svg.find(name); at != std::string::npos; at = svg.find(name, done)) {
    const std::size_t from = at + name.size();
    const std::size_t to = svg.find_first_not_of("0123456789", from);
    const std::size_t count = numbers.size();
    renumbered += svg.substr(done, from - done);
    renumbered += std::to_string(numbers.emplace(svg.substr(from, to - from), count).first->second);
    done = to;
  }
  return renumbered + svg.substr(done);
}

void set_source(cairo_t* context, Colour colour) {
  cairo_set_source_rgba(context, colour.r, colour.g, colour.b, colour.alpha);
}

// The look of letters must not depend on the machine's font settings.
void fix_font_options(cairo_t* context) {
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(context, options);
  cairo_font_options_destroy(options);
}

}  // namespace

Sheet::Sheet(const std::filesystem::path& file, double width, double height)
    : file_(file),
      surface_(make_surface(file, bytes_.get(), width, height), &cairo_surface_destroy),
      context_(cairo_create(surface_.get()), &cairo_destroy) {
  fix_font_options(context());
  if (file.extension() != ".png") cairo_scale(context(), kPointsPerUnit, kPointsPerUnit);
  rectangle({0.0, 0.0, width, height});
  fill(palette::kWhite);
}

Sheet::Sheet(cairo_surface_t* surface) : context_(cairo_create(surface), &cairo_destroy) {
  fix_font_options(context());
}

void Sheet::fill(Colour colour) const {
  set_source(context(), colour);
  cairo_fill(context());
}

void Sheet::stroke(const Stroke& stroke) const {
  set_source(context(), stroke.colour);
  cairo_set_line_width(context(), stroke.width);
  cairo_set_line_join(context(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(context(), stroke.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_dash(context(), stroke.dashes.data(), static_cast<int>(stroke.dashes.size()), 0.0);
  cairo_stroke(context());
}

void Sheet::polyline(const std::vector<Eigen::Vector2d>& points, bool closed) const {
  cairo_new_path(context());
  for (const Eigen::Vector2d& p : points) cairo_line_to(context(), p.x(), p.y());
  if (closed) cairo_close_path(context());
}

void Sheet::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Stroke& look) const {
  polyline({a, b});
  stroke(look);
}

void Sheet::circle(const Eigen::Vector2d& centre, double radius) const {
  cairo_new_path(context());
  cairo_arc(context(), centre.x(), centre.y(), radius, 0.0, 2.0 * M_PI);
  cairo_close_path(context());
}

void Sheet::rectangle(const Box& box) const {
  cairo_new_path(context());
  cairo_rectangle(context(), box.x, box.y, box.width, box.height);
}

Sheet::Clip Sheet::clip(const Box& box) const {
  cairo_save(context());
  rectangle(box);
  cairo_clip(context());
  return {context(), &cairo_restore};
}

void Sheet::prepare(const Font& font) const {
  cairo_select_font_face(context(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context(), font.size);
}

Eigen::Vector2d Sheet::text_size(const std::string& text, const Font& font) const {
  prepare(font);
  cairo_text_extents_t extents;
  cairo_text_extents(context(), text.c_str(), &extents);
  cairo_font_extents_t line;
  cairo_font_extents(context(), &line);
  return {extents.x_advance, line.ascent + line.descent};
}

Eigen::Vector2d Sheet::baseline(const std::string& text, const Eigen::Vector2d& at,
                                TextAnchor anchor) const {
  cairo_text_extents_t extents;
  cairo_text_extents(context(), text.c_str(), &extents);
  cairo_font_extents_t line;
  cairo_font_extents(context(), &line);
  return {at.x() - anchor.x * extents.x_advance,
          at.y() - anchor.y * (line.ascent + line.descent) + line.ascent};
}

void Sheet::text(const std::string& text, const Eigen::Vector2d& at, const Font& font,
                 Colour colour, TextAnchor anchor) const {
  prepare(font);
  const Eigen::Vector2d start = baseline(text, at, anchor);
  set_source(context(), colour);
  cairo_move_to(context(), start.x(), start.y());
  cairo_show_text(context(), text.c_str());
  cairo_new_path(context());
}

void Sheet::upright_text(const std::string& words, const Eigen::Vector2d& centre, const Font& font,
                         Colour colour) const {
  cairo_save(context());
  cairo_translate(context(), centre.x(), centre.y());
  cairo_rotate(context(), -M_PI_2);
  text(words, {0.0, 0.0}, font, colour, {0.5, 0.5});
  cairo_restore(context());
}

void Sheet::outlined_text(const std::string& text, const Eigen::Vector2d& at, const Font& font,
                          Colour colour, Colour halo, double halo_width, TextAnchor anchor) const {
  prepare(font);
  const Eigen::Vector2d start = baseline(text, at, anchor);
  cairo_new_path(context());
  cairo_move_to(context(), start.x(), start.y());
  cairo_text_path(context(), text.c_str());
  stroke({halo, 2.0 * halo_width});
  this->text(text, at, font, colour, anchor);
}

void Sheet::save() {
  cairo_surface_flush(surface_.get());
  if (file_.extension() == ".png")
    cairo_surface_write_to_png_stream(surface_.get(), append, bytes_.get());
  cairo_surface_finish(surface_.get());
  const cairo_status_t status = cairo_surface_status(surface_.get());
  if (status != CAIRO_STATUS_SUCCESS)
    throw InputError({file_.string()},
                     std::string("the picture can't be drawn: ") + cairo_status_to_string(status));
  if (file_.extension() == ".svg") *bytes_ = renumber_groups(*bytes_);
  if (file_.extension() == ".png" && dots_per_inch_ > 0.0)
    *bytes_ = with_resolution(*bytes_, dots_per_inch_);
  write_file(file_, *bytes_);
}

}  // namespace vigia::report
