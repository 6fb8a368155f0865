#include "limb_grid.hpp"

#include "tile_grid.hpp"

#include <algorithm>

namespace vigia::sim {
namespace {

int cells_in(int pixels, int side) {
  return (pixels + side - 1) / side;
}

}  // namespace

LimbGrid::LimbGrid(const Eigen::Isometry3d& wMc, const CameraModel& model)
    : wMc_(wMc),
      model_(&model),
      tile_columns_(cells_in(image_width(model), kTile)),
      block_columns_(cells_in(image_width(model), kBlock)) {
  const int tile_rows = cells_in(image_height(model), kTile);
  if (is_perspective(model)) {
    of_rows_.resize(static_cast<std::size_t>(tile_rows));
    return;
  }
  tiles_.resize(static_cast<std::size_t>(tile_rows) * static_cast<std::size_t>(tile_columns_));
  blocks_.resize(static_cast<std::size_t>(cells_in(image_height(model), kBlock)) *
                 static_cast<std::size_t>(block_columns_));
}

void LimbGrid::add(const std::vector<BodyPart>& parts) {
  for (const BodyPart& part : parts) {
    const BodyPartView view(part, wMc_, *model_);
    if (view.box().empty()) continue;
    const auto id = static_cast<ViewId>(limbs_.size());
    every_.push_back(id);
    limbs_.push_back(view);
    if (of_rows_.empty()) continue;
    for (int row = view.box().v / kTile; row <= (view.box().bottom() - 1) / kTile; ++row)
      of_rows_[static_cast<std::size_t>(row)].push_back(id);
  }
}

const std::vector<ViewId>& LimbGrid::near(int u, int v) {
  if (!of_rows_.empty()) return of_rows_[static_cast<std::size_t>(v / kTile)];
  const int at_tile = v / kTile * tile_columns_ + u / kTile;
  Cell& tile = tiles_[static_cast<std::size_t>(at_tile)];
  if (tile.known) return tile.limbs;
  const int at_block = v / kBlock * block_columns_ + u / kBlock;
  Cell& block = blocks_[static_cast<std::size_t>(at_block)];
  return filled(tile, u, v, kTile, filled(block, u, v, kBlock, every_));
}

const std::vector<ViewId>& LimbGrid::filled(Cell& cell, int u, int v, int side,
                                            const std::vector<ViewId>& among) const {
  if (cell.known) return cell.limbs;
  cell.known = true;
  if (among.empty()) return cell.limbs;
  const int left = u / side * side;
  const int top = v / side * side;
  const RayBox box = ray_box(*model_, left, left + side - 1, top, top + side - 1);
  std::copy_if(among.begin(), among.end(), std::back_inserter(cell.limbs),
               [&](ViewId id) { return limbs_[id].may_meet(box); });
  return cell.limbs;
}

}  // namespace vigia::sim
