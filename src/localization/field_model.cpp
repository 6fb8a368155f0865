#include "vigia/localization/field_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/localization/normal_density.hpp"

namespace vigia::localization {
namespace {

constexpr double kGateSigmas = 4.0;  // a line farther off has no share in a point
constexpr double kWidestSigma_m = 0.6;
constexpr double kSightingGate = 11.8;  // χ² of 3σ, two degrees of freedom

/// One line's share in a point.
struct LineShare {
  double density = 0.0;
  double score = 0.0;  // −d/σ², ∂ log density/∂d
  double information = 0.0;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
};

/// A point carried to the world at a pose.
struct PlacedPoint {
  Eigen::Vector2d p_w;
  Eigen::Matrix2d covariance_w;
  Eigen::Vector2d direction_w;
};

/// Share of a Gaussian (σ) that lies inside an end @p inside_m away.
double share_inside(double inside_m, double sigma) {
  if (inside_m > 3.0 * sigma) return 1.0;
  return 0.5 * std::erfc(-inside_m / (sigma * std::sqrt(2.0)));
}

LineShare line_share(const FieldLine& line, const PlacedPoint& point, double extra_variance) {
  LineShare share;
  const LineOffset offset = line_offset(line, point.p_w);
  const Eigen::Vector2d& n = offset.normal;
  const double variance = n.dot(point.covariance_w * n) + extra_variance;
  const double d = offset.distance_m;
  if (d * d > kGateSigmas * kGateSigmas * variance) return share;
  const Eigen::Vector2d along(-n.y(), n.x());
  const double along_sigma = std::sqrt(along.dot(point.covariance_w * along) + extra_variance);
  if (offset.inside_m < -kGateSigmas * along_sigma) return share;
  share.density = std::abs(n.dot(point.direction_w)) * normal_density(d, variance) *
                  share_inside(offset.inside_m, along_sigma);
  share.score = -d / variance;
  share.information = 1.0 / variance;
  share.normal = n;
  return share;
}

struct Turn {
  Eigen::Matrix2d rotation;
  Eigen::Vector2d position;
  explicit Turn(const Pose2& pose) : position(pose.position()) {
    const double c = std::cos(pose.theta);
    const double s = std::sin(pose.theta);
    rotation << c, -s, s, c;
  }
};

PlacedPoint placed_at(const FieldPoint& point, const Turn& turn) {
  PlacedPoint placed;
  const Eigen::Vector2d arm = turn.rotation * point.p_r;
  placed.p_w = turn.position + arm;
  placed.covariance_w = turn.rotation * point.covariance * turn.rotation.transpose();
  placed.direction_w = arm / std::max(1e-6, arm.norm());
  return placed;
}

/// Density of a point's place over its lines, without derivatives.
double density_on_lines(const FieldDistance& distance, const PlacedPoint& point,
                        double extra_variance) {
  double density = 0.0;
  for (const std::uint16_t i : distance.near(point.p_w))
    density += line_share(distance.lines()[i], point, extra_variance).density;
  return density;
}

/// The logarithm of a product of many factors ≥ 1, with few logarithms taken.
class LogProduct {
 public:
  void multiply(double factor) {
    product_ *= factor;
    if (product_ < kLarge) return;
    log_ += std::log(product_);
    product_ = 1.0;
  }
  double log() const { return log_ + std::log(product_); }

 private:
  static constexpr double kLarge = 1e150;
  double product_ = 1.0;
  double log_ = 0.0;
};

/// Adds one point to the sums: the mixture's gradient, and its information by Louis' identity,
/// complete minus the variance of the score over the mixture.
void add_point(const FieldDistance& distance, const PlacedPoint& placed,
               const Eigen::Vector2d& arm_turned, double clutter_density, double extra_variance,
               FieldLinearisation& sums) {
  double total = clutter_density;
  Eigen::Vector3d score = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d squared = Eigen::Matrix3d::Zero();
  for (const std::uint16_t i : distance.near(placed.p_w)) {
    const LineShare share = line_share(distance.lines()[i], placed, extra_variance);
    if (share.density <= 0.0) continue;
    total += share.density;
    const Eigen::Vector3d J(share.normal.x(), share.normal.y(), share.normal.dot(arm_turned));
    const Eigen::Matrix3d JJ = share.density * J * J.transpose();
    score += share.density * share.score * J;
    information += share.information * JJ;
    squared += share.score * share.score * JJ;
  }
  sums.log_likelihood += std::log(total);
  score /= total;
  sums.gradient += score;
  sums.complete += information / total;
  sums.observed += (information - squared) / total + score * score.transpose();
  sums.on_lines += 1.0 - clutter_density / total;
}

/// Adds the bearing and range of a goal or post, if it can be @p target.
void add_sighting(const ColourSighting& seen, const Eigen::Vector2d& target, const Pose2& pose,
                  FieldLinearisation& sums) {
  const Eigen::Vector2d to = target - pose.position();
  const double range = to.norm();
  const double db = wrap_angle(seen.bearing - std::atan2(to.y(), to.x()) + pose.theta);
  const double dr = seen.range_m - range;
  const double wb = 1.0 / (seen.bearing_sigma * seen.bearing_sigma);
  const double wr = 1.0 / (seen.range_sigma_m * seen.range_sigma_m);
  if (db * db * wb + dr * dr * wr > kSightingGate) return;
  const Eigen::Vector2d u = to / range;
  const Eigen::Vector3d dbearing_dpose(u.y() / range, -u.x() / range, -1.0);
  const Eigen::Vector3d drange_dpose(-u.x(), -u.y(), 0.0);
  sums.log_likelihood -= 0.5 * (db * db * wb + dr * dr * wr);
  sums.gradient += wb * db * dbearing_dpose + wr * dr * drange_dpose;
  sums.complete += wb * dbearing_dpose * dbearing_dpose.transpose() +
                   wr * drange_dpose * drange_dpose.transpose();
}

/// Calls @p use with each goal and post seen and the places of those of its colour.
template <typename Use>
void for_each_sighting(const FieldMap& map, const FieldScan& scan, const Use& use) {
  for (const ColourSighting& seen : scan.goals) {
    std::vector<Eigen::Vector2d> targets;
    for (const FieldGoal& goal : map.goals)
      if (goal.colour == seen.colour) targets.push_back(goal.centre());
    use(seen, targets);
  }
  for (const ColourSighting& seen : scan.posts) {
    std::vector<Eigen::Vector2d> targets;
    for (const CornerPost& post : map.posts)
      if (post.outer == seen.colour) targets.push_back(post.at);
    use(seen, targets);
  }
}

double sighting_log_density(const ColourSighting& seen, const Eigen::Vector2d& target,
                            const Pose2& pose, double outliers, double floor_area) {
  const Eigen::Vector2d to = target - pose.position();
  const double range = to.norm();
  const double bearing = std::atan2(to.y(), to.x()) - pose.theta;
  const double db = wrap_angle(seen.bearing - bearing) / seen.bearing_sigma;
  const double dr = (seen.range_m - range) / seen.range_sigma_m;
  const double inlier =
      std::exp(-0.5 * (db * db + dr * dr)) / (2.0 * kPi * seen.bearing_sigma * seen.range_sigma_m);
  return std::log((1.0 - outliers) * inlier + outliers * seen.range_m / floor_area);
}

}  // namespace

FieldModel::FieldModel(const FieldMap& map, const FieldModelParams& params)
    : map_(map),
      params_(params),
      distance_(map, kWidestSigma_m),
      lines_symmetric_(map.half_turn_symmetric(false)),
      symmetric_(map.half_turn_symmetric()) {}

double FieldModel::clutter_density(double clutter) const {
  const double area = (map_.length_m + 2.0 * map_.margin_m) * (map_.width_m + 2.0 * map_.margin_m);
  return clutter / (1.0 - clutter) * 2.0 * kPi * params_.crossings_per_ray / area;
}

double FieldModel::log_likelihood(const std::vector<FieldPoint>& points, const Pose2& pose,
                                  double clutter) const {
  const Turn turn(pose);
  const double c = clutter_density(clutter);
  const double floor_variance = params_.floor_m * params_.floor_m;
  // log(1 − ε) keeps different shares of clutter comparable.
  double sum = static_cast<double>(points.size()) * std::log(1.0 - clutter);
  for (const FieldPoint& point : points)
    sum += std::log(density_on_lines(distance_, placed_at(point, turn), floor_variance) +
                    c * point.p_r.norm());
  return sum;
}

double FieldModel::line_evidence(const std::vector<FieldPoint>& points,
                                 const std::vector<StraightGroup>& groups, const Pose2& pose,
                                 double clutter) const {
  const Turn turn(pose);
  const double c = clutter_density(clutter);
  const double floor_variance = params_.floor_m * params_.floor_m;
  std::vector<double> gain;  // per point, density on lines or clutter over that of clutter
  gain.reserve(points.size());
  for (const FieldPoint& point : points)
    gain.push_back(1.0 + density_on_lines(distance_, placed_at(point, turn), floor_variance) /
                             (c * point.p_r.norm()));
  double sum = 0.0;
  for (const StraightGroup& group : groups) {
    LogProduct by_map;
    LogProduct by_itself;
    for (std::size_t k = 0; k < group.points.size(); ++k) {
      const std::size_t i = group.points[k];
      by_map.multiply(gain[i]);
      by_itself.multiply(1.0 + group.line_densities[k] / (c * points[i].p_r.norm()));
      gain[i] = 1.0;
    }
    const double map = by_map.log();
    const double itself = by_itself.log() - params_.line_price;
    sum += std::max(map, itself) + std::log1p(std::exp(-std::abs(map - itself)));
  }
  LogProduct alone;
  for (const double factor : gain) alone.multiply(factor);
  return sum + alone.log();
}

FieldLinearisation FieldModel::linearise(const std::vector<FieldPoint>& points, const Pose2& pose,
                                         double clutter, double spread_m) const {
  const Turn turn(pose);
  const double c = clutter_density(clutter);
  const double extra_variance = params_.floor_m * params_.floor_m + spread_m * spread_m;
  FieldLinearisation sums;
  sums.log_likelihood = static_cast<double>(points.size()) * std::log(1.0 - clutter);
  for (const FieldPoint& point : points) {
    const PlacedPoint placed = placed_at(point, turn);
    const Eigen::Vector2d arm = placed.p_w - turn.position;
    add_point(distance_, placed, {-arm.y(), arm.x()}, c * point.p_r.norm(), extra_variance, sums);
  }
  return sums;
}

double FieldModel::log_likelihood_of_sightings(const FieldScan& scan, const Pose2& pose) const {
  const double area = (map_.length_m + 2.0 * map_.margin_m) * (map_.width_m + 2.0 * map_.margin_m);
  double sum = 0.0;
  for_each_sighting(map_, scan, [&](const ColourSighting& seen, const auto& targets) {
    double best = -1e300;
    for (const Eigen::Vector2d& target : targets)
      best =
          std::max(best, sighting_log_density(seen, target, pose, params_.sighting_outliers, area));
    if (best > -1e300) sum += best;
  });
  return sum;
}

FieldLinearisation FieldModel::linearise_sightings(const FieldScan& scan, const Pose2& pose) const {
  FieldLinearisation sums;
  for_each_sighting(map_, scan, [&](const ColourSighting& seen, const auto& targets) {
    for (const Eigen::Vector2d& target : targets) add_sighting(seen, target, pose, sums);
  });
  sums.observed = sums.complete;
  return sums;
}

double FieldModel::log_likelihood(const FieldScan& scan, const Pose2& pose) const {
  return log_likelihood(scan.points, pose, params_.clutter) +
         log_likelihood_of_sightings(scan, pose);
}

Pose2 FieldModel::half_turned(const Pose2& pose) {
  return {-pose.x, -pose.y, wrap_angle(pose.theta + kPi)};
}

}  // namespace vigia::localization
