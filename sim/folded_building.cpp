#include "folded_building.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

constexpr double kBeside_m = 2e-3;  // of a wall: where its ground is looked at

/// Fractions of the way along a face where the ground folds, with both ends.
std::vector<double> folds_along(const Wall& face, const Ground& ground) {
  std::vector<double> folds{0.0, 1.0};
  for (const GroundPatch& patch : ground.patches()) {
    for (std::size_t i = 0; i < patch.polygon.size(); ++i) {
      const auto crossing = cross_lines(face.a, face.b, patch.polygon[i],
                                        patch.polygon[(i + 1) % patch.polygon.size()]);
      if (!crossing || crossing->along_ab < -1e-9 || crossing->along_ab > 1.0 + 1e-9) continue;
      if (crossing->along_pq > 1e-6 && crossing->along_pq < 1.0 - 1e-6)
        folds.push_back(crossing->along_pq);
    }
  }
  std::sort(folds.begin(), folds.end());
  folds.erase(
      std::unique(folds.begin(), folds.end(), [](double a, double b) { return b - a < 1e-6; }),
      folds.end());
  return folds;
}

/// The patches on either side of a stretch of a face; one, when the other side lies outside.
std::vector<const GroundPatch*> patches_beside(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                               const FloorPlan& plan, const Ground& ground) {
  const Eigen::Vector2d along = (b - a).normalized();
  const Eigen::Vector2d beside = kBeside_m * Eigen::Vector2d(-along.y(), along.x());
  const Eigen::Vector2d middle = 0.5 * (a + b);
  std::vector<const GroundPatch*> patches;
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(middle + beside), Eigen::Vector2d(middle - beside)})
    if (inside_polygon(p, plan.outline())) patches.push_back(&ground.patches()[ground.patch_at(p)]);
  if (patches.empty()) patches.push_back(&ground.patches()[ground.patch_at(middle)]);
  return patches;
}

Eigen::Vector3d on_patch(const GroundPatch& patch, const Eigen::Vector2d& p) {
  return patch.wMg * Eigen::Vector3d(p.x(), p.y(), 0.0);
}

Surface upright(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double height_m,
                const std::vector<const GroundPatch*>& patches, const Material& material) {
  const auto post = [&](const Eigen::Vector2d& p) {
    Eigen::Vector3d foot = on_patch(*patches.front(), p);
    double top = foot.z() + height_m;
    for (const GroundPatch* patch : patches) {
      const double z = on_patch(*patch, p).z();
      foot.z() = std::min(foot.z(), z);
      top = std::max(top, z + height_m);
    }
    return std::pair{foot, Eigen::Vector3d(foot.x(), foot.y(), top)};
  };
  const auto [foot_a, top_a] = post(a);
  const auto [foot_b, top_b] = post(b);
  Eigen::Vector3d along = foot_b - foot_a;
  along.z() = 0.0;
  return {{foot_a.x(), foot_a.y(), std::min(foot_a.z(), foot_b.z())},
          along.normalized(),
          Eigen::Vector3d::UnitZ(),
          {foot_a, foot_b, top_b, top_a},
          material};
}

/// A piece of a patch, so high above it.
Surface lying(const std::vector<Eigen::Vector2d>& polygon, const GroundPatch& patch,
              double height_m, const Material& material) {
  Surface surface{{}, patch.wMg.linear().col(0), patch.wMg.linear().col(1), {}, material};
  Eigen::Vector2d low = polygon.front();
  for (const Eigen::Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    surface.corners_w.push_back(on_patch(patch, p) + height_m * Eigen::Vector3d::UnitZ());
  }
  surface.origin_w = on_patch(patch, low) + height_m * Eigen::Vector3d::UnitZ();
  return surface;
}

/// In pieces of at most four corners.
void lay(const std::vector<Eigen::Vector2d>& polygon, const GroundPatch& patch, double height_m,
         const Material& material, std::vector<Surface>& surfaces) {
  if (polygon.size() <= 4) {
    surfaces.push_back(lying(polygon, patch, height_m, material));
    return;
  }
  for (const auto& triangle : triangulate(polygon))
    surfaces.push_back(lying({triangle.begin(), triangle.end()}, patch, height_m, material));
}

}  // namespace

std::vector<Surface> building_surfaces(const FloorPlan& plan, const Ground& ground,
                                       const Appearance& look) {
  std::vector<Surface> surfaces;
  const std::size_t walls = plan.outline().size() + plan.partitions().size();
  for (std::size_t i = 0; i < plan.faces().size(); ++i) {
    const Wall& face = plan.faces()[i];
    const std::uint64_t seed = derive_seed(look.seed, i);
    const Material material =
        i < walls ? wall_material(look.wall_grey, look.contrast, face.height_m, seed)
                  : obstacle_material(look.obstacle_grey, look.contrast, seed);
    const auto folds = folds_along(face, ground);
    for (std::size_t k = 0; k + 1 < folds.size(); ++k) {
      const Eigen::Vector2d a = face.a + folds[k] * (face.b - face.a);
      const Eigen::Vector2d b = face.a + folds[k + 1] * (face.b - face.a);
      surfaces.push_back(
          upright(a, b, face.height_m, patches_beside(a, b, plan, ground), material));
    }
  }
  const Material floor =
      floor_material(look.floor_grey, look.contrast, derive_seed(look.seed, "floor"));
  const Material ceiling =
      ceiling_material(look.ceiling_grey, look.contrast, derive_seed(look.seed, "ceiling"));
  for (const GroundPatch& patch : ground.patches()) {
    lay(patch.polygon, patch, 0.0, floor, surfaces);
    lay(patch.polygon, patch, plan.ceiling_m(), ceiling, surfaces);
  }
  for (std::size_t i = 0; i < plan.obstacles().size(); ++i) {
    const Obstacle& obstacle = plan.obstacles()[i];
    const Material material = obstacle_material(look.obstacle_grey + 12.0, look.contrast,
                                                derive_seed(derive_seed(look.seed, "top"), i));
    for (const auto& triangle : triangulate(obstacle.polygon)) {
      const Eigen::Vector2d middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
      lay({triangle.begin(), triangle.end()}, ground.patches()[ground.patch_at(middle)],
          obstacle.height_m, material, surfaces);
    }
  }
  return surfaces;
}

Eigen::Isometry3d painted_frame(const Ground& ground, const Eigen::Vector2d& p, double height_m,
                                bool on_ceiling) {
  Eigen::Isometry3d wMd = Eigen::Isometry3d::Identity();
  wMd.linear() = ground.patches()[ground.patch_at(p)].wMg.linear();
  if (on_ceiling) wMd.linear() *= Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  wMd.translation() = ground.lift(p, height_m);
  return wMd;
}

}  // namespace vigia::sim
