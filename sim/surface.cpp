#include "surface.hpp"

#include "simd.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

Eigen::Vector3d lift(const Eigen::Vector2d& p, double z) {
  return {p.x(), p.y(), z};
}

Surface horizontal(double height, const Material& material) {
  return {{0.0, 0.0, height}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), {}, material};
}

Linear linear(const Eigen::Vector3d& f) {
  return {static_cast<float>(f.x()), static_cast<float>(f.y()), static_cast<float>(f.z())};
}

Linear minus(const Linear& f, const Linear& g) {
  return {f.a - g.a, f.b - g.b, f.c - g.c};
}

/// How far from its value in the middle of the box @p f gets.
float reach(const Linear& f, const RayBox& box) {
  return std::abs(f.a) * box.hx + std::abs(f.b) * box.hy + std::abs(f.c) * box.hz;
}

bool covers(const SurfaceView& view, const RayBox& box) {
  for (int i = 0; i < view.edge_count; ++i)
    if (minimum(view.edges[static_cast<std::size_t>(i)], box) <= 0.0F) return false;
  return minimum(view.inverse_depth, box) > 0.0F;
}

bool touches(const SurfaceView& view, const RayBox& box) {
  for (int i = 0; i < view.edge_count; ++i)
    if (maximum(view.edges[static_cast<std::size_t>(i)], box) < 0.0F) return false;
  return maximum(view.inverse_depth, box) > 0.0F;
}

/// The noise tile at fixed-point coordinates (8 bits of fraction), −1…1.
inline float tile_at(const std::uint32_t* tile, std::int32_t s, std::int32_t t) {
  constexpr std::int32_t kMask = NoiseTile::kSize - 1;
  const std::uint32_t corners = tile[(((t >> 8) & kMask) << NoiseTile::kBits) | ((s >> 8) & kMask)];
  const auto c00 = static_cast<std::int32_t>(corners & 255U);
  const auto c01 = static_cast<std::int32_t>((corners >> 8) & 255U);
  const auto c10 = static_cast<std::int32_t>((corners >> 16) & 255U);
  const auto c11 = static_cast<std::int32_t>(corners >> 24);
  const std::int32_t fs = s & 255;
  const std::int32_t ft = t & 255;
  const std::int32_t top = (c00 << 8) + fs * (c01 - c00);
  const std::int32_t bottom = (c10 << 8) + fs * (c11 - c10);
  const std::int32_t value = (top << 8) + ft * (bottom - top);
  return static_cast<float>(value) * (1.0F / (127.5F * 65536.0F)) - 1.0F;
}

struct ProfileTable {
  const float* grey;
  float per_m;
  float bias;
  std::int32_t low;
  std::int32_t high;
};

ProfileTable table_of(const Profile& profile) {
  // A repeating table is entered far from 0, so that rounding towards 0 is rounding down.
  if (profile.repeats) return {profile.grey.data(), profile.per_m, 65536.0F, 0, 1 << 30};
  return {profile.grey.data(), profile.per_m, 0.0F, 0, Profile::kSize - 1};
}

inline float profile_at(const ProfileTable& table, float s) {
  auto i = static_cast<std::int32_t>(s * table.per_m + table.bias);
  i = i > table.low ? i : table.low;
  i = i < table.high ? i : table.high;
  return table.grey[i & (Profile::kSize - 1)];
}

struct ShadeConstants {
  Linear depth, s, t;
  float base, coarse, fine, fixed_per_m, offset_s, offset_t, fine_range, steady_t;
  ProfileTable along_s, along_t;
};

VIGIA_PIXEL_BODY float shade_ray(const ShadeConstants& c, const std::uint32_t* tile, float x,
                                 float y, float z) {
  constexpr float kFar = 3e4F;
  const float inverse_depth = c.depth.a * x + c.depth.b * y + c.depth.c * z;
  const float depth = 1.0F / inverse_depth;
  float s = (c.s.a * x + c.s.b * y + c.s.c * z) * depth;
  float t = (c.t.a * x + c.t.b * y + c.t.c * z) * depth;
  s = s > -kFar ? s : -kFar;
  s = s < kFar ? s : kFar;
  t = t > -kFar ? t : -kFar;
  t = t < kFar ? t : kFar;
  float near = inverse_depth * c.fine_range;
  near = near < 1.0F ? near : 1.0F;
  const auto fs = static_cast<std::int32_t>((s + c.offset_s) * c.fixed_per_m);
  const auto ft = static_cast<std::int32_t>((t + c.offset_t) * c.fixed_per_m);
  const float coarse = tile_at(tile, fs >> 3, ft >> 3);
  const float fine = tile_at(tile, fs, ft);
  const float paint_s = profile_at(c.along_s, s);
  const float paint_t = profile_at(c.along_t, t);
  return c.base + c.coarse * coarse + near * (c.fine * fine + paint_s) +
         (c.steady_t + (1.0F - c.steady_t) * near) * paint_t;
}

VIGIA_PIXEL_LOOP
void shade_perspective(const ShadeConstants& k, const std::uint32_t* __restrict tile,
                       const float* __restrict x, const float* __restrict y, int count,
                       float* __restrict grey) {
  const ShadeConstants c = k;
  for (int i = 0; i < count; ++i) grey[i] = shade_ray(c, tile, x[i], y[i], 1.0F);
}
VIGIA_PIXEL_LOOP
void shade_any(const ShadeConstants& k, const std::uint32_t* __restrict tile,
               const float* __restrict x, const float* __restrict y, const float* __restrict z,
               int count, float* __restrict grey) {
  const ShadeConstants c = k;
  for (int i = 0; i < count; ++i) grey[i] = shade_ray(c, tile, x[i], y[i], z[i]);
}

template <bool kPerspective>
VIGIA_PIXEL_BODY void nearest_rays(const std::array<Linear, 4>& edges, const Linear& depth,
                                   ViewId id, const float* __restrict x, const float* __restrict y,
                                   const float* __restrict rz, int count, float* __restrict nearest,
                                   ViewId* __restrict winner) {
  const Linear e0 = edges[0];
  const Linear e1 = edges[1];
  const Linear e2 = edges[2];
  const Linear e3 = edges[3];
  const Linear d = depth;
  for (int i = 0; i < count; ++i) {
    const float z = kPerspective ? 1.0F : rz[i];
    const float inverse_depth = d.a * x[i] + d.b * y[i] + d.c * z;
    const float f0 = e0.a * x[i] + e0.b * y[i] + e0.c * z;
    const float f1 = e1.a * x[i] + e1.b * y[i] + e1.c * z;
    const float f2 = e2.a * x[i] + e2.b * y[i] + e2.c * z;
    const float f3 = e3.a * x[i] + e3.b * y[i] + e3.c * z;
    const bool hit =
        (f0 >= 0.0F) & (f1 >= 0.0F) & (f2 >= 0.0F) & (f3 >= 0.0F) & (inverse_depth > nearest[i]);
    nearest[i] = hit ? inverse_depth : nearest[i];
    winner[i] = hit ? id : winner[i];
  }
}

VIGIA_PIXEL_LOOP
void nearest_perspective(const SurfaceView& view, ViewId id, const float* __restrict x,
                         const float* __restrict y, int count, float* __restrict nearest,
                         ViewId* __restrict winner) {
  nearest_rays<true>(view.edges, view.inverse_depth, id, x, y, nullptr, count, nearest, winner);
}
VIGIA_PIXEL_LOOP
void nearest_any(const SurfaceView& view, ViewId id, const float* __restrict x,
                 const float* __restrict y, const float* __restrict z, int count,
                 float* __restrict nearest, ViewId* __restrict winner) {
  nearest_rays<false>(view.edges, view.inverse_depth, id, x, y, z, count, nearest, winner);
}

VIGIA_PIXEL_LOOP
void evaluate_perspective(const Linear& f, const float* __restrict x, const float* __restrict y,
                          int count, float* __restrict out) {
  const Linear k = f;
  for (int i = 0; i < count; ++i) out[i] = k.a * x[i] + k.b * y[i] + k.c;
}
VIGIA_PIXEL_LOOP
void evaluate_any(const Linear& f, const float* __restrict x, const float* __restrict y,
                  const float* __restrict z, int count, float* __restrict out) {
  const Linear k = f;
  for (int i = 0; i < count; ++i) out[i] = k.a * x[i] + k.b * y[i] + k.c * z[i];
}

/// The direction that a pixel at @p m of the normalised plane shows; beyond the mirror's edge the
/// last one on the way there from its axis.
struct MirrorDirection {
  Eigen::Array3d direction;
  bool seen;
};

MirrorDirection mirror_direction(double xi, double edge_z, const Eigen::Vector2d& m) {
  const double r2 = m.squaredNorm();
  const double root = 1.0 + (1.0 - xi * xi) * r2;
  const double eta = (xi + std::sqrt(std::max(0.0, root))) / (1.0 + r2);
  if (root >= 0.0 && eta - xi >= edge_z) return {{eta * m.x(), eta * m.y(), eta - xi}, true};
  const double radial = std::sqrt((1.0 - edge_z * edge_z) / r2);
  return {{radial * m.x(), radial * m.y(), edge_z}, false};
}

/// From nine samples. Between them a smooth direction strays from what they span by no more than
/// half of what they differ among themselves; beyond the mirror's edge the edge counts.
RayBox box_of_rays(const UnifiedOmni& omni, int u0, int u1, int v0, int v1) {
  Eigen::Array3d low = Eigen::Array3d::Constant(2.0);
  Eigen::Array3d high = -low;
  bool partial = false;
  const double edge_z = min_z(omni);
  for (const double u : {1.0 * u0, 0.5 * (u0 + u1), 1.0 * u1}) {
    for (const double v : {1.0 * v0, 0.5 * (v0 + v1), 1.0 * v1}) {
      const auto [direction, seen] =
          mirror_direction(omni.xi, edge_z, {(u - omni.u0) / omni.px, (v - omni.v0) / omni.py});
      partial = partial || !seen;
      low = low.min(direction);
      high = high.max(direction);
    }
  }
  const Eigen::Array3f middle = (0.5 * (low + high)).cast<float>();
  const Eigen::Array3f half = ((high - low) + 1e-5).cast<float>();
  return {middle.x(), middle.y(), middle.z(), half.x(), half.y(), half.z(), partial};
}

RayBox box_of_rays(const Intrinsics& intrinsics, int u0, int u1, int v0, int v1) {
  const double x0 = (u0 - intrinsics.u0) / intrinsics.px;
  const double x1 = (u1 - intrinsics.u0) / intrinsics.px;
  const double y0 = (v0 - intrinsics.v0) / intrinsics.py;
  const double y1 = (v1 - intrinsics.v0) / intrinsics.py;
  const auto nearest_square = [](double a, double b) {
    return a * b <= 0.0 ? 0.0 : std::min(a * a, b * b);
  };
  const double r2_low = nearest_square(x0, x1) + nearest_square(y0, y1);
  const double r2_high = std::max(x0 * x0, x1 * x1) + std::max(y0 * y0, y1 * y1);
  const double scale_a = 1.0 + intrinsics.kdu * r2_low;
  const double scale_b = 1.0 + intrinsics.kdu * r2_high;
  const auto stretch = [low = std::min(scale_a, scale_b), high = std::max(scale_a, scale_b)](
                           double a, double b) {
    return std::pair{std::min(a * low, a * high), std::max(b * low, b * high)};
  };
  const auto [left, right] = stretch(x0, x1);
  const auto [top, bottom] = stretch(y0, y1);
  constexpr double kSlack = 1.0 + 1e-5;  // covers the rounding to single precision
  return {static_cast<float>(0.5 * (left + right)),
          static_cast<float>(0.5 * (top + bottom)),
          1.0F,
          static_cast<float>(0.5 * (right - left) * kSlack + 1e-6),
          static_cast<float>(0.5 * (bottom - top) * kSlack + 1e-6),
          0.0F};
}

}  // namespace

std::vector<std::array<Eigen::Vector2d, 3>> triangulate(std::vector<Eigen::Vector2d> polygon) {
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  if (area < 0.0) std::reverse(polygon.begin(), polygon.end());

  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = polygon.size();
    const Eigen::Vector2d& a = polygon[(i + n - 1) % n];
    const Eigen::Vector2d& b = polygon[i];
    const Eigen::Vector2d& c = polygon[(i + 1) % n];
    if (cross(b - a, c - b) <= 0.0) return false;
    return std::none_of(polygon.begin(), polygon.end(), [&](const Eigen::Vector2d& p) {
      return cross(b - a, p - a) > 0.0 && cross(c - b, p - b) > 0.0 && cross(a - c, p - c) > 0.0;
    });
  };
  std::vector<std::array<Eigen::Vector2d, 3>> triangles;
  while (polygon.size() >= 3) {
    std::size_t ear = 0;
    while (ear + 1 < polygon.size() && !is_ear(ear)) ++ear;
    const std::size_t n = polygon.size();
    triangles.push_back({polygon[(ear + n - 1) % n], polygon[ear], polygon[(ear + 1) % n]});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

std::vector<Surface> building_surfaces(const FloorPlan& plan, const Appearance& appearance) {
  std::vector<Surface> surfaces;
  const double contrast = appearance.contrast;
  const std::size_t walls = plan.outline().size() + plan.partitions().size();
  for (std::size_t i = 0; i < plan.faces().size(); ++i) {
    const Wall& face = plan.faces()[i];
    const std::uint64_t seed = derive_seed(appearance.seed, i);
    const Eigen::Vector2d along = (face.b - face.a).normalized();
    surfaces.push_back({lift(face.a, 0.0),
                        lift(along, 0.0),
                        Eigen::Vector3d::UnitZ(),
                        {lift(face.a, 0.0), lift(face.b, 0.0), lift(face.b, face.height_m),
                         lift(face.a, face.height_m)},
                        i < walls
                            ? wall_material(appearance.wall_grey, contrast, face.height_m, seed)
                            : obstacle_material(appearance.obstacle_grey, contrast, seed)});
  }
  surfaces.push_back(horizontal(
      0.0, floor_material(appearance.floor_grey, contrast, derive_seed(appearance.seed, "floor"))));
  surfaces.push_back(
      horizontal(plan.ceiling_m(), ceiling_material(appearance.ceiling_grey, contrast,
                                                    derive_seed(appearance.seed, "ceiling"))));
  for (std::size_t i = 0; i < plan.obstacles().size(); ++i) {
    const Obstacle& obstacle = plan.obstacles()[i];
    const Material material =
        obstacle_material(appearance.obstacle_grey + 12.0, contrast,
                          derive_seed(derive_seed(appearance.seed, "top"), i));
    for (const auto& triangle : triangulate(obstacle.polygon)) {
      Surface top = horizontal(obstacle.height_m, material);
      for (const Eigen::Vector2d& p : triangle) top.corners_w.push_back(lift(p, obstacle.height_m));
      surfaces.push_back(std::move(top));
    }
  }
  return surfaces;
}

Surface board_surface(const Eigen::Isometry3d& wMl, double half_width_m, const Material& material) {
  Surface board{wMl.translation(), wMl.linear().col(0), wMl.linear().col(1), {}, material};
  const double w = half_width_m;
  for (const auto& [x, y] : {std::pair{-w, -w}, {w, -w}, {w, w}, {-w, w}})
    board.corners_w.push_back(wMl * Eigen::Vector3d(x, y, 0.0));
  return board;
}

float minimum(const Linear& f, const RayBox& box) {
  return f.a * box.x + f.b * box.y + f.c * box.z - reach(f, box);
}

float maximum(const Linear& f, const RayBox& box) {
  return f.a * box.x + f.b * box.y + f.c * box.z + reach(f, box);
}

RayBox ray_box(const CameraModel& model, int u0, int u1, int v0, int v1) {
  return std::visit([&](const auto& m) { return box_of_rays(m, u0, u1, v0, v1); }, model);
}

bool make_view(const Surface& surface, const Eigen::Isometry3d& cMw, double focal_px,
               SurfaceView& view) {
  const Eigen::Vector3d origin_c = cMw * surface.origin_w;
  const Eigen::Vector3d s_c = cMw.linear() * surface.axis_s;
  const Eigen::Vector3d t_c = cMw.linear() * surface.axis_t;
  const Eigen::Vector3d normal_c = s_c.cross(t_c);
  const double distance = normal_c.dot(origin_c);
  if (std::abs(distance) < 1e-4) return false;

  // A point of the plane on the ray r is r / (n·r/d); from it s = s_c·(p − origin).
  const Eigen::Vector3d inverse_depth = normal_c / distance;
  view.inverse_depth = linear(inverse_depth);
  view.s = linear(s_c - s_c.dot(origin_c) * inverse_depth);
  view.t = linear(t_c - t_c.dot(origin_c) * inverse_depth);
  view.fine_range = static_cast<float>(0.01 * focal_px);
  view.material = &surface.material;

  const std::size_t n = surface.corners_w.size();
  view.edge_count = static_cast<int>(n);
  view.edges.fill({});  // every ray is inside an edge that is not there
  std::array<Eigen::Vector3d, 4> corners_c;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    corners_c[i] = cMw * surface.corners_w[i];
    middle += corners_c[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d edge = corners_c[i].cross(corners_c[(i + 1) % n]);
    view.edges[i] = linear(edge.dot(middle) >= 0.0 ? edge : Eigen::Vector3d(-edge));
  }
  return true;
}

void visible_in(const std::vector<SurfaceView>& views, const std::vector<ViewId>& among,
                const RayBox& box, std::vector<ViewId>& visible, bool& pure) {
  visible.clear();
  for (const ViewId i : among)
    if (touches(views[i], box)) visible.push_back(i);
  pure = false;
  for (const ViewId front : visible) {
    if (!covers(views[front], box)) continue;
    const auto hidden = [&](ViewId other) {
      return other != front &&
             minimum(minus(views[front].inverse_depth, views[other].inverse_depth), box) > 0.0F;
    };
    visible.erase(std::remove_if(visible.begin(), visible.end(), hidden), visible.end());
    pure = visible.size() == 1 && !box.partial;
    return;
  }
}

void shade(const SurfaceView& view, const std::uint32_t* tile, const Rays& rays, int count,
           float* grey) {
  const Material& m = *view.material;
  const ShadeConstants constants{view.inverse_depth,
                                 view.s,
                                 view.t,
                                 m.base,
                                 m.coarse,
                                 m.fine,
                                 m.tiles_per_m * NoiseTile::kSize * 256.0F,
                                 m.offset_s,
                                 m.offset_t,
                                 view.fine_range,
                                 m.along_t.repeats ? 0.0F : 1.0F,
                                 table_of(m.along_s),
                                 table_of(m.along_t)};
  if (rays.z == nullptr)
    shade_perspective(constants, tile, rays.x, rays.y, count, grey);
  else
    shade_any(constants, tile, rays.x, rays.y, rays.z, count, grey);
}

void evaluate(const Linear& f, const Rays& rays, int count, float* out) {
  if (rays.z == nullptr)
    evaluate_perspective(f, rays.x, rays.y, count, out);
  else
    evaluate_any(f, rays.x, rays.y, rays.z, count, out);
}

void take_nearest(const SurfaceView& view, ViewId id, const Rays& rays, int count, float* nearest,
                  ViewId* winner) {
  if (rays.z == nullptr)
    nearest_perspective(view, id, rays.x, rays.y, count, nearest, winner);
  else
    nearest_any(view, id, rays.x, rays.y, rays.z, count, nearest, winner);
}

}  // namespace vigia::sim
