#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace vigia::tracking {

/// What a dot's pixels say of the shift of one channel against where the dot was fitted: the
/// information (px⁻²) and its product with the shift (px⁻¹).
struct ChannelPull {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d pull = Eigen::Vector2d::Zero();
};

/// A dot's pulls in red, green and blue, and the shares with which the channels make its centre.
struct DotPulls {
  std::array<ChannelPull, 3> channels;
  Eigen::Array3d share = Eigen::Array3d::Constant(1.0 / 3.0);
};

/// By how much a lens moves red and blue against green about one place of the image (px), with the
/// covariance of (red u, red v, blue u, blue v). Before anything is seen, a few tenths of a pixel.
struct ChromaticShift {
  Eigen::Vector4d shift = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity() * 0.04;

  /// Of a dot's fitted centre against where green has it.
  Eigen::Vector2d of_centre(const Eigen::Array3d& share) const;
  Eigen::Matrix2d covariance_of(const Eigen::Array3d& share) const;
  /// Of one channel (red, green, blue) against a centre that the channels make by their shares.
  Eigen::Vector2d of_channel(int channel, const Eigen::Array3d& share) const;
};

/// The shift common to @p dots, by least squares on top of @p prior.
ChromaticShift estimate_shift(const std::vector<DotPulls>& dots, const ChromaticShift& prior);

/// The estimate drawn towards no shift at all, as lenses mostly have: James and Stein's, positive
/// part, whose mean square against the covariance is below the estimate's own for every shift. The
/// covariance stays, as a bound.
ChromaticShift shrunk(const ChromaticShift& estimate);

}  // namespace vigia::tracking
