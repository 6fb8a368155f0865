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
      limbs_(wMc_, model_),
      tiles_(model_, params.blur_px) {
  const Eigen::Isometry3d cMw = wMc_.inverse(Eigen::Isometry);
  find_surfaces(cMw);
  find_marks(cMw);
  if (light) light_.emplace(*light, cMw);
  limbs_.add(content_.solids);
  for (const Person& person : instant.people) limbs_.add(body_parts(person));
  if (content_.field && view_of_surface_[content_.field->carpet] >= 0 && wMc_.translation().z() > 0)
    field_.emplace(content_.field->paint, cMw, model_, params.blur_px);
}

PixelRow SceneView::row_of(int most) const {
  PixelRow row(most, is_perspective(model_));
  if (field_) row.paint.resize(static_cast<std::size_t>(most));
  return row;
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

void SceneView::expect(const Window& window) {
  for (DecalView& view : decals_) view.expect(window);
}

void SceneView::see(PixelRow& row) {
  see_surfaces(row);
  see_solids(row);
  see_field(row);
}

void SceneView::see_surfaces(PixelRow& row) {
  const Piece& first = row.pieces.front();
  if (const auto* mirror = std::get_if<UnifiedOmni>(&model_)) {
    pixel_rays(*mirror, row.u.data(), row.v.data(), row.count, row.x.data(), row.y.data(),
               row.z.data());
    see_tile(tiles_.tile_of(first.u, first.v, surfaces_, stripes_), 0, row.count, row);
    return;
  }
  row_rays(model_, first.u, first.v, first.count, row.x.data(), row.y.data(), row.z.data());
  see_row_of_tiles(first, row);
}

void SceneView::see_row_of_tiles(const Piece& piece, PixelRow& row) {
  const int u = piece.u;
  const int v = piece.v;
  const int count = piece.count;
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
void SceneView::see_solids(PixelRow& row) {
  if (limbs_.empty()) return;
  const Piece& first = row.pieces.front();
  for (const ViewId id : limbs_.near(first.u, first.v)) {
    const BodyPartView& limb = limbs_[id];
    int from = 0;
    int end = row.count;
    if (is_perspective(model_)) {
      const Window& box = limb.box();
      if (first.v < box.v || first.v >= box.bottom()) continue;
      from = std::max(first.u, box.u) - first.u;
      end = std::min(first.u + first.count, box.right()) - first.u;
    }
    if (end <= from) continue;
    const auto at = static_cast<std::size_t>(from);
    std::fill_n(row.hit.data() + at, end - from, static_cast<unsigned char>(0));
    limb.paint(row.rays().from(from), end - from, row.depth.data() + at, row.grey.data() + at,
               row.hit.data() + at);
    for (std::size_t i = at; i < static_cast<std::size_t>(end); ++i)
      if (row.hit[i] != 0) row.winner[i] = static_cast<ViewId>(kFirstLimb + id);
  }
}

void SceneView::see_field(PixelRow& row) const {
  if (!field_) return;
  const int carpet = view_of_surface_[content_.field->carpet];
  field_->coverage(row, static_cast<ViewId>(carpet));
}

void SceneView::expose(PixelRow& row, int channel, float* levels) {
  tint(row, channel, levels);
  paint_stripes(row, channel, levels);
  paint_field(row, channel, levels);
  paint_decals(row, channel, levels);
  shine(row, levels);
}

void SceneView::tint(const PixelRow& row, int channel, float* levels) const {
  const int count = row.count;
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

void SceneView::paint_field(PixelRow& row, int channel, float* levels) const {
  if (!field_) return;
  const Ink& ink = content_.field->ink;
  const float of_channel = channel == kGrey ? 1.0F : ink.tint[static_cast<std::size_t>(channel)];
  mix_in(row.paint.data(), ink.grey * of_channel, row.count, levels);
}

void SceneView::paint_stripes(PixelRow& row, int channel, float* levels) {
  if (stripes_.empty()) return;
  int at = 0;
  for (const Piece& piece : row.pieces) {
    const int u = piece.u;
    const int v = piece.v;
    int tile_u = u / kTile * kTile;
    for (const Tile* tile :
         tiles_.row(u, u + piece.count, v / kTile * kTile, surfaces_, stripes_)) {
      const int from = std::max(u, tile_u);
      const int n = std::min(u + piece.count, tile_u + kTile) - from;
      for (std::size_t i = 0; i < tile->patch_count; ++i) {
        const StripePatch& patch = tiles_.patches_of(*tile)[i];
        std::copy_n(patch.share.data() + (v % kTile) * kTile + (from - tile_u), n,
                    row.other.data() + at + (from - u));
        const StripeMark& mark = patch.stripe->mark();
        mix(mark.surface, mark.tint, mark.grey, channel, at + from - u, n, row, levels);
      }
      tile_u += kTile;
    }
    at += piece.count;
  }
}

void SceneView::paint_decals(PixelRow& row, int channel, float* levels) {
  for (DecalView& view : decals_) {
    const Window& box = view.box();
    int first = 0;
    for (const Piece& piece : row.pieces) {
      const int from = std::max(piece.u, box.u);
      const int n = std::min(piece.u + piece.count, box.right()) - from;
      const int at = first + from - piece.u;
      first += piece.count;
      if (piece.v < box.v || piece.v >= box.bottom() || n <= 0) continue;
      view.coverage(from, piece.v, n, row.rays().from(at), row.other.data() + at);
      const Decal& decal = view.decal();
      mix(decal.surface, decal.tint, decal.grey, channel, at, n, row, levels);
    }
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

void SceneView::shine(const PixelRow& row, float* levels) const {
  if (content_.light != 1.0F)
    for (int i = 0; i < row.count; ++i) levels[i] *= content_.light;
  if (light_) light_->apply(row.rays(), row.depth.data(), row.count, levels);
}

}  // namespace vigia::sim
