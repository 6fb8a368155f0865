#include "scene_content.hpp"

#include "field_surfaces.hpp"
#include "folded_building.hpp"
#include "landmark_decals.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);
constexpr double kOnSurface_m = 0.02;  ///< what is nearer to a surface is painted on it

/// The first surface of @p surfaces among the faces that carries a picture of this frame.
std::size_t face_under(const std::vector<Surface>& surfaces, const Eigen::Isometry3d& wMd,
                       double tolerance_m) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Surface& surface = surfaces[i];
    const Eigen::Vector3d normal = surface.axis_s.cross(surface.axis_t);
    if (std::abs(normal.dot(wMd.linear().col(2))) < 0.99) continue;
    const Eigen::Vector3d offset = wMd.translation() - surface.origin_w;
    if (std::abs(normal.dot(offset)) > tolerance_m) continue;
    if (surface.corners_w.empty()) return i;
    const double s = surface.axis_s.dot(offset);
    const double t = surface.axis_t.dot(offset);
    double s_end = 0.0;
    double t_end = 0.0;
    for (const Eigen::Vector3d& corner : surface.corners_w) {
      s_end = std::max(s_end, surface.axis_s.dot(corner - surface.origin_w));
      t_end = std::max(t_end, surface.axis_t.dot(corner - surface.origin_w));
    }
    if (s >= 0.0 && s <= s_end && t >= 0.0 && t <= t_end) return i;
  }
  return kNowhere;
}

DecalShape shape_of(ClutterKind kind) {
  switch (kind) {
    case ClutterKind::ellipse:
      return DecalShape::ellipse;
    case ClutterKind::ring:
      return DecalShape::ring;
    case ClutterKind::square:
      return DecalShape::square;
    case ClutterKind::half_disc:
      return DecalShape::half_disc;
    case ClutterKind::disc:
      return DecalShape::disc;
    case ClutterKind::blob:
      break;
  }
  return DecalShape::blob;
}

/// Frame of what lies on the floor or, its z pointing down, on the ceiling.
Eigen::Isometry3d level_frame(const Eigen::Vector3d& centre_w, bool on_ceiling) {
  Eigen::Isometry3d wMd(Eigen::Translation3d{centre_w});
  if (on_ceiling) wMd.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  return wMd;
}

Eigen::Isometry3d paint_frame(const Eigen::Vector3d& centre, bool on_ceiling,
                              const Ground& ground) {
  if (ground.patches().empty()) return level_frame(centre, on_ceiling);
  return painted_frame(ground, centre.head<2>(), centre.z(), on_ceiling);
}

Eigen::Isometry3d frame_of(const Clutter& clutter, const Ground& ground) {
  const Eigen::Isometry3d wMd =
      clutter.place == ClutterPlace::face
          ? ground.hang(wall_mount(clutter.centre_w, clutter.normal_yaw))
          : paint_frame(clutter.centre_w, clutter.place == ClutterPlace::ceiling, ground);
  return wMd * Eigen::AngleAxisd(clutter.turn, Eigen::Vector3d::UnitZ());
}

/// Tiles of texture between two patches: about 1.3 a metre, and a share of one left over that keeps
/// the texture under a patch from being that under the next ones (the golden section's).
double tiles_a_pitch(double pitch_m) {
  const double tiles = 1.3 * pitch_m;
  const double whole = std::floor(tiles);
  return whole + (tiles - whole < 0.5 ? 0.382 : 0.618);
}

}  // namespace

SceneContent::SceneContent(const WorldMap& world, const Appearance& look, std::uint64_t noise_seed)
    : seed(noise_seed),
      light(static_cast<float>(look.light)),
      tile(derive_seed(look.seed, "noise tile")),
      surfaces(world.ground.patches().empty() ? building_surfaces(world.plan, look)
                                              : building_surfaces(world.plan, world.ground, look)) {
  for (const Stripe& stripe : look.stripes) paint(stripe, world);
  for (const Clutter& clutter : look.clutter) paint(clutter, world.ground);
  for (const Landmark& landmark : world.landmarks.all()) hang(landmark, look);
  if (world.field) lay_out(*world.field, world.plan, look);
  if (world.ceiling) hang(*world.ceiling, world.plan, look);
  if (look.light_kelvin != Appearance{}.light_kelvin) shine(lamp_gains(look.light_kelvin));
}

void SceneContent::paint(const Stripe& stripe, const WorldMap& world) {
  const Eigen::Vector2d along = stripe.to - stripe.from;
  const Eigen::Vector2d middle = 0.5 * (stripe.from + stripe.to);
  StripeMark mark;
  mark.wMd = paint_frame({middle.x(), middle.y(), stripe.on_ceiling ? world.plan.ceiling_m() : 0.0},
                         stripe.on_ceiling, world.ground);
  const double turn = std::atan2(along.y(), along.x());
  mark.wMd =
      mark.wMd * Eigen::AngleAxisd(stripe.on_ceiling ? -turn : turn, Eigen::Vector3d::UnitZ());
  mark.half_length_m = 0.5 * along.norm();
  mark.half_width_m = 0.5 * stripe.width_m;
  mark.grey = static_cast<float>(stripe.grey);
  mark.surface = face_under(surfaces, mark.wMd, kOnSurface_m);
  if (mark.surface != kNowhere) stripes.push_back(mark);
}

void SceneContent::paint(const Clutter& clutter, const Ground& ground) {
  Decal mark{shape_of(clutter.kind),           frame_of(clutter, ground),         clutter.size_m,
             static_cast<float>(clutter.grey), clutter.kind == ClutterKind::disc, 0};
  mark.surface = face_under(surfaces, mark.wMd, kOnSurface_m);
  if (mark.surface != kNowhere) decals.push_back(mark);
}

/// A landmark's sheet and picture, on the face under it or on a board of its own.
void SceneContent::hang(const Landmark& landmark, const Appearance& look) {
  const double half_width = sheet_half_width(landmark, look);
  std::size_t under = face_under(surfaces, landmark.wMl, kOnSurface_m);
  if (under == kNowhere) {
    under = surfaces.size();
    surfaces.push_back(board_surface(
        landmark.wMl, 1.1 * half_width,
        obstacle_material(look.obstacle_grey, look.contrast, derive_seed(look.seed, under))));
  }
  for (Decal& decal : landmark_decals(landmark, look)) {
    decal.surface = under;
    decals.push_back(std::move(decal));
  }
}

/// The carpet takes the floor's height; the floor itself sinks below it.
void SceneContent::lay_out(const FieldMap& map, const FloorPlan& plan, const Appearance& look) {
  surfaces[plan.faces().size()].origin_w.z() = -kCarpet_m;
  const auto grey = static_cast<float>(look.line_grey);
  field = {FieldPaint(map), {grey, {1.0F, 1.0F, 1.0F}}, surfaces.size()};
  surfaces.push_back(carpet_surface(map, look));
  for (auto& group : {goal_surfaces(map, look), advert_surfaces(map, plan, look)})
    surfaces.insert(surfaces.end(), group.begin(), group.end());
  for (auto& group : {post_parts(map), spectator_parts(map, plan, look)})
    solids.insert(solids.end(), group.begin(), group.end());
}

void SceneContent::hang(const CeilingGrid& grid, const FloorPlan& plan, const Appearance& look) {
  CeilingTruth truth;
  truth.grid = grid;
  truth.seed = derive_seed(look.seed, "ceiling patches");
  truth.missing = look.patches_missing;
  truth.spurious = look.patches_spurious;
  truth.patch_grey = look.patch_grey;
  truth.lamp_pitch_m = look.lamp_pitch_m;
  truth.lamp_grey = look.lamp_grey;
  truth.pipe_pitch_m = look.pipe_pitch_m;
  truth.pipe_drop_m = look.pipe_drop_m;
  hang(truth, plan);
}

/// The ceiling follows the floor among the surfaces of a building.
void SceneContent::hang(const CeilingTruth& truth, const FloorPlan& plan) {
  ceiling = {truth, plan.ceiling_m(), plan.faces().size() + 1};
  surfaces[ceiling->surface].material.tiles_per_m =
      static_cast<float>(tiles_a_pitch(truth.grid.pitch_m) / truth.grid.pitch_m);
}

/// Gives everything the lamp's colour.
void SceneContent::shine(const std::array<float, 3>& gains) {
  for (Surface& surface : surfaces) surface.material = lit(surface.material, gains);
  const auto dye = [&gains](auto& painted) {
    const Ink shone = lit(Ink{painted.grey, painted.tint}, gains);
    painted.grey = shone.grey;
    painted.tint = shone.tint;
  };
  for (StripeMark& stripe : stripes) dye(stripe);
  for (Decal& decal : decals) dye(decal);
  for (BodyPart& solid : solids) dye(solid);
  if (field) field->ink = lit(field->ink, gains);
}

}  // namespace vigia::sim
