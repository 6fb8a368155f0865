#include "tile_grid.hpp"

#include "disc_coverage.hpp"

#include <algorithm>
#include <numeric>

namespace vigia::sim {
namespace {

using imaging::Window;

constexpr int kFewTiles = 3;  // so many are found faster without a look at their row

int tiles_in(int pixels) {
  return (pixels + kTile - 1) / kTile;
}

int blocks_in(int pixels) {
  return (pixels + kBlock - 1) / kBlock;
}

}  // namespace

TileGrid::TileGrid(const CameraModel& model, double blur_px)
    : model_(&model),
      blur_px_(blur_px),
      columns_(tiles_in(image_width(model))),
      tiles_(static_cast<std::size_t>(columns_) *
             static_cast<std::size_t>(tiles_in(image_height(model)))),
      blocks_(is_perspective(model)
                  ? 0
                  : static_cast<std::size_t>(blocks_in(image_width(model))) *
                        static_cast<std::size_t>(blocks_in(image_height(model)))) {}

const std::vector<ViewId>& TileGrid::every(const std::vector<SurfaceView>& views) {
  if (every_.size() != views.size()) {
    every_.resize(views.size());
    std::iota(every_.begin(), every_.end(), ViewId{0});
  }
  return every_;
}

const std::vector<ViewId>& TileGrid::seen_in_block(int u, int v,
                                                   const std::vector<SurfaceView>& views) {
  const int at = v / kBlock * blocks_in(image_width(*model_)) + u / kBlock;
  Block& block = blocks_[static_cast<std::size_t>(at)];
  if (!block.known) {
    const int left = u / kBlock * kBlock;
    const int top = v / kBlock * kBlock;
    bool pure = false;
    visible_in(views, every(views),
               ray_box(*model_, left, left + kBlock - 1, top, top + kBlock - 1), block.views, pure);
    block.known = true;
  }
  return block.views;
}

const Tile& TileGrid::tile_of(int u, int v, const std::vector<SurfaceView>& views,
                              const std::vector<StripeView>& stripes) {
  const int at = v / kTile * columns_ + u / kTile;
  Tile& tile = tiles_[static_cast<std::size_t>(at)];
  if (!tile.known)
    compute(tile, u / kTile * kTile, v / kTile * kTile, seen_in_block(u, v, views), views, stripes);
  return tile;
}

const std::vector<const Tile*>& TileGrid::row(int u, int u_end, int tile_v,
                                              const std::vector<SurfaceView>& views,
                                              const std::vector<StripeView>& stripes) {
  const int first = u / kTile;
  const int last = (u_end - 1) / kTile;
  const int row_first = tile_v / kTile * columns_ + first;
  const int count = last - first + 1;
  if (row_first == row_first_ && row_.size() == static_cast<std::size_t>(count)) return row_;
  row_first_ = row_first;
  spans_.clear();
  const std::vector<ViewId>* among = nullptr;
  row_.clear();
  for (int column = first; column <= last; ++column) {
    Tile& tile = tiles_[static_cast<std::size_t>(row_first + column - first)];
    if (!tile.known) {
      if (among == nullptr) {
        among = &every(views);
        if (is_perspective(*model_) && last - first >= kFewTiles) {
          bool pure = false;
          visible_in(
              views, every_,
              ray_box(*model_, first * kTile, (last + 1) * kTile, tile_v, tile_v + kTile - 1),
              near_row_, pure);
          among = &near_row_;
        }
      }
      compute(tile, column * kTile, tile_v, *among, views, stripes);
    }
    row_.push_back(&tile);
  }
  return row_;
}

const std::vector<TileSpan>& TileGrid::spans(int u, int u_end, int tile_v,
                                             const std::vector<SurfaceView>& views,
                                             const std::vector<StripeView>& stripes) {
  row(u, u_end, tile_v, views, stripes);
  if (!spans_.empty()) return spans_;
  int tile_u = u / kTile * kTile;
  for (const Tile* tile : row_) {
    if (spans_.empty() || !same_views(*spans_.back().tile, *tile))
      spans_.push_back({tile, tile_u, tile_u});
    tile_u += kTile;
    spans_.back().u_end = tile_u;
  }
  return spans_;
}

void TileGrid::compute(Tile& tile, int u, int v, const std::vector<ViewId>& among,
                       const std::vector<SurfaceView>& views,
                       const std::vector<StripeView>& stripes) {
  visible_in(views, among, ray_box(*model_, u, u + kTile - 1, v, v + kTile - 1), visible_,
             tile.pure);
  tile.first_view = view_pool_.size();
  tile.view_count = visible_.size();
  view_pool_.insert(view_pool_.end(), visible_.begin(), visible_.end());
  if (!stripes.empty()) paint_stripes(tile, u, v, stripes);
  tile.known = true;
}

void TileGrid::paint_stripes(Tile& tile, int u, int v, const std::vector<StripeView>& stripes) {
  const int margin = blur_px_ > 0.0 ? blur_margin(blur_px_) : 0;
  const Window window{u - margin, v - margin, kTile + 2 * margin, kTile + 2 * margin};
  // The rays of the window's outermost corners, too.
  const RayBox box = ray_box(*model_, window.u - 1, window.right(), window.v - 1, window.bottom());
  std::vector<Eigen::Vector3d> corners;
  tile.first_patch = patch_pool_.size();
  for (const StripeView& stripe : stripes) {
    if (!stripe.touches(box)) continue;
    if (corners.empty()) corners = corner_rays(*model_, window);
    std::vector<float> share = stripe.coverage(corners, window);
    if (std::all_of(share.begin(), share.end(), [](float s) { return s == 0.0F; })) continue;
    blur(share, window, blur_px_);
    StripePatch patch{&stripe, {}};
    for (int row = margin; row < margin + kTile; ++row) {
      const auto begin = share.begin() + row * window.width + margin;
      patch.share.insert(patch.share.end(), begin, begin + kTile);
    }
    patch_pool_.push_back(std::move(patch));
  }
  tile.patch_count = patch_pool_.size() - tile.first_patch;
}

bool TileGrid::same_views(const Tile& a, const Tile& b) const {
  return a.pure == b.pure && a.view_count == b.view_count &&
         std::equal(views_of(a), views_of(a) + a.view_count, views_of(b));
}

}  // namespace vigia::sim
