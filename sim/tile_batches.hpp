#pragma once

#include "pixel_piece.hpp"

#include <vector>

#include "vigia/imaging/frame.hpp"

namespace vigia::sim {

/// What is asked for of a picture, tile by tile: pixels of one tile share what they may see.
class TileBatches {
 public:
  /// Of a window, whose rows lie @p stride apart where they are wanted.
  TileBatches(const imaging::Window& window, std::ptrdiff_t stride, int image_width);
  /// Of runs, which are wanted one after another.
  TileBatches(const std::vector<imaging::Run>& runs, int image_width);

  std::size_t size() const { return ends_.size(); }
  /// The pieces of one tile.
  Pieces operator[](std::size_t i) const {
    return {pieces_.data() + (i == 0 ? 0 : ends_[i - 1]), pieces_.data() + ends_[i]};
  }

 private:
  void add(const imaging::Run& run, std::ptrdiff_t out);
  void sort_by_tile();

  int columns_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> ends_;  ///< of each tile's pieces
};

}  // namespace vigia::sim
