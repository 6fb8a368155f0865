#include "vigia/sim/ceiling_truth.hpp"

#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

/// Random numbers of one cell, cheap to begin.
class CellRandom {
 public:
  CellRandom(std::uint64_t seed, const CeilingCell& cell)
      : state_(derive_seed(derive_seed(seed, static_cast<std::uint64_t>(cell.i)),
                           static_cast<std::uint64_t>(cell.j))) {}

  /// In (0, 1).
  double unit() {
    state_ = derive_seed(state_, std::uint64_t{1});
    return (static_cast<double>(state_ >> 11) + 0.5) * 0x1.0p-53;
  }
  /// Box and Muller 1958.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(unit()));
    return radius * std::cos(2.0 * kPi * unit());
  }

 private:
  std::uint64_t state_;
};

}  // namespace

std::optional<Pose2> true_patch(const CeilingTruth& truth, const CeilingCell& cell) {
  if (!has_patch(truth.grid, cell)) return std::nullopt;
  CellRandom random(truth.seed, cell);
  if (random.unit() < truth.missing) return std::nullopt;
  const Eigen::Vector2d centre = cell_centre(truth.grid, cell);
  const double dx = truth.grid.placement_m * random.normal();
  const double dy = truth.grid.placement_m * random.normal();
  return Pose2{centre.x() + dx, centre.y() + dy, truth.grid.placement_turn * random.normal()};
}

std::optional<Pose2> spurious_patch(const CeilingTruth& truth, const CeilingCell& cell) {
  CellRandom random(derive_seed(truth.seed, "spurious"), cell);
  if (random.unit() >= truth.spurious) return std::nullopt;
  const Eigen::Vector2d centre = cell_centre(truth.grid, cell);
  const double dx = truth.grid.pitch_m * (random.unit() - 0.5);
  const double dy = truth.grid.pitch_m * (random.unit() - 0.5);
  return Pose2{centre.x() + dx, centre.y() + dy, kPi * (2.0 * random.unit() - 1.0)};
}

}  // namespace vigia::sim
