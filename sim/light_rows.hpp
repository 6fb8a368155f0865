#pragma once

#include "rays.hpp"

#include <array>

#include <Eigen/Geometry>

#include "vigia/sim/light_field.hpp"

namespace vigia::sim {

/// The light of one instant as a camera sees it.
class LightRows {
 public:
  LightRows(const LightNow& light, const Eigen::Isometry3d& cMw);

  /// Multiplies grey[i], the light that comes from depth 1/inverse_depth[i] on the ray,
  /// by the gain there.
  void apply(const Rays& rays, const float* inverse_depth, int count, float* grey) const;

 private:
  struct Constants {
    std::array<float, 4> x, y, z, square, strength;  ///< of the lamps, in units of the width
    float ambient;
    float per_width;
  };
  template <bool kPerspective>
  static void apply_row(const Constants& constants, const Rays& rays, const float* inverse_depth,
                        int count, float* grey);
  static void apply_perspective(const Constants& constants, const Rays& rays,
                                const float* inverse_depth, int count, float* grey);
  static void apply_any(const Constants& constants, const Rays& rays, const float* inverse_depth,
                        int count, float* grey);

  Constants constants_{};
};

}  // namespace vigia::sim
