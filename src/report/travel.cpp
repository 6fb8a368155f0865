#include "travel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace vigia::report {

std::vector<double> travelled_m(const std::vector<Pose2>& poses) {
  std::vector<double> travelled;
  travelled.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    travelled.push_back(
        i == 0 ? 0.0 : travelled.back() + (poses[i].position() - poses[i - 1].position()).norm());
  return travelled;
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
