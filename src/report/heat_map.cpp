#include "vigia/report/heat_map.hpp"

#include "sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace vigia::report {
namespace {

constexpr double kHeatWidth = 900.0;
constexpr double kHeatLeft = 50.0;
constexpr double kHeatTop = 60.0;
constexpr double kHeatAcross = 740.0;
constexpr double kHeatKey = 20.0;

/// Stops of a scale from light to dark that reads the same in grey.
constexpr std::array<Colour, 5> kHeatStops{palette::hex(0xfcfdbf), palette::hex(0xfc8961),
                                           palette::hex(0xb73779), palette::hex(0x51127c),
                                           palette::hex(0x000004)};

Colour heat_colour(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kHeatStops.size() - 1.0);
  const auto low = std::min(static_cast<std::size_t>(at), kHeatStops.size() - 2);
  const double part = at - static_cast<double>(low);
  const Colour& a = kHeatStops[low];
  const Colour& b = kHeatStops[low + 1];
  return {a.r + part * (b.r - a.r), a.g + part * (b.g - a.g), a.b + part * (b.b - a.b), 1.0};
}

std::string heat_figure(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

void draw_heat_cells(const Sheet& sheet, const HeatMap& map, const Box& frame) {
  const double w = frame.width / map.columns;
  const double h = frame.height / map.rows;
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const int index = row * map.columns + column;
      const double value = map.values[static_cast<std::size_t>(index)];
      if (std::isnan(value)) continue;
      sheet.rectangle({frame.x + w * column, frame.bottom() - h * (row + 1), w + 0.5, h + 0.5});
      sheet.fill(heat_colour(value / map.top));
    }
}

void draw_heat_key(const Sheet& sheet, const HeatMap& map, const Box& frame) {
  constexpr int kSteps = 50;
  const Box key{frame.right() + 20.0, frame.y, kHeatKey, frame.height};
  for (int i = 0; i < kSteps; ++i) {
    const double h = key.height / kSteps;
    sheet.rectangle({key.x, key.bottom() - h * (i + 1), key.width, h + 0.5});
    sheet.fill(heat_colour((i + 0.5) / kSteps));
  }
  for (const double share : {0.0, 0.5, 1.0})
    sheet.text(heat_figure(share * map.top) + (share == 1.0 ? " " + map.unit : ""),
               {key.right() + 6.0, key.bottom() - share * key.height}, {}, palette::kInk);
}

}  // namespace

void write_heat_map(const std::filesystem::path& file, const HeatMap& map) {
  const Eigen::Vector2d size = map.max_m - map.min_m;
  const int cells = map.columns * map.rows;
  if (map.columns <= 0 || map.rows <= 0 || !(map.top > 0.0) || !(size.minCoeff() > 0.0) ||
      map.values.size() != static_cast<std::size_t>(cells))
    throw std::invalid_argument("a heat map needs a value for each of its cells and a scale");
  const Box frame{kHeatLeft, kHeatTop, kHeatAcross, kHeatAcross * size.y() / size.x()};
  Sheet sheet(file, kHeatWidth, frame.bottom() + 30.0);
  sheet.rectangle({0.0, 0.0, kHeatWidth, frame.bottom() + 30.0});
  sheet.fill(palette::kWhite);
  sheet.text(map.title, {kHeatLeft, 30.0}, {18.0, true}, palette::kInk);
  draw_heat_cells(sheet, map, frame);
  for (const auto& line : map.lines) {
    std::vector<Eigen::Vector2d> drawn;
    drawn.reserve(line.size());
    for (const Eigen::Vector2d& p : line)
      drawn.emplace_back(frame.x + frame.width * (p.x() - map.min_m.x()) / size.x(),
                         frame.bottom() - frame.height * (p.y() - map.min_m.y()) / size.y());
    sheet.polyline(drawn);
    sheet.stroke({palette::kSkyBlue, 1.5});
  }
  draw_heat_key(sheet, map, frame);
  sheet.save();
}

}  // namespace vigia::report
