#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/belief.hpp"
#include "vigia/localization/station_motion.hpp"
#include "vigia/localization/stereo_pair.hpp"

namespace vigia::localization {

/// Columns of a landmark, known by the map, in both images of a pair.
struct StereoSighting {
  std::size_t landmark = 0;  ///< its place in StationChain::landmarks
  StereoColumns columns;
  double sigma_px = 0.1;  ///< of each column
};

/// What a robot saw from the points of a drive, the oldest first, one sighting a point, and how it
/// went from each to the next. Two points and one landmark are Bais's.
struct StationChain {
  StereoPair pair;
  /// What the calibration may miss, the same along the whole chain; 0 where it is exact.
  StereoErrors calibration_sigma;
  std::vector<LandmarkPlace> landmarks;
  std::vector<StereoSighting> sightings;
  std::vector<StationMotion> motions;   ///< one less than sightings
  std::optional<HeadingPrior> heading;  ///< of the robot at the last point
};

enum class StationFixStatus {
  found,
  ambiguous,      ///< two poses explain the columns, neither of them resolved: the way is not much
                  ///< longer than the ranges' errors
  degenerate,     ///< |sin γ| is below the gate (the poses are filled in), or the pose is not
                  ///< determined at all
  no_heading,     ///< by a single landmark and displacements in the robot's own axes the robot may
                  ///< stand anywhere on a circle about the landmark
  behind_camera,  ///< a sighting without positive disparity, or a pose that cannot have it
  not_converged,
};

struct StationFixParams {
  /// Of the greatest angle between two lines of sight, as RunningFixParams has it. Not asked for
  /// where a heading is given: range and bearing then need one point.
  double min_sin_gamma = 0.3;
  double resolved = 0.99;   ///< weight from which on a hypothesis is the answer
  int iterations = 60;      ///< at most
  double converged = 1e-7;  ///< length of the last step: m, rad and σ
};

/// The robot at the last point.
struct StationFix {
  StationFixStatus status = StationFixStatus::degenerate;
  /// The likelier first, at most two, none where the pose is not determined. Pose and covariance
  /// are the posterior's mean and covariance: where the heading is not well known the positions
  /// bend about the landmark, which the curvature at the mode misses.
  std::vector<PoseHypothesis> hypotheses;
  StereoErrors calibration;  ///< as estimated with the likelier
  Eigen::Matrix3d calibration_covariance = Eigen::Matrix3d::Zero();
  /// Of (x, y, θ, baseline, vergence, focal) with the likelier, by the curvature at its mode.
  Eigen::Matrix<double, 6, 6> joint_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double sin_gamma = 0.0;
  double chi_square = 0.0;  ///< of all residuals, priors included
};

/// Maximum likelihood of the last pose by all columns: range and bearing at every point, jointly
/// with the errors of calibration, displacement and map within their covariances (Levenberg and
/// Marquardt from the closed form of two sets of points; of two points also from its mirror image
/// at the line of sight, since the depth of what is seen is what is known worst).
StationFix station_fix(const StationChain& chain, const StationFixParams& params = {});

/// The Cramér–Rao bound of the last pose: @p chain holds true displacements and places, the
/// columns are not looked at, errors that have a σ count as drawn by it (@p errors are the true
/// ones of calibration). Nothing where the pose is not determined.
std::optional<Eigen::Matrix3d> station_bound(const StationChain& chain, const Pose2& last,
                                             const StereoErrors& errors = {});

/// Residuals of a chain at a point of its state (x, y, θ of the last point, then in units of their
/// σ: baseline, vergence, focal; dx, dy, turn of each motion; x, y of each landmark), whitened, and
/// their Jacobian. Empty where a sighting is behind the camera.
struct ChainResiduals {
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
};
std::optional<ChainResiduals> chain_residuals(const StationChain& chain,
                                              const Eigen::VectorXd& state);
Eigen::Index chain_state_size(const StationChain& chain);

}  // namespace vigia::localization
