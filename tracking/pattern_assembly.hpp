#pragma once

#include "blob_finder.hpp"
#include "plane_map.hpp"

#include <array>
#include <optional>
#include <vector>

#include "vigia/core/colour_pattern.hpp"

namespace vigia::tracking {

/// Places of the dots, in the order of the labels: 0 the centre, 1–8 outer, 9–16 inner, clockwise.
/// Until the black point is known, place 1 is any of the outer ring's, and place 9 beside it.
using DotPlaces = std::array<Eigen::Vector2d, kPatternDots>;
DotPlaces dot_places(const PatternShape& shape);
double dot_radius(const PatternShape& shape, int place);

/// Blobs that stand as the dots of one pattern do.
struct PatternCandidate {
  PatternShape shape;  ///< the geometry; its code is not known yet
  PlaneMap map;        ///< up to turns by an eighth
  std::array<std::optional<EllipseShape>, kPatternDots> dots;  ///< blobs by their places
  int count = 0;                                               ///< of the dots that have a blob
};

/// Finds patterns among blobs: each may be a centre-point. Its ellipse shows how the plane is
/// stretched there, up to a turn; seen unstretched, the other dots lie on two circles at multiples
/// of an eighth of a turn. The turn is the mean phase of the eightfold angle. A homography through
/// the dots takes perspective into account, and sorts out what does not fit.
class PatternAssembly {
 public:
  /// Patterns may have any of @p geometries.
  explicit PatternAssembly(std::vector<PatternShape> geometries)
      : geometries_(std::move(geometries)) {}

  /// The candidates, the most complete first; none shares a blob with another.
  std::vector<PatternCandidate> find(const std::vector<Blob>& blobs) const;

 private:
  std::vector<PatternShape> geometries_;
};

}  // namespace vigia::tracking
