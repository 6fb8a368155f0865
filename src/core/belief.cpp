#include "vigia/core/belief.hpp"

#include <cmath>

namespace vigia {

std::string_view to_string(BeliefStatus status) {
  switch (status) {
    case BeliefStatus::tracking:
      return "tracking";
    case BeliefStatus::ambiguous:
      return "ambiguous";
    case BeliefStatus::lost:
      return "lost";
  }
  return "";
}

double Belief::position_sigma() const {
  const double mean = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(mean + std::hypot(half, covariance(0, 1)));
}

Prior anywhere() {
  const Eigen::Vector3d sigma(100.0, 100.0, kPi);
  return {{}, sigma.cwiseAbs2().asDiagonal()};
}

}  // namespace vigia
