#pragma once

#include <cstddef>

namespace vigia::sim {

/// Neighbouring pixels of one row of the image: columns [u, u + count) of row v.
struct Piece {
  int u = 0;
  int v = 0;
  int count = 0;
  std::ptrdiff_t out = 0;  ///< where who asked for them keeps the first
};

/// Pieces one after another.
struct Pieces {
  const Piece* first = nullptr;
  const Piece* last = nullptr;

  const Piece* begin() const { return first; }
  const Piece* end() const { return last; }
  const Piece& front() const { return *first; }
};

}  // namespace vigia::sim
