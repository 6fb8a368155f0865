#include "map_marks.hpp"

#include <vector>

namespace vigia::report {

void block_disc(LabelPlacer& labels, const Eigen::Vector2d& centre, double radius) {
  labels.block({centre.x() - radius, centre.y() - radius, 2.0 * radius, 2.0 * radius});
}

void draw_tag(const Sheet& sheet, LabelPlacer& labels, const std::string& text,
              const Eigen::Vector2d& anchor, double gap, const Eigen::Vector2d& preferred,
              const Font& font, Colour colour, double halo_width) {
  const Eigen::Vector2d size = sheet.text_size(text, font) + Eigen::Vector2d(4.0, 0.0);
  if (const auto box = labels.place(anchor, size, gap, preferred))
    sheet.outlined_text(text, {box->x + 0.5 * box->width, box->y + 0.5 * box->height}, font, colour,
                        palette::kWhite, halo_width, {0.5, 0.5});
}

void draw_chevron(const Sheet& sheet, const Eigen::Vector2d& at, const Eigen::Vector2d& u,
                  double ground_width, double ink_width) {
  const Eigen::Vector2d left(-u.y(), u.x());
  const Eigen::Vector2d tip = at + 7.0 * u;
  const std::vector<Eigen::Vector2d> chevron{tip - 13.0 * u + 8.0 * left, tip,
                                             tip - 13.0 * u - 8.0 * left};
  sheet.polyline(chevron);
  sheet.stroke({palette::kWhite, ground_width});
  sheet.polyline(chevron);
  sheet.stroke({palette::kInk, ink_width});
}

}  // namespace vigia::report
