#pragma once

#include <cstddef>
#include <vector>

#include "vigia/core/field_scan.hpp"

namespace vigia::localization {

/// Points of a scan that lie on one straight line, whichever it is.
struct StraightGroup {
  std::vector<std::size_t> points;     ///< indices into the scan
  std::vector<double> line_densities;  ///< of each over bearing and range, as a point of that line
};

/// Groups of at least @p min_points points that lie within 3σ of a straight line, the largest
/// first; a point belongs to one group at most. Lines through all pairs of points are tried, each
/// group taken out before the next is looked for. @p floor_m: σ added to each point.
std::vector<StraightGroup> straight_groups(const std::vector<FieldPoint>& points, double floor_m,
                                           std::size_t min_points = 5);

}  // namespace vigia::localization
