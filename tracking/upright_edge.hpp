#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/goal_corner_finder.hpp"

namespace vigia::tracking {

/// A window's pixels.
struct ColourWindow {
  imaging::Window window;
  std::vector<vpRGBa> pixels;

  const vpRGBa& at(int u, int v) const {
    return pixels[static_cast<std::size_t>(v - window.v) * static_cast<std::size_t>(window.width) +
                  static_cast<std::size_t>(u - window.u)];
  }
};

ColourWindow read_colour_window(const imaging::Frame& frame, const imaging::Window& window);

/// A row's change between white and a goal's colour: the last pixel of the one and the first of
/// the other, and how many pixels of each lie beside it, at most GoalCornerParams::side_px.
struct ColourTransition {
  int v = 0;
  int left = 0;
  int right = 0;
  int left_run = 0;
  int right_run = 0;
  FieldColour colour = FieldColour::yellow;
  bool colour_on_right = true;

  double middle() const { return 0.5 * (left + right); }
};

/// Fits one edge to the rows of @p group, the uppermost first. Nothing where the colours differ too
/// little, the fit does not come to rest or leaves too much.
std::optional<GoalCornerImage> fit_upright_edge(const ColourWindow& picture,
                                                const std::vector<ColourTransition>& group,
                                                const GoalCornerParams& params);

}  // namespace vigia::tracking
