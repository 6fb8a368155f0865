#include "tile_batches.hpp"

#include "tile_grid.hpp"

#include <algorithm>

namespace vigia::sim {

TileBatches::TileBatches(const imaging::Window& window, std::ptrdiff_t stride, int image_width)
    : columns_((image_width + kTile - 1) / kTile) {
  const int tiles_across = (window.right() - 1) / kTile - window.u / kTile + 1;
  pieces_.reserve(static_cast<std::size_t>(window.height) * static_cast<std::size_t>(tiles_across));
  for (int row = 0; row < window.height; ++row)
    add({window.v + row, window.u, window.right()}, row * stride);
  sort_by_tile();
}

TileBatches::TileBatches(const std::vector<imaging::Run>& runs, int image_width)
    : columns_((image_width + kTile - 1) / kTile) {
  pieces_.reserve(runs.size() + runs.size() / 4);
  std::ptrdiff_t out = 0;
  for (const imaging::Run& run : runs) {
    add(run, out);
    out += run.width();
  }
  sort_by_tile();
}

void TileBatches::add(const imaging::Run& run, std::ptrdiff_t out) {
  for (int u = run.u_begin; u < run.u_end;) {
    const int end = std::min(run.u_end, (u / kTile + 1) * kTile);
    pieces_.push_back({u, run.v, end - u, out});
    out += end - u;
    u = end;
  }
}

/// Counts the pieces of each tile and puts them there, in the order in which they were asked for.
void TileBatches::sort_by_tile() {
  const auto tile_of = [this](const Piece& piece) {
    const int tile = piece.v / kTile * columns_ + piece.u / kTile;
    return static_cast<std::size_t>(tile);
  };
  std::vector<std::size_t> next;
  for (const Piece& piece : pieces_) {
    const std::size_t tile = tile_of(piece);
    if (tile >= next.size()) next.resize(tile + 1);
    ++next[tile];
  }
  std::size_t sum = 0;
  for (std::size_t& tile : next) {
    const std::size_t count = tile;
    tile = sum;
    sum += count;
    if (count > 0) ends_.push_back(sum);
  }
  std::vector<Piece> sorted(pieces_.size());
  for (const Piece& piece : pieces_) sorted[next[tile_of(piece)]++] = piece;
  pieces_ = std::move(sorted);
}

}  // namespace vigia::sim
