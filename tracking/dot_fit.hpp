#pragma once

#include "chromatic_shift.hpp"
#include "colour_block.hpp"
#include "edge_fit.hpp"

#include <Eigen/Core>

namespace vigia::tracking {

/// Levels of red, green and blue, with their standard deviations.
struct ColourLevels {
  Eigen::Array3d dot = Eigen::Array3d::Zero();
  Eigen::Array3d ground = Eigen::Array3d::Zero();
  Eigen::Array3d dot_sigma = Eigen::Array3d::Zero();
  Eigen::Array3d noise = Eigen::Array3d::Ones();  ///< of the pixels about the fitted profile
};

enum class DotStatus { whole, hidden, cut, faint };

struct DotFit {
  DotStatus status = DotStatus::hidden;
  EllipseShape shape;
  Eigen::Matrix2d centre_covariance = Eigen::Matrix2d::Identity();
  ColourLevels levels;
  DotPulls pulls;     ///< of the channels, against the centre
  double blur = 0.8;  ///< px
};

/// The pixels that the fit of a dot reads.
imaging::Window dot_box(const EllipseShape& shape, double blur);

/// Measures one dot of a colour pattern: an ellipse with a blurred edge is fitted to the mixture of
/// the channels weighted by the dot's contrast in each, which has all the information that the
/// three channels have of the outline when their noise is equal and independent. Then the levels
/// of dot and paper are found in each channel by regression on the fitted profile, so that blur
/// does not mix them.
class DotFitter {
 public:
  explicit DotFitter(double min_agreement) : min_agreement_(min_agreement) {}

  /// @p start is the expected outline. Reads only pixels of @p block. Where the dot is new, all its
  /// pixels tell of the channels' shifts, later some.
  DotFit fit(const ColourBlock& block, const EllipseShape& start, double blur);
  /// The same with levels that are known from the last frame.
  DotFit fit(const ColourBlock& block, const EllipseShape& start, double blur,
             const ColourLevels& levels);

 private:
  static void measure(const ColourBlock& block, const imaging::Window& box, int step, DotFit& dot);

  double min_agreement_;
  EdgeFitter fitter_;
  vpImage<unsigned char> mixture_;
};

}  // namespace vigia::tracking
