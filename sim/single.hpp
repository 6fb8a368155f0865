#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace vigia::sim {

/// In single precision, row by row, for loops over pixels.
inline std::array<float, 9> single(const Eigen::Matrix3d& m) {
  std::array<float, 9> out{};
  for (int i = 0; i < 9; ++i)
    out[static_cast<std::size_t>(i)] = static_cast<float>(m(i / 3, i % 3));
  return out;
}

inline std::array<float, 3> single(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace vigia::sim
