#include "vigia/core/passage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

using Eigen::Vector2d;

constexpr double kPassageStep_m = 0.02;
constexpr double kOpposite = -0.5;  // cosine of 120°
constexpr double kOneLine = 0.966;  // cosine of 15°: passages that turn by less are one

Vector2d nearest_on(const Wall& face, const Vector2d& p) {
  const Vector2d ab = face.b - face.a;
  const double t = std::clamp((p - face.a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return face.a + t * ab;
}

/// The narrowest gap between a face on the left and one on the right of somebody at @p p who looks
/// along @p ahead, of the faces' points that are nearest to them.
std::optional<Passage> gap_at(const FloorPlan& plan, const Vector2d& p, const Vector2d& ahead,
                              double reach_m) {
  std::optional<Vector2d> left;
  std::optional<Vector2d> right;
  for (const Wall& face : plan.faces()) {
    const Vector2d q = nearest_on(face, p);
    if ((q - p).norm() > 2.0 * reach_m) continue;
    std::optional<Vector2d>& side = cross(ahead, q - p) > 0.0 ? left : right;
    if (!side || (q - p).norm() < (*side - p).norm()) side = q;
  }
  if (!left || !right) return std::nullopt;
  const Vector2d across = *left - *right;
  const double width_m = across.norm();
  const double nearest_m = std::min((*left - p).norm(), (*right - p).norm());
  if (width_m >= 2.0 * reach_m || width_m <= 0.0 || nearest_m >= reach_m) return std::nullopt;
  // One on the left and one on the right, not the two sides of a corner.
  if ((*left - p).dot(*right - p) > kOpposite * (*left - p).norm() * (*right - p).norm())
    return std::nullopt;
  const Vector2d along(across.y() / width_m, -across.x() / width_m);
  if (along.dot(ahead) <= 0.0) return std::nullopt;
  return Passage{0.0, 0.0, width_m, 0.5 * (*left + *right), along};
}

}  // namespace

std::vector<Passage> find_passages(const FloorPlan& plan, const Path& path, double reach_m) {
  std::vector<Passage> passages;
  if (path.empty()) return passages;
  const int steps = static_cast<int>(std::ceil(path.length() / kPassageStep_m));
  for (int i = 0; i <= steps; ++i) {
    const double station = std::min(i * kPassageStep_m, path.length());
    const Vector2d p = path.at(station);
    // Elsewhere there is nothing to look for.
    if (plan.clearance(p) >= reach_m) continue;
    auto gap = gap_at(plan, p, unit_vector(path.heading(station)), reach_m);
    if (!gap) continue;
    gap->begin_m = gap->end_m = station;
    Passage* last = passages.empty() ? nullptr : &passages.back();
    const bool goes_on = last != nullptr && station - last->end_m <= reach_m &&
                         last->along.dot(gap->along) >= kOneLine;
    // Of one gap seen from several places the narrowest view is the true one.
    const bool same_place = last != nullptr && station - last->end_m <= 1.5 * kPassageStep_m;
    if (!goes_on && !same_place) {
      passages.push_back(*gap);
      continue;
    }
    gap->begin_m = last->begin_m;
    if (gap->width_m < last->width_m)
      *last = *gap;
    else
      last->end_m = station;
  }
  return passages;
}

}  // namespace vigia
