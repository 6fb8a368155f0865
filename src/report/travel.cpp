#include "travel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace vigia::report {

std::vector<double> travelled_m(const MapDrive& drive) {
  const auto& truth = drive.truth;
  std::vector<double> travelled;
  travelled.reserve(truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool driven = i > 0 && !std::binary_search(drive.jumps.begin(), drive.jumps.end(), i);
    const double step = driven ? (truth[i].position() - truth[i - 1].position()).norm() : 0.0;
    travelled.push_back(i == 0 ? 0.0 : travelled.back() + step);
  }
  return travelled;
}

CutLine cut_at(const std::vector<Eigen::Vector2d>& points, const std::vector<std::size_t>& jumps) {
  CutLine line;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool jump = i > 0 && std::binary_search(jumps.begin(), jumps.end(), i);
    if (jump) line.jumps.emplace_back(points[i - 1], points[i]);
    if (i == 0 || jump) line.pieces.emplace_back();
    line.pieces.back().push_back(points[i]);
  }
  return line;
}

CutLine cut_where_far(const std::vector<Eigen::Vector2d>& points) {
  constexpr double kFar_m = 0.5;
  std::vector<std::size_t> jumps;
  for (std::size_t i = 1; i < points.size(); ++i)
    if ((points[i] - points[i - 1]).norm() > kFar_m) jumps.push_back(i);
  return cut_at(points, jumps);
}

double position_sigma_m(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d position = covariance.topLeftCorner<2, 2>();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(position, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

std::vector<std::size_t> look_instants(const std::vector<Pose2>& truth,
                                       const std::vector<MapLook>& looks) {
  std::vector<std::size_t> instants;
  std::size_t from = 0;
  for (const MapLook& look : looks) {
    std::size_t nearest = from;
    for (std::size_t i = from; i < truth.size(); ++i)
      if ((truth[i].position() - look.from).norm() < (truth[nearest].position() - look.from).norm())
        nearest = i;
    instants.push_back(nearest);
    from = nearest;
  }
  return instants;
}

}  // namespace vigia::report
