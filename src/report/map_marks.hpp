#pragma once

#include "label_placer.hpp"
#include "sheet.hpp"

#include <string>

#include <Eigen/Core>

namespace vigia::report {

/// Keeps labels off a disc of the drawing.
void block_disc(LabelPlacer& labels, const Eigen::Vector2d& centre, double radius);

/// A label with a white halo beside @p anchor, where @p labels has room for it (see
/// LabelPlacer::place()); nothing where it has none.
void draw_tag(const Sheet& sheet, LabelPlacer& labels, const std::string& text,
              const Eigen::Vector2d& anchor, double gap, const Eigen::Vector2d& preferred,
              const Font& font, Colour colour, double halo_width);

/// A chevron at @p at that points along the unit vector @p u (y down), in ink on a white ground.
void draw_chevron(const Sheet& sheet, const Eigen::Vector2d& at, const Eigen::Vector2d& u,
                  double ground_width, double ink_width);

}  // namespace vigia::report
