#pragma once

#include "body_view.hpp"
#include "surface.hpp"

#include <vector>

namespace vigia::sim {

/// The limbs that an exposure may see, and where: by rows of tiles of a perspective picture, by
/// tiles of any other. A tile's are found when a pixel of it is asked for first.
class LimbGrid {
 public:
  LimbGrid(const Eigen::Isometry3d& wMc, const CameraModel& model);

  void add(const std::vector<BodyPart>& parts);
  bool empty() const { return limbs_.empty(); }
  const BodyPartView& operator[](std::size_t id) const { return limbs_[id]; }
  /// Those that a pixel of the tile with @p u, @p v may show, in the order in which they came.
  const std::vector<ViewId>& near(int u, int v);

 private:
  struct Cell {
    bool known = false;
    std::vector<ViewId> limbs;
  };
  const std::vector<ViewId>& filled(Cell& cell, int u, int v, int side,
                                    const std::vector<ViewId>& among) const;

  Eigen::Isometry3d wMc_;
  const CameraModel* model_;
  int tile_columns_;
  int block_columns_;
  std::vector<BodyPartView> limbs_;
  std::vector<ViewId> every_;
  std::vector<std::vector<ViewId>> of_rows_;  ///< of a perspective picture
  std::vector<Cell> blocks_;                  ///< of any other
  std::vector<Cell> tiles_;
};

}  // namespace vigia::sim
