#include "upright_edge.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace vigia::tracking {
namespace {

using Eigen::Vector3d;

constexpr int kEdgeIterations = 25;
constexpr double kEdgeAtRest = 1e-5;
constexpr int kPureFrom_px = 1;  // beside the last pixel of a colour

Vector3d rgb_of(const vpRGBa& pixel) {
  return {static_cast<double>(pixel.R), static_cast<double>(pixel.G), static_cast<double>(pixel.B)};
}

/// A row of the fit: pixels from @p u on, and how far each is from the left colour (0) to the right
/// (1).
struct EdgeRow {
  double v = 0.0;  ///< from the middle of the rows
  int u = 0;
  Eigen::VectorXd share;
};

/// Mean of the pixels of one side that the edge's blur does not reach.
Vector3d side_mean(const ColourWindow& picture, const std::vector<ColourTransition>& group,
                   bool right) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const ColourTransition& row : group) {
    const int run = right ? row.right_run : row.left_run;
    for (int i = std::min(kPureFrom_px, run - 1); i < run; ++i) {
      sum += rgb_of(picture.at(right ? row.right + i : row.left - i, row.v));
      ++count;
    }
  }
  return sum / std::max(1, count);
}

/// What a fit knows of the edge: column in the middle row, lean, log of its blur.
struct EdgeState {
  double u = 0.0;
  double slope = 0.0;
  double log_blur = 0.0;
};

/// Sums of the linearised problem, the levels of each row projected out.
struct EdgeSystem {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double square = 0.0;
  int degrees = 0;
};

/// Adds a row: its two levels are those of least squares (variable projection, Kaufman's form).
void add_row(const EdgeRow& row, const EdgeState& state, EdgeSystem& system) {
  const Eigen::Index n = row.share.size();
  const double blur = std::exp(state.log_blur);
  Eigen::VectorXd step(n);
  Eigen::VectorXd density(n);
  Eigen::VectorXd z(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    z[i] = (row.u + static_cast<double>(i) - state.u - state.slope * row.v) / blur;
    step[i] = 0.5 * std::erfc(-z[i] / std::sqrt(2.0));
    density[i] = std::exp(-0.5 * z[i] * z[i]) / std::sqrt(2.0 * kPi);
  }
  const Eigen::VectorXd centred = step.array() - step.mean();
  const double spread = centred.squaredNorm();
  if (!(spread > 1e-6)) return;
  const auto project = [&](const Eigen::VectorXd& y) {
    const Eigen::VectorXd level = y.array() - y.mean();
    return Eigen::VectorXd(level - centred * (centred.dot(level) / spread));
  };
  const double height = centred.dot(row.share) / spread;
  const Eigen::VectorXd r = project(row.share);
  const Eigen::VectorXd by_u = project(-height / blur * density);  // of the model
  const Eigen::VectorXd by_blur = project(-height * z.cwiseProduct(density));
  Eigen::MatrixXd J(n, 3);
  J << by_u, row.v * by_u, by_blur;
  system.A += J.transpose() * J;
  system.b += J.transpose() * r;
  system.square += r.squaredNorm();
  system.degrees += static_cast<int>(n) - 2;
}

EdgeSystem system_at(const std::vector<EdgeRow>& rows, const EdgeState& state) {
  EdgeSystem system;
  for (const EdgeRow& row : rows) add_row(row, state, system);
  return system;
}

/// What is known beforehand of lean and blur, in units of the residuals' variance.
void add_priors(const GoalCornerParams& params, const EdgeState& state, double variance,
                EdgeSystem& system) {
  const double slope = variance / (params.slope_sigma * params.slope_sigma);
  const double blur = variance / (params.blur_sigma * params.blur_sigma);
  system.A(1, 1) += slope;
  system.b[1] -= slope * state.slope;
  system.A(2, 2) += blur;
  system.b[2] -= blur * (state.log_blur - std::log(params.blur_px));
}

double variance_of(const EdgeSystem& system) {
  constexpr double kRounding = 1.0 / 12.0 / (255.0 * 255.0);
  return std::max(kRounding, system.square / std::max(1, system.degrees - 3));
}

double middle_row(const std::vector<ColourTransition>& group) {
  double sum = 0.0;
  for (const ColourTransition& row : group) sum += row.v;
  return sum / static_cast<double>(group.size());
}

std::vector<EdgeRow> edge_rows(const ColourWindow& picture,
                               const std::vector<ColourTransition>& group, const Vector3d& left,
                               const Vector3d& across) {
  const double v0 = middle_row(group);
  std::vector<EdgeRow> rows;
  for (const ColourTransition& row : group) {
    const int from = row.left - row.left_run + 1;
    const int to = row.right + row.right_run - 1;
    EdgeRow one{row.v - v0, from, Eigen::VectorXd(to - from + 1)};
    for (int u = from; u <= to; ++u)
      one.share[u - from] = across.dot(rgb_of(picture.at(u, row.v)) - left) / across.squaredNorm();
    rows.push_back(std::move(one));
  }
  return rows;
}

}  // namespace

ColourWindow read_colour_window(const imaging::Frame& frame, const imaging::Window& window) {
  ColourWindow read{window, {}};
  read.pixels.resize(static_cast<std::size_t>(window.width) *
                     static_cast<std::size_t>(window.height));
  frame.read_colour(window, read.pixels.data(), window.width);
  return read;
}

std::optional<GoalCornerImage> fit_upright_edge(const ColourWindow& picture,
                                                const std::vector<ColourTransition>& group,
                                                const GoalCornerParams& params) {
  const Vector3d left = side_mean(picture, group, false);
  const Vector3d across = side_mean(picture, group, true) - left;
  const double contrast = across.norm();
  if (contrast < params.min_contrast) return std::nullopt;
  const std::vector<EdgeRow> rows = edge_rows(picture, group, left, across);

  EdgeState state;
  for (const ColourTransition& row : group) state.u += row.middle();
  state.u /= static_cast<double>(group.size());
  state.log_blur = std::log(params.blur_px);
  bool at_rest = false;
  EdgeSystem system;
  for (int i = 0; i < kEdgeIterations && !at_rest; ++i) {
    system = system_at(rows, state);
    add_priors(params, state, variance_of(system), system);
    const Vector3d longest(1.0, 0.2, 0.5);
    const Vector3d step = system.A.ldlt().solve(system.b).cwiseMax(-longest).cwiseMin(longest);
    if (!step.allFinite()) return std::nullopt;
    state.u += step[0];
    state.slope += step[1];
    state.log_blur += step[2];
    at_rest = step.norm() < kEdgeAtRest;
  }
  if (!at_rest) return std::nullopt;

  system = system_at(rows, state);
  const double variance = variance_of(system);
  add_priors(params, state, variance, system);
  const double noise = std::sqrt(variance) * contrast;
  if (noise > std::max(params.max_misfit * contrast, params.max_noise)) return std::nullopt;
  const Eigen::Matrix3d covariance = variance * system.A.inverse();
  GoalCornerImage corner;
  corner.colour = group.front().colour;
  corner.colour_on_right = group.front().colour_on_right;
  corner.u = state.u;
  corner.v = middle_row(group);
  corner.sigma_px = std::sqrt(covariance(0, 0) + params.floor_px * params.floor_px);
  corner.slope = state.slope;
  corner.blur_px = std::exp(state.log_blur);
  corner.contrast = contrast;
  corner.noise = noise;
  corner.first_row = group.front().v;
  corner.rows = static_cast<int>(group.size());
  return corner;
}

}  // namespace vigia::tracking
