#pragma once

#include "stripe_view.hpp"
#include "surface.hpp"

#include <vector>

#include "vigia/imaging/frame.hpp"

namespace vigia::sim {

inline constexpr int kTile = 16;
inline constexpr int kBlock = 4 * kTile;  ///< what a tile may see is found in a block of them first

/// What one tile of a frame's grid sees: surfaces, and the stripes on them.
struct Tile {
  bool known = false;
  bool pure = false;  ///< one surface covers it
  std::size_t first_view = 0;
  std::size_t view_count = 0;
  std::size_t first_patch = 0;
  std::size_t patch_count = 0;
};

/// Columns [u, u_end) of neighbouring tiles that see the same surfaces, those of @p tile.
struct TileSpan {
  const Tile* tile = nullptr;
  int u = 0;
  int u_end = 0;
};

/// Blurred shares of a stripe in one tile, row by row.
struct StripePatch {
  const StripeView* stripe = nullptr;
  std::vector<float> share;
};

/// The tiles of one exposure. Each is computed when a pixel of it is asked for first; the grid is
/// the frame's, so that a pixel never depends on the window.
class TileGrid {
 public:
  TileGrid() = default;
  TileGrid(const CameraModel& model, double blur_px);

  /// The tiles of row @p tile_v (a multiple of kTile) that hold the columns [u, u_end), from left
  /// to right; their memory stays until the next call.
  const std::vector<const Tile*>& row(int u, int u_end, int tile_v,
                                      const std::vector<SurfaceView>& views,
                                      const std::vector<StripeView>& stripes);
  /// The same tiles, neighbours that see the same surfaces taken together.
  const std::vector<TileSpan>& spans(int u, int u_end, int tile_v,
                                     const std::vector<SurfaceView>& views,
                                     const std::vector<StripeView>& stripes);

  /// The tile of a picture that is not perspective that holds the pixel.
  const Tile& tile_of(int u, int v, const std::vector<SurfaceView>& views,
                      const std::vector<StripeView>& stripes);

  const ViewId* views_of(const Tile& tile) const { return view_pool_.data() + tile.first_view; }
  const StripePatch* patches_of(const Tile& tile) const {
    return patch_pool_.data() + tile.first_patch;
  }

 private:
  bool same_views(const Tile& a, const Tile& b) const;
  void compute(Tile& tile, int u, int v, const std::vector<ViewId>& among,
               const std::vector<SurfaceView>& views, const std::vector<StripeView>& stripes);
  const std::vector<ViewId>& every(const std::vector<SurfaceView>& views);
  const std::vector<ViewId>& seen_in_block(int u, int v, const std::vector<SurfaceView>& views);
  void paint_stripes(Tile& tile, int u, int v, const std::vector<StripeView>& stripes);

  const CameraModel* model_ = nullptr;
  double blur_px_ = 0.0;
  int columns_ = 0;
  std::vector<Tile> tiles_;
  struct Block {
    bool known = false;
    std::vector<ViewId> views;
  };
  std::vector<Block> blocks_;  ///< of a picture that is not perspective
  std::vector<ViewId> view_pool_;
  std::vector<StripePatch> patch_pool_;
  std::vector<const Tile*> row_;  ///< what was asked for last: the next row of pixels asks again
  int row_first_ = -1;            ///< index of its first tile
  std::vector<TileSpan> spans_;   ///< of row_; empty until asked for
  std::vector<ViewId> every_;
  std::vector<ViewId> near_row_;
  std::vector<ViewId> visible_;
};

}  // namespace vigia::sim
