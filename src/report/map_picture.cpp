#include "vigia/report/map_picture.hpp"

#include "drive_layer.hpp"
#include "error_chart.hpp"
#include "map_page.hpp"
#include "map_view.hpp"
#include "sheet.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>

namespace vigia::report {
namespace {

constexpr double kAxisHeight = 58.0;
constexpr double kLegendRow = 27.0;
constexpr double kChartHeight = 240.0;
constexpr double kChartAbove = 44.0;
constexpr double kChartBelow = 72.0;
constexpr double kFooter = 34.0;

// A line of the legend: what is drawn into the space left of the words, and the words.
struct LegendEntry {
  std::function<void(const Sheet&, const Box&)> draw;
  std::string text;
};

Eigen::Vector2d middle(const Box& box) {
  return {box.x + 0.5 * box.width, box.y + 0.5 * box.height};
}

LegendEntry line_entry(const Stroke& stroke, const std::string& text) {
  return {[stroke](const Sheet& sheet, const Box& box) {
            sheet.line({box.x, middle(box).y()}, {box.right(), middle(box).y()}, stroke);
          },
          text};
}

LegendEntry ellipse_entry(const MapDrive& drive, const DriveStyle& style) {
  const double scale = ellipse_scale(drive);
  std::ostringstream times;
  times << ", drawn " << scale << " × its size";
  return {[style](const Sheet& sheet, const Box& box) {
            const auto outline =
                ellipse_outline(middle(box), Eigen::Vector2d(196.0, 49.0).asDiagonal(), 1.0);
            sheet.polyline(outline, true);
            sheet.fill(style.ellipse.colour.with_alpha(style.ellipse_fill));
            sheet.polyline(outline, true);
            sheet.stroke(style.ellipse);
          },
          "95 % ellipse every metre" + (scale == 1.0 ? std::string() : times.str())};
}

LegendEntry look_entry(const DriveStyle& style, bool fused) {
  const Stroke sight{palette::kGreen, style.sight_width,
                     fused ? std::vector<double>{} : style.unfused_dashes};
  return {[sight, fused](const Sheet& sheet, const Box& box) {
            const Eigen::Vector2d left(box.x + 5.0, middle(box).y());
            sheet.line(left, {box.right(), left.y()}, sight);
            sheet.circle(left, 5.0);
            sheet.fill(fused ? palette::kGreen : palette::kWhite);
            sheet.circle(left, 5.0);
            sheet.stroke({palette::kInk, 1.3});
          },
          fused ? "look, numbered, in its landmark's colour" : "look that was not used"};
}

LegendEntry ring_entry(const DriveStyle& style) {
  return {[style](const Sheet& sheet, const Box& box) {
            sheet.circle(middle(box), 11.0);
            sheet.stroke(style.ring);
          },
          "relocalisation"};
}

LegendEntry landmark_entry() {
  return {[](const Sheet& sheet, const Box& box) {
            sheet.line(middle(box), middle(box) + Eigen::Vector2d(16.0, 0.0), {palette::kInk, 2.0});
            sheet.circle(middle(box), 7.0);
            sheet.fill(palette::kGreen);
            sheet.circle(middle(box), 7.0);
            sheet.stroke({palette::kInk, 1.5});
          },
          "landmark and its normal"};
}

std::vector<LegendEntry> legend_of(const MapDrive& drive, const DriveStyle& style) {
  std::vector<LegendEntry> entries;
  if (!drive.planned.empty()) entries.push_back(line_entry(style.planned, "planned path"));
  if (!drive.truth.empty()) entries.push_back(line_entry(style.truth, "true path"));
  if (!drive.estimate.empty()) {
    entries.push_back(line_entry(style.estimate, drive.estimate_name));
    entries.push_back(ellipse_entry(drive, style));
  }
  if (!drive.jumps.empty())
    entries.push_back(line_entry(style.kidnapping, "kidnapped: put elsewhere, not driven"));
  if (!drive.odometry.empty()) entries.push_back(line_entry(style.odometry, "odometry"));
  if (!drive.world.landmarks.all().empty()) entries.push_back(landmark_entry());
  const auto fused = [](const MapLook& look) { return look.fused; };
  if (std::any_of(drive.looks.begin(), drive.looks.end(), fused))
    entries.push_back(look_entry(style, true));
  if (drive.look_ring_m > 0.0) entries.push_back(ring_entry(style));
  if (!std::all_of(drive.looks.begin(), drive.looks.end(), fused))
    entries.push_back(look_entry(style, false));
  return entries;
}

// Lays the entries out in rows from the left and draws them; returns the y below the last row.
double draw_legend(const Sheet& sheet, const std::vector<LegendEntry>& entries, double top) {
  constexpr double kIcon = 38.0;
  const Font font{14.0};
  double x = kPageLeft;
  double y = top;
  for (const LegendEntry& entry : entries) {
    const double width = kIcon + 9.0 + sheet.text_size(entry.text, font).x() + 32.0;
    if (x > kPageLeft && x + width > kPageWidth - kPageRight + 32.0) {
      x = kPageLeft;
      y += kLegendRow;
    }
    entry.draw(sheet, {x, y, kIcon, kLegendRow});
    sheet.text(entry.text, {x + kIcon + 9.0, y + 0.5 * kLegendRow}, font, palette::kInk);
    x += width;
  }
  return y + kLegendRow;
}

void check(const MapDrive& drive) {
  const auto fits = [&](std::size_t size) { return size == 0 || size == drive.truth.size(); };
  if (!fits(drive.estimate.size()) || !fits(drive.odometry.size()))
    throw std::invalid_argument(
        "draw_map: truth, estimate and odometry must have the same length, found " +
        std::to_string(drive.truth.size()) + ", " + std::to_string(drive.estimate.size()) +
        " and " + std::to_string(drive.odometry.size()));
  const auto beyond = [&](std::size_t instant) { return instant >= drive.truth.size(); };
  const bool marks_fit = std::none_of(drive.marks.begin(), drive.marks.end(),
                                      [&](const MapMark& mark) { return beyond(mark.instant); });
  if (!marks_fit || std::any_of(drive.jumps.begin(), drive.jumps.end(), beyond))
    throw std::invalid_argument("draw_map: a jump or a mark lies beyond the last instant of truth");
}

// The legend's height depends on the width of its words, so a trial sheet measures it.
double legend_height(const std::vector<LegendEntry>& entries) {
  return draw_legend(Sheet("trial.png", 1.0, 1.0), entries, 0.0);
}

}  // namespace

void draw_map(const MapDrive& drive, const std::filesystem::path& file) {
  check(drive);
  const DriveStyle style;
  const MapView view = page_view(drive.world.plan);
  const std::vector<LegendEntry> legend = legend_of(drive, style);
  const bool chart = drive.truth.size() > 1;
  const double legend_top = view.box().bottom() + kAxisHeight;
  const double chart_top = legend_top + legend_height(legend) + kChartAbove;
  const double bottom = chart ? chart_top + kChartHeight + kChartBelow : chart_top - kChartAbove;

  Sheet sheet(file, kPageWidth, std::ceil(bottom + (drive.footer.empty() ? 12.0 : kFooter)));
  draw_page_title(sheet, drive.title, drive.subtitle);
  draw_floor(sheet, view, drive.world.plan);
  draw_drive(sheet, view, drive, style);
  draw_axes(sheet, view);
  draw_legend(sheet, legend, legend_top);
  if (chart) draw_error_chart(sheet, {kPageLeft, chart_top, kPageText, kChartHeight}, drive, style);
  sheet.text(drive.footer, {kPageLeft, bottom + 12.0}, {13.0}, palette::kMuted);
  sheet.save();
}

}  // namespace vigia::report
