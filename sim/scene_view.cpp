#include "scene_view.hpp"

#include "ceiling_paint.hpp"
#include "simd.hpp"

#include <algorithm>

namespace vigia::sim {
namespace {

using imaging::Window;

constexpr ViewId kFirstLimb = 0x8000;  ///< the winner of a pixel that shows the first limb
constexpr ViewId kNothing = 0xffff;    ///< of one that shows nothing
constexpr std::array<float, 3> kUntinted{1.0F, 1.0F, 1.0F};

VIGIA_PIXEL_LOOP
void mix_in(const float* __restrict share, float grey, int count, float* __restrict row) {
  for (int i = 0; i < count; ++i) row[i] += share[i] * (grey - row[i]);
}

VIGIA_PIXEL_LOOP
void keep_where(const ViewId* __restrict winner, ViewId id, int count, float* __restrict share) {
  for (int i = 0; i < count; ++i) share[i] = winner[i] == id ? share[i] : 0.0F;
}

VIGIA_PIXEL_LOOP
void take_where(const ViewId* __restrict winner, ViewId id, const float* __restrict grey, int count,
                float* __restrict row) {
  for (int i = 0; i < count; ++i) row[i] = winner[i] == id ? grey[i] : row[i];
}

}  // namespace

SceneView::SceneView(const SceneContent& content, const Exposure::Instant& instant,
                     const std::optional<LightNow>& light, const CameraModel& model,
                     const ImagingParams& params)
    : content_(content),
      wMc_(instant.wMc),
      model_(model),
      blur_px_(params.blur_px),
      tiles_(model_, params.blur_px) {
  const Eigen::Isometry3d cMw = wMc_.inverse(Eigen::Isometry);
  find_surfaces(cMw);
  find_marks(cMw);
  if (light) light_.emplace(*light, cMw);
  find_limbs(content_.solids);
  for (const Person& person : instant.people) find_limbs(body_parts(person));
  if (content_.field && view_of_surface_[content_.field->carpet] >= 0 && wMc_.translation().z() > 0)
    field_.emplace(content_.field->paint, cMw, model_, params.blur_px);
}

PixelRow SceneView::row_of(int count) const {
  PixelRow row(count, is_perspective(model_));
  if (field_) row.paint.resize(static_cast<std::size_t>(count));
  return row;
}

void SceneView::find_limbs(const std::vector<BodyPart>& parts) {
  const int rows = (image_height(model_) + kTile - 1) / kTile;
  limbs_of_rows_.resize(static_cast<std::size_t>(rows));
  for (const BodyPart& part : parts) {
    const BodyPartView view(part, wMc_, model_);
    if (view.box().empty()) continue;
    for (int row = view.box().v / kTile; row <= (view.box().bottom() - 1) / kTile; ++row)
      limbs_of_rows_[static_cast<std::size_t>(row)].push_back(limbs_.size());
    limbs_.push_back(view);
  }
}

void SceneView::find_surfaces(const Eigen::Isometry3d& cMw) {
  const RayBox whole = ray_box(model_, 0, image_width(model_) - 1, 0, image_height(model_) - 1);
  std::vector<SurfaceView> all;
  std::vector<ViewId> every;
  all.reserve(content_.surfaces.size());
  every.reserve(content_.surfaces.size());
  for (std::size_t i = 0; i < content_.surfaces.size(); ++i) {
    SurfaceView view;
    if (!make_view(content_.surfaces[i], cMw, resolution_px(model_), view)) continue;
    view.index = i;
    every.push_back(static_cast<ViewId>(all.size()));
    all.push_back(view);
  }
  std::vector<ViewId> seen;
  bool pure = false;
  if (is_perspective(model_))
    visible_in(all, every, whole, seen, pure);
  else
    seen = every;
  view_of_surface_.assign(content_.surfaces.size(), -1);
  surfaces_.reserve(seen.size());
  for (const ViewId id : seen) {
    view_of_surface_[all[id].index] = static_cast<int>(surfaces_.size());
    surfaces_.push_back(all[id]);
  }
}

void SceneView::find_stripes(const std::vector<StripeMark>& marks, const Eigen::Isometry3d& cMw) {
  for (const StripeMark& mark : marks) {
    if (view_of_surface_[mark.surface] < 0) continue;
    const StripeView view(mark, cMw);
    if (view.faces_camera()) stripes_.push_back(view);
  }
}

void SceneView::find_marks(const Eigen::Isometry3d& cMw) {
  find_stripes(content_.stripes, cMw);
  if (content_.ceiling && view_of_surface_[content_.ceiling->surface] >= 0) {
    ceiling_marks_ = ceiling_marks(content_.ceiling->truth, content_.ceiling->height_m,
                                   content_.ceiling->surface, wMc_, model_);
    find_stripes(ceiling_marks_, cMw);
  }
  for (const Decal& decal : content_.decals) {
    if (view_of_surface_[decal.surface] < 0) continue;
    DecalView view(decal, cMw, model_, blur_px_);
    if (!view.box().empty()) decals_.push_back(std::move(view));
  }
}

void SceneView::see(int u, int v, int count, PixelRow& row) {
  see_surfaces(u, v, count, row);
  see_solids(u, v, count, row);
  see_field(u, v, count, row);
}

void SceneView::see_surfaces(int u, int v, int count, PixelRow& row) {
  row_rays(model_, u, v, count, row.x.data(), row.y.data(), row.z.data());
  if (u / kTile == (u + count - 1) / kTile) {
    see_tile(*tiles_.row(u, u + count, v / kTile * kTile, surfaces_, stripes_).front(), 0, count,
             row);
    return;
  }
  for (const TileSpan& span : tiles_.spans(u, u + count, v / kTile * kTile, surfaces_, stripes_)) {
    const int from = std::max(span.u, u) - u;
    const int to = std::min(span.u_end, u + count) - u;
    see_tile(*span.tile, from, to - from, row);
  }
}

void SceneView::see_tile(const Tile& tile, int first, int length, PixelRow& row) {
  if (tile.pure)
    see_one(*tiles_.views_of(tile), first, length, row);
  else
    see_nearest(tile, first, length, row);
}

void SceneView::see_one(ViewId id, int first, int length, PixelRow& row) {
  const Rays rays = row.rays().from(first);
  std::fill_n(row.winner.data() + first, length, id);
  shade(surfaces_[id], content_.tile.data(), rays, length, row.grey.data() + first);
  if (light_ || !limbs_.empty())
    evaluate(surfaces_[id].inverse_depth, rays, length, row.depth.data() + first);
}

void SceneView::see_nearest(const Tile& tile, int first, int length, PixelRow& row) {
  ViewId* winner = row.winner.data() + first;
  std::fill_n(winner, length, kNothing);
  std::fill_n(row.depth.data() + first, length, 0.0F);
  std::fill_n(row.grey.data() + first, length, 0.0F);
  const ViewId* views = tiles_.views_of(tile);
  for (const ViewId* id = views; id != views + tile.view_count; ++id)
    take_nearest(surfaces_[*id], *id, row.rays().from(first), length, row.depth.data() + first,
                 winner);
  for (const ViewId* id = views; id != views + tile.view_count; ++id) {
    ViewId* begin = std::find(winner, winner + length, *id);
    if (begin == winner + length) continue;
    ViewId* end = winner + length;
    while (*(end - 1) != *id) --end;
    const auto from = begin - winner + first;
    const int n = static_cast<int>(end - begin);
    shade(surfaces_[*id], content_.tile.data(), row.rays().from(from), n, row.other.data() + from);
    take_where(begin, *id, row.other.data() + from, n, row.grey.data() + from);
  }
}

/// Limbs that stand before what is painted already, and hide what hangs on it.
void SceneView::see_solids(int u, int v, int count, PixelRow& row) const {
  for (const std::size_t id : limbs_of_rows_[static_cast<std::size_t>(v / kTile)]) {
    const BodyPartView& limb = limbs_[id];
    const Window& box = limb.box();
    const int from = std::max(u, box.u);
    const int n = std::min(u + count, box.right()) - from;
    if (v < box.v || v >= box.bottom() || n <= 0) continue;
    const auto at = static_cast<std::size_t>(from - u);
    std::fill_n(row.hit.data() + at, n, static_cast<unsigned char>(0));
    limb.paint(row.rays().from(from - u), n, row.depth.data() + at, row.grey.data() + at,
               row.hit.data() + at);
    for (std::size_t i = at; i < at + static_cast<std::size_t>(n); ++i)
      if (row.hit[i] != 0) row.winner[i] = static_cast<ViewId>(kFirstLimb + id);
  }
}

void SceneView::see_field(int u, int v, int count, PixelRow& row) const {
  if (!field_) return;
  const int carpet = view_of_surface_[content_.field->carpet];
  field_->coverage(u, v, count, row.rays(), row.winner.data(), static_cast<ViewId>(carpet),
                   row.paint.data());
}

void SceneView::expose(int u, int v, int count, PixelRow& row, int channel, float* levels) {
  tint(row, count, channel, levels);
  paint_stripes(u, v, count, row, channel, levels);
  paint_field(count, row, channel, levels);
  paint_decals(u, v, count, row, channel, levels);
  shine(row, count, levels);
}

void SceneView::tint(const PixelRow& row, int count, int channel, float* levels) const {
  if (channel == kGrey) {
    if (levels != row.grey.data()) std::copy_n(row.grey.data(), count, levels);
    return;
  }
  for (int i = 0; i < count;) {
    const ViewId winner = row.winner[static_cast<std::size_t>(i)];
    const float gain = tint_of(winner)[static_cast<std::size_t>(channel)];
    for (; i < count && row.winner[static_cast<std::size_t>(i)] == winner; ++i)
      levels[i] = row.grey[static_cast<std::size_t>(i)] * gain;
  }
}

const std::array<float, 3>& SceneView::tint_of(ViewId winner) const {
  if (winner < surfaces_.size()) return surfaces_[winner].material->tint;
  return winner == kNothing ? kUntinted : limbs_[winner - kFirstLimb].tint();
}

void SceneView::paint_field(int count, PixelRow& row, int channel, float* levels) const {
  if (!field_) return;
  const Ink& ink = content_.field->ink;
  const float of_channel = channel == kGrey ? 1.0F : ink.tint[static_cast<std::size_t>(channel)];
  mix_in(row.paint.data(), ink.grey * of_channel, count, levels);
}

void SceneView::paint_stripes(int u, int v, int count, PixelRow& row, int channel, float* levels) {
  if (stripes_.empty()) return;
  int tile_u = u / kTile * kTile;
  for (const Tile* tile : tiles_.row(u, u + count, v / kTile * kTile, surfaces_, stripes_)) {
    const int from = std::max(u, tile_u);
    const int n = std::min(u + count, tile_u + kTile) - from;
    for (std::size_t i = 0; i < tile->patch_count; ++i) {
      const StripePatch& patch = tiles_.patches_of(*tile)[i];
      std::copy_n(patch.share.data() + (v % kTile) * kTile + (from - tile_u), n,
                  row.other.data() + (from - u));
      const StripeMark& mark = patch.stripe->mark();
      mix(mark.surface, mark.tint, mark.grey, channel, from - u, n, row, levels);
    }
    tile_u += kTile;
  }
}

void SceneView::paint_decals(int u, int v, int count, PixelRow& row, int channel, float* levels) {
  for (DecalView& view : decals_) {
    const Window& box = view.box();
    if (v < box.v || v >= box.bottom()) continue;
    const int from = std::max(u, box.u);
    const int n = std::min(u + count, box.right()) - from;
    if (n <= 0) continue;
    const int at = from - u;
    view.coverage(from, v, n, row.rays().from(at), row.other.data() + at);
    const Decal& decal = view.decal();
    mix(decal.surface, decal.tint, decal.grey, channel, at, n, row, levels);
  }
}

/// Mixes paint of the share row.other[at …] into the levels where its surface is seen.
void SceneView::mix(std::size_t surface, const std::array<float, 3>& tint, float grey, int channel,
                    int at, int count, PixelRow& row, float* levels) const {
  keep_where(row.winner.data() + at, static_cast<ViewId>(view_of_surface_[surface]), count,
             row.other.data() + at);
  const float of_channel = channel == kGrey ? 1.0F : tint[static_cast<std::size_t>(channel)];
  mix_in(row.other.data() + at, grey * of_channel, count, levels + at);
}

void SceneView::shine(const PixelRow& row, int count, float* levels) const {
  if (content_.light != 1.0F)
    for (int i = 0; i < count; ++i) levels[i] *= content_.light;
  if (light_) light_->apply(row.rays(), row.depth.data(), count, levels);
}

}  // namespace vigia::sim
