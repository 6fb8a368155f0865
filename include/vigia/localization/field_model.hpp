#pragma once

#include <Eigen/Core>

#include "vigia/core/field_map.hpp"
#include "vigia/core/field_scan.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/localization/straight_groups.hpp"

namespace vigia::localization {

struct FieldModelParams {
  /// Share of the points that lie on no line, unless it is estimated.
  double clutter = 0.2;
  /// Line crossings of a ray within the range of sight, on average.
  double crossings_per_ray = 2.5;
  /// σ of what the map and the mirror's calibration leave out, m.
  double floor_m = 0.002;
  /// Probability that a goal or post is not what its colour says.
  double sighting_outliers = 0.02;
  /// What a straight line that the map lacks costs, nats: between poses far apart, the points on
  /// one line count for no more.
  double line_price = 10.0;
};

/// The sum over a scan's points at a pose.
struct FieldLinearisation {
  double log_likelihood = 0.0;
  /// Of it by (x, y, θ), but for how the incidence of rays, the points' spread across a line and
  /// the share of it between the line's ends change: they teach little beside the offsets.
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d complete = Eigen::Matrix3d::Zero();  ///< information, were each point's
                                                       ///< line known (EM's)
  Eigen::Matrix3d observed = Eigen::Matrix3d::Zero();  ///< minus the second derivative
  double on_lines = 0.0;                               ///< expected number of such points
};

/// Measurement model of a scan of a field. A ray crosses lines at any place along them, so a point
/// says only how far it lies off a line. Per radian of bearing and metre of range its density is
///
///   Λ(β, r) ∝ Σ_j |n_j·u| N(d_j; 0, n_jᵀ C n_j) E_j + c r,   c = ε/(1 − ε) · 2π m / A,
///
/// over the lines j: n_j the normal, d_j the offset, u the ray's direction, C the point's
/// covariance, E_j the share of the point's spread along the line that lies between its ends, ε the
/// share of clutter (uniform over the floor's area A), m the crossings per ray.
class FieldModel {
 public:
  explicit FieldModel(const FieldMap& map, const FieldModelParams& params = {});

  const FieldMap& map() const { return map_; }
  const FieldDistance& distance() const { return distance_; }
  const FieldModelParams& params() const { return params_; }
  /// Whether half a turn changes none of the lines.
  bool lines_symmetric() const { return lines_symmetric_; }
  /// Whether half a turn changes nothing at all.
  bool symmetric() const { return symmetric_; }

  /// Log-likelihood of the points at share of clutter @p clutter, up to a constant.
  double log_likelihood(const std::vector<FieldPoint>& points, const Pose2& pose,
                        double clutter) const;
  /// The same with derivatives. @p spread_m: σ added to every point, to widen the basin.
  FieldLinearisation linearise(const std::vector<FieldPoint>& points, const Pose2& pose,
                               double clutter, double spread_m = 0.0) const;
  /// Log-likelihood where what is false may lie on straight lines: how much better than clutter the
  /// points are explained. Those of a straight group lie on
  /// the map's lines as this pose has it, or on one straight line that the map lacks,
  ///
  ///   Σ_{i in no group} log(Λ_i/c_i) + Σ_g log(Π_{i∈g} Λ_i/c_i + e^{−line_price} Π_{i∈g} (ρ_i +
  ///   c_i)/c_i),
  ///
  /// ρ_i the density of point i on its group's own line. log_likelihood() takes the points of one
  /// false line for as many independent facts.
  double line_evidence(const std::vector<FieldPoint>& points,
                       const std::vector<StraightGroup>& groups, const Pose2& pose,
                       double clutter) const;
  std::vector<StraightGroup> groups_of(const FieldScan& scan) const {
    return straight_groups(scan.points, params_.floor_m);
  }
  /// Log-likelihood of goals and posts, up to a constant.
  double log_likelihood_of_sightings(const FieldScan& scan, const Pose2& pose) const;
  /// Gradient and information of the sightings that lie within 3σ of a goal or post of their
  /// colour.
  FieldLinearisation linearise_sightings(const FieldScan& scan, const Pose2& pose) const;
  /// Log-likelihood of the whole scan at the share of clutter assumed.
  double log_likelihood(const FieldScan& scan, const Pose2& pose) const;

  /// x, y, θ turned by half a turn about the field's centre.
  static Pose2 half_turned(const Pose2& pose);

 private:
  double clutter_density(double clutter) const;

  FieldMap map_;
  FieldModelParams params_;
  FieldDistance distance_;
  bool lines_symmetric_;
  bool symmetric_;
};

}  // namespace vigia::localization
