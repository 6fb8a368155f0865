#include "vigia/localization/murea.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

/// The cells of one resolution.
struct Resolution {
  double side_m;
  double span;  ///< of headings, rad
};

/// What the votes need to know of a perception.
struct Perception {
  Eigen::Vector2d p_r = Eigen::Vector2d::Zero();
  double range_m = 0.0;
  double tolerance_m = 0.0;
  double votes = 1.0;
  const FieldColour* colour = nullptr;  ///< of a goal or post
  bool post = false;
};

std::vector<Perception> perceptions_of(const FieldScan& scan, const MureaParams& params) {
  const double sigmas = params.tolerance_sigmas;
  std::vector<Perception> all;
  for (const FieldPoint& point : scan.points) {
    const double spread = std::sqrt(0.5 * point.covariance.trace());
    all.push_back({point.p_r, point.p_r.norm(), sigmas * spread, 1.0, nullptr, false});
  }
  const auto add = [&](const std::vector<ColourSighting>& sightings, bool post) {
    for (const ColourSighting& seen : sightings)
      all.push_back({seen.range_m * unit_vector(seen.bearing), seen.range_m,
                     sigmas * std::hypot(seen.range_sigma_m, seen.bearing_sigma * seen.range_m),
                     params.sighting_votes, &seen.colour, post});
  };
  add(scan.goals, false);
  add(scan.posts, true);
  return all;
}

/// Distance from a place in the world to the nearest goal or post of the perception's colour.
double distance_to_sighted(const FieldMap& map, const Perception& seen, const Eigen::Vector2d& p) {
  double nearest = 1e9;
  if (seen.post) {
    for (const CornerPost& post : map.posts)
      if (post.outer == *seen.colour) nearest = std::min(nearest, (post.at - p).norm());
  } else {
    for (const FieldGoal& goal : map.goals)
      if (goal.colour == *seen.colour) nearest = std::min(nearest, (goal.centre() - p).norm());
  }
  return nearest;
}

/// The vote of a perception for a cell: its whole when it agrees with the cell's middle, falling to
/// none where no pose of the cell allows it.
double vote(const FieldModel& model, const FieldDistance& wide, const Perception& seen,
            const Eigen::Vector2d& position, const Eigen::Vector2d& ahead,
            const Resolution& resolution) {
  const Eigen::Vector2d p =
      position + Eigen::Vector2d(ahead.x() * seen.p_r.x() - ahead.y() * seen.p_r.y(),
                                 ahead.y() * seen.p_r.x() + ahead.x() * seen.p_r.y());
  const double cell =
      0.5 * std::sqrt(2.0) * resolution.side_m + 0.5 * resolution.span * seen.range_m;
  const double allowed = seen.tolerance_m + cell;
  double off = 0.0;
  if (seen.colour != nullptr)
    off = distance_to_sighted(model.map(), seen, p);
  else
    off = allowed < model.distance().reach_m() ? model.distance().distance(p) : wide.distance(p);
  return off <= allowed ? seen.votes * (1.0 - off / (allowed + 1e-9)) : 0.0;
}

double votes_for(const FieldModel& model, const FieldDistance& wide,
                 const std::vector<Perception>& seen, const MureaCell& cell,
                 const Resolution& resolution) {
  const Eigen::Vector2d ahead = unit_vector(cell.middle.z());
  double sum = 0.0;
  for (const Perception& perception : seen)
    sum += vote(model, wide, perception, cell.middle.head<2>(), ahead, resolution);
  return sum;
}

/// The first cells: over the field, or over 3σ about the estimate.
std::vector<MureaCell> first_cells(const FieldMap& map, const std::optional<Prior>& estimate,
                                   Resolution& resolution) {
  Eigen::Vector3d half(0.5 * map.length_m + 0.3, 0.5 * map.width_m + 0.3, kPi);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  if (estimate) {
    middle = estimate->pose.vector();
    half = (3.0 * estimate->covariance.diagonal().cwiseSqrt()).cwiseMin(half);
    resolution.side_m = std::min(resolution.side_m, std::max(half.x(), half.y()));
    resolution.span = std::min(resolution.span, half.z());
  }
  const auto count = [](double span, double step) {
    return std::max(1, static_cast<int>(std::ceil(2.0 * span / step - 1e-9)));
  };
  const int nx = count(half.x(), resolution.side_m);
  const int ny = count(half.y(), resolution.side_m);
  const int nt = count(half.z(), resolution.span);
  std::vector<MureaCell> cells;
  for (int k = 0; k < nt; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        cells.push_back({middle + Eigen::Vector3d((i + 0.5 - 0.5 * nx) * resolution.side_m,
                                                  (j + 0.5 - 0.5 * ny) * resolution.side_m,
                                                  (k + 0.5 - 0.5 * nt) * resolution.span),
                         0.0});
  return cells;
}

/// The cells worth refining, the best first.
void select(std::vector<MureaCell>& cells, const MureaParams& params) {
  std::sort(cells.begin(), cells.end(),
            [](const MureaCell& a, const MureaCell& b) { return a.votes > b.votes; });
  const double least = params.keep_share * cells.front().votes;
  std::size_t kept = 0;
  while (kept < cells.size() && kept < static_cast<std::size_t>(params.keep_cells) &&
         cells[kept].votes >= least)
    ++kept;
  cells.resize(kept);
}

std::vector<MureaCell> divide(const std::vector<MureaCell>& cells, const Resolution& finer) {
  std::vector<MureaCell> divided;
  divided.reserve(8 * cells.size());
  for (const MureaCell& cell : cells)
    for (int child = 0; child < 8; ++child)
      divided.push_back({cell.middle + Eigen::Vector3d((child & 1 ? 0.5 : -0.5) * finer.side_m,
                                                       (child & 2 ? 0.5 : -0.5) * finer.side_m,
                                                       (child & 4 ? 0.5 : -0.5) * finer.span),
                         0.0});
  return divided;
}

Eigen::Vector3d off_by(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {a.x() - b.x(), a.y() - b.y(), wrap_angle(a.z() - b.z())};
}

/// Mean and spread of the hill of votes about the best cell.
void conclude(const std::vector<MureaCell>& cells, const Resolution& resolution,
              const MureaParams& params, MureaFix& fix) {
  const MureaCell& best = cells.front();
  const double within_m = std::max(0.25, 3.0 * resolution.side_m);
  const double within_rad = std::max(0.1, 3.0 * resolution.span);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double weights = 0.0;
  for (const MureaCell& cell : cells) {
    const Eigen::Vector3d d = off_by(cell.middle, best.middle);
    if ((d.head<2>().norm() > 0.5 || std::abs(d.z()) > 0.35) && cell.votes > fix.runner_up) {
      fix.runner_up = cell.votes;
      fix.second = Pose2::from_vector(cell.middle);
    }
    if (d.head<2>().norm() > within_m || std::abs(d.z()) > within_rad) continue;
    const double weight = std::exp(params.vote_gain * (cell.votes - best.votes));
    sum += weight * d;
    squares += weight * d * d.transpose();
    weights += weight;
  }
  const Eigen::Vector3d mean = sum / weights;
  fix.found = true;
  fix.votes = best.votes;
  fix.pose = Pose2::from_vector(best.middle + mean);
  const Eigen::Vector3d cell(resolution.side_m, resolution.side_m, resolution.span);
  fix.covariance =
      params.error_share * params.vote_gain * (squares / weights - mean * mean.transpose()) +
      Eigen::Matrix3d((0.01 * cell.cwiseProduct(cell)).asDiagonal());
}

}  // namespace

Murea::Murea(const FieldModel& model, const MureaParams& params)
    : model_(&model), params_(params), wide_(model.map(), 3.0, 0.4) {}

MureaFix Murea::locate(const FieldScan& scan, const std::optional<Prior>& estimate) const {
  MureaFix fix;
  const std::vector<Perception> seen = perceptions_of(scan, params_);
  if (seen.empty()) return fix;
  Resolution resolution{params_.coarse_m, from_deg(params_.coarse_deg)};
  std::vector<MureaCell> cells = first_cells(model_->map(), estimate, resolution);
  for (;;) {
    for (MureaCell& cell : cells) cell.votes = votes_for(*model_, wide_, seen, cell, resolution);
    fix.cells += static_cast<int>(cells.size());
    ++fix.levels;
    select(cells, params_);
    const bool fine = resolution.side_m <= params_.cell_m + 1e-9 &&
                      resolution.span <= from_deg(params_.cell_deg) + 1e-9;
    if (fine || fix.cells + 8 * static_cast<int>(cells.size()) > params_.cell_budget) break;
    resolution.side_m *= 0.5;
    resolution.span *= 0.5;
    cells = divide(cells, resolution);
  }
  if (cells.front().votes <= 0.0) return fix;
  fix.cell_m = resolution.side_m;
  fix.cell_deg = to_deg(resolution.span);
  conclude(cells, resolution, params_, fix);
  return fix;
}

}  // namespace vigia::localization
