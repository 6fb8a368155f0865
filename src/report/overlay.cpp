#include "vigia/report/overlay.hpp"

#include "outlines.hpp"
#include "sheet.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::report {
namespace {

using imaging::Overlay;

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

// Cairo's pixel centres lie at half-integers.
Eigen::Vector2d on_sheet(double u, double v) {
  return {u + 0.5, v + 0.5};
}

void outlined(const Sheet& sheet, const std::vector<Eigen::Vector2d>& points, bool closed,
              const Stroke& stroke) {
  sheet.polyline(points, closed);
  sheet.stroke({palette::kBlack.with_alpha(0.8), stroke.width + 2.0});
  sheet.polyline(points, closed);
  sheet.stroke(stroke);
}

void draw_ellipse(const Sheet& sheet, const Ellipse& e, const Stroke& stroke) {
  constexpr int kPoints = 96;
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector2d& p : outline_points(e, kPoints))
    outline.push_back(on_sheet(p.x(), p.y()));
  outlined(sheet, outline, true, stroke);
}

void draw_cross(const Sheet& sheet, const Eigen::Vector2d& centre, double arm,
                const Stroke& stroke) {
  const Eigen::Vector2d u(arm, 0.0);
  const Eigen::Vector2d v(0.0, arm);
  outlined(sheet, {centre - u, centre + u}, false, stroke);
  outlined(sheet, {centre - v, centre + v}, false, stroke);
}

void draw_on(const Sheet& sheet, const Overlay& overlay, double width) {
  const double unit = std::clamp(width / 640.0, 0.6, 3.0);
  if (overlay.principal_point && overlay.principal_point->allFinite())
    draw_cross(sheet, on_sheet(overlay.principal_point->x(), overlay.principal_point->y()),
               11.0 * unit, {palette::kWhite, 1.2 * unit});
  if (overlay.predicted && is_finite(*overlay.predicted))
    draw_ellipse(sheet, *overlay.predicted, {palette::kOrange, 1.6 * unit, {5.0, 4.0}});
  if (overlay.measured && is_finite(*overlay.measured)) {
    draw_ellipse(sheet, *overlay.measured, {palette::kSkyBlue, 1.6 * unit});
    draw_cross(sheet, on_sheet(overlay.measured->u, overlay.measured->v), 3.0 * unit,
               {palette::kSkyBlue, 1.2 * unit});
  }
  for (const Eigen::Vector2d& point : overlay.points)
    if (point.allFinite())
      draw_cross(sheet, on_sheet(point.x(), point.y()), 3.0 * unit,
                 {palette::kSkyBlue, 1.2 * unit});
  const Font font{std::max(10.0, 14.0 * unit), true};
  double y = 6.0 * unit;
  for (const std::string& line : overlay.lines) {
    sheet.outlined_text(line, {8.0 * unit, y}, font, palette::kWhite, palette::kBlack, 2.0 * unit,
                        {0.0, 0.0});
    y += sheet.text_size(line, font).y() * 1.1;
  }
}

unsigned char blend(unsigned char below, unsigned char premultiplied, unsigned alpha) {
  return static_cast<unsigned char>(premultiplied + (below * (255U - alpha) + 127U) / 255U);
}

// Cairo's ARGB32 is one native word a pixel, colours multiplied by alpha.
void compose_onto(vpImage<vpRGBa>& image, cairo_surface_t* layer) {
  cairo_surface_flush(layer);
  const unsigned char* data = cairo_image_surface_get_data(layer);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(layer));
  for (unsigned v = 0; v < image.getHeight(); ++v) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(data + v * stride);
    for (unsigned u = 0; u < image.getWidth(); ++u) {
      const std::uint32_t word = row[u];
      const unsigned alpha = word >> 24U;
      if (alpha == 0) continue;
      vpRGBa& pixel = image[v][u];
      pixel.R = blend(pixel.R, static_cast<unsigned char>(word >> 16U), alpha);
      pixel.G = blend(pixel.G, static_cast<unsigned char>(word >> 8U), alpha);
      pixel.B = blend(pixel.B, static_cast<unsigned char>(word), alpha);
    }
  }
}

}  // namespace

void draw_overlay(vpImage<vpRGBa>& image, const Overlay& overlay) {
  const Surface layer(
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(image.getWidth()),
                                 static_cast<int>(image.getHeight())),
      &cairo_surface_destroy);
  draw_on(Sheet(layer.get()), overlay, image.getWidth());
  compose_onto(image, layer.get());
}

}  // namespace vigia::report
