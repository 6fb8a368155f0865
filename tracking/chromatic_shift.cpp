#include "chromatic_shift.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace vigia::tracking {
namespace {

constexpr int kRedChannel = 0;
constexpr int kBlueChannel = 2;

/// ∂(offset)/∂(shift): @p red and @p blue times the shifts of the two.
Eigen::Matrix<double, 2, 4> lever(double red, double blue) {
  Eigen::Matrix<double, 2, 4> J;
  J << red, 0.0, blue, 0.0, 0.0, red, 0.0, blue;
  return J;
}

/// A channel lies off the dot's centre by its own shift less that of the mixture.
Eigen::Matrix<double, 2, 4> lever_of(int channel, const Eigen::Array3d& share) {
  return lever((channel == kRedChannel ? 1.0 : 0.0) - share[kRedChannel],
               (channel == kBlueChannel ? 1.0 : 0.0) - share[kBlueChannel]);
}

}  // namespace

Eigen::Vector2d ChromaticShift::of_centre(const Eigen::Array3d& share) const {
  return lever(share[kRedChannel], share[kBlueChannel]) * shift;
}

Eigen::Matrix2d ChromaticShift::covariance_of(const Eigen::Array3d& share) const {
  const auto J = lever(share[kRedChannel], share[kBlueChannel]);
  return J * covariance * J.transpose();
}

Eigen::Vector2d ChromaticShift::of_channel(int channel, const Eigen::Array3d& share) const {
  return lever_of(channel, share) * shift;
}

ChromaticShift estimate_shift(const std::vector<DotPulls>& dots, const ChromaticShift& prior) {
  Eigen::Matrix4d information = prior.covariance.llt().solve(Eigen::Matrix4d::Identity());
  Eigen::Vector4d right = information * prior.shift;
  for (const DotPulls& dot : dots)
    for (int c = 0; c < 3; ++c) {
      const auto& channel = dot.channels[static_cast<std::size_t>(c)];
      const auto J = lever_of(c, dot.share);
      information += J.transpose() * channel.information * J;
      right += J.transpose() * channel.pull;
    }
  ChromaticShift out;
  const Eigen::LLT<Eigen::Matrix4d> factors(information);
  out.shift = factors.solve(right);
  out.covariance = factors.solve(Eigen::Matrix4d::Identity());
  return out;
}

ChromaticShift shrunk(const ChromaticShift& estimate) {
  const double squares = estimate.shift.dot(estimate.covariance.llt().solve(estimate.shift));
  constexpr double kSpare = 2.0;  // four components less two
  ChromaticShift out = estimate;
  out.shift *= std::max(0.0, 1.0 - kSpare / std::max(squares, 1e-9));
  return out;
}

}  // namespace vigia::tracking
