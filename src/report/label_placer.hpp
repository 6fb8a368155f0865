#pragma once

#include "sheet.hpp"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace vigia::report {

/// Finds room for labels: a place that meets no box already taken and as few of the drawing's
/// points as can be.
class LabelPlacer {
 public:
  explicit LabelPlacer(const Box& bounds) : bounds_(bounds) {}

  /// Keeps later labels off @p box.
  void block(const Box& box) { taken_.push_back(box); }
  /// Makes later labels avoid a point of the drawing, where they can.
  void avoid(const Eigen::Vector2d& point) { points_.push_back(point); }

  /// A box of @p size beside @p anchor at the clearance @p gap, taken from now on. The first
  /// choice lies in direction @p preferred (a unit vector, y down). Nothing when every place
  /// within three gaps overlaps another box.
  std::optional<Box> place(const Eigen::Vector2d& anchor, const Eigen::Vector2d& size, double gap,
                           const Eigen::Vector2d& preferred);

 private:
  std::optional<double> cost(const Box& box) const;

  Box bounds_;
  std::vector<Box> taken_;
  std::vector<Eigen::Vector2d> points_;
};

}  // namespace vigia::report
