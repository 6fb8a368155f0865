#pragma once

#include "rays.hpp"
#include "texture.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/floor_plan.hpp"
#include "vigia/sim/appearance.hpp"

namespace vigia::sim {

/// A flat piece of the world: a convex polygon, or without corners the whole plane. (s, t) are
/// metres along its axes from the origin.
struct Surface {
  Eigen::Vector3d origin_w;
  Eigen::Vector3d axis_s;
  Eigen::Vector3d axis_t;
  std::vector<Eigen::Vector3d> corners_w;
  Material material;
};

/// The surfaces of a building: faces first, in the plan's order, then floor, ceiling, and the tops
/// of the obstacles.
std::vector<Surface> building_surfaces(const FloorPlan& plan, const Appearance& appearance);

/// Triangles of a simple polygon, by ear clipping.
std::vector<std::array<Eigen::Vector2d, 3>> triangulate(std::vector<Eigen::Vector2d> polygon);

/// An upright board of its own, for a landmark that hangs on no face.
Surface board_surface(const Eigen::Isometry3d& wMl, double half_width_m, const Material& material);

/// a·x + b·y + c·z of the ray (x, y, z).
struct Linear {
  float a = 0.0F;
  float b = 0.0F;
  float c = 0.0F;
};

/// A box of rays.
struct RayBox {
  float x = 0.0F;  ///< middle
  float y = 0.0F;
  float z = 1.0F;
  float hx = 0.0F;  ///< half widths
  float hy = 0.0F;
  float hz = 0.0F;
  bool partial = false;  ///< whether some of its pixels show nothing
};

float minimum(const Linear& f, const RayBox& box);
float maximum(const Linear& f, const RayBox& box);

/// A box that holds the rays of all pixels with u in [u0, u1] and v in [v0, v1] that show anything.
RayBox ray_box(const CameraModel& model, int u0, int u1, int v0, int v1);

/// A surface as one exposure sees it. A ray r meets it at depth 1/inverse_depth(r), within the
/// polygon where no edge is negative, and there s = s(r)/inverse_depth(r), t likewise.
struct SurfaceView {
  std::array<Linear, 4> edges;
  int edge_count = 0;
  Linear inverse_depth;
  Linear s;
  Linear t;
  float fine_range = 1.0F;  ///< depth up to which the fine texture has its full contrast, m
  const Material* material = nullptr;
  std::size_t index = 0;  ///< of the Surface
};

/// Position of a view among those of an exposure.
using ViewId = std::uint16_t;

/// Whether a view exists: not when the camera lies in the surface's plane.
bool make_view(const Surface& surface, const Eigen::Isometry3d& cMw, double focal_px,
               SurfaceView& view);

/// Of @p views (by position), those that some ray of the box meets first, and perhaps a few more.
/// The surface is alone, covers the box and is seen by every pixel of it when @p pure comes back
/// true.
void visible_in(const std::vector<SurfaceView>& views, const std::vector<ViewId>& among,
                const RayBox& box, std::vector<ViewId>& visible, bool& pure);

/// Grey of a surface along @p count rays, wherever they meet its plane.
void shade(const SurfaceView& view, const std::uint32_t* tile, const Rays& rays, int count,
           float* grey);

/// @p f along @p count rays.
void evaluate(const Linear& f, const Rays& rays, int count, float* out);

/// Where the surface is met and is nearer than nearest[i], takes nearest[i] and sets winner[i].
void take_nearest(const SurfaceView& view, ViewId id, const Rays& rays, int count, float* nearest,
                  ViewId* winner);

}  // namespace vigia::sim
