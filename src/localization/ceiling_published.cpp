#include "vigia/localization/ceiling_published.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

/// The cell of nine about @p cell for which @p distance is least.
template <typename Distance>
CeilingCell nearest_of_nine(const CeilingCell& cell, const Distance& distance) {
  CeilingCell best = cell;
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t k1 = -1; k1 <= 1; ++k1) {
    for (std::int64_t k2 = -1; k2 <= 1; ++k2) {
      const CeilingCell candidate{cell.i + k1, cell.j + k2};
      const double off = distance(candidate);
      if (off >= least) continue;
      least = off;
      best = candidate;
    }
  }
  return best;
}

const PatchImage& nearest_to_middle(const std::vector<PatchImage>& patches,
                                    const CameraModel& model) {
  const Eigen::Vector2d middle(0.5 * (image_width(model) - 1), 0.5 * (image_height(model) - 1));
  return *std::min_element(patches.begin(), patches.end(),
                           [&](const PatchImage& a, const PatchImage& b) {
                             return (a.uv - middle).norm() < (b.uv - middle).norm();
                           });
}

}  // namespace

void CeilingPublished::reset(const Pose2& pose) {
  pose_ = pose;
  cell_ = nearest_cell(grid_, pose.position());
}

std::optional<CeilingPublished::Fix> CeilingPublished::landmark_fix(
    const std::vector<PatchImage>& patches) const {
  if (patches.empty()) return std::nullopt;
  const auto seen = on_ceiling(camera_, nearest_to_middle(patches, camera_.model));
  if (!seen) return std::nullopt;
  // Eq. 1, mended: θ₁ the patch's direction in the robot's frame, θ₂ and L where it lies there; the
  // patch's own direction is the world's x.
  const double theta = wrap_angle(-seen->psi);
  const double theta2 = std::atan2(seen->q.y(), seen->q.x());
  const Eigen::Vector2d offset = -seen->q.norm() * unit_vector(theta2 + theta);
  // Eqs. 2 to 5: argmin over k₁, k₂ ∈ {−1, 0, 1}.
  const CeilingCell cell = nearest_of_nine(cell_, [&](const CeilingCell& candidate) {
    return (cell_centre(grid_, candidate) + offset - pose_.position()).norm();
  });
  const Eigen::Vector2d p = cell_centre(grid_, cell) + offset;
  return Fix{{p.x(), p.y(), theta}, cell};
}

void CeilingPublished::update(const std::vector<PatchImage>& patches,
                              const std::optional<Pose2>& flow) {
  const auto fix = landmark_fix(patches);
  if (!threshold_m_ || !flow) {
    if (fix) {
      pose_ = fix->pose;
      cell_ = fix->cell;
    }
    return;
  }
  // Fig. 8.
  const Pose2 by_flow = compose(pose_, *flow);
  if (fix && (fix->pose.position() - by_flow.position()).norm() < *threshold_m_) {
    pose_ = fix->pose;
    cell_ = fix->cell;
    return;
  }
  pose_ = by_flow;
  // Eq. 10.
  cell_ = nearest_of_nine(cell_, [&](const CeilingCell& candidate) {
    return (cell_centre(grid_, candidate) - by_flow.position()).norm();
  });
}

}  // namespace vigia::localization
