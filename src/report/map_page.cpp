#include "map_page.hpp"

namespace vigia::report {
namespace {

constexpr double kMapTop = 96.0;
constexpr double kMapHeight = 1000.0;
constexpr double kMapMargin_m = 0.45;

}  // namespace

MapView page_view(const FloorPlan& plan) {
  return fit_view(plan, kMapMargin_m, {kPageLeft, kMapTop, kPageText, kMapHeight});
}

void draw_page_title(const Sheet& sheet, const std::string& title, const std::string& subtitle) {
  sheet.text(title, {kPageLeft, 34.0}, {26.0, true}, palette::kInk);
  sheet.text(subtitle, {kPageLeft, 68.0}, {16.0}, palette::kMuted);
}

}  // namespace vigia::report
