#include "vigia/localization/pattern_fix.hpp"

#include "lost_probability.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "vigia/localization/chi_square.hpp"
#include "vigia/localization/motion.hpp"

namespace vigia::localization {
namespace {

/// The planar prior as a pose in space: on the floor and upright, which it takes for certain.
SpatialPose on_the_floor(const Prior& prior, const Ground& ground) {
  SpatialPose pose;
  pose.wMr = ground.place(prior.pose);
  const Eigen::Matrix<double, 6, 3> J = ground.dplace_dpose(prior.pose);
  pose.covariance = J * prior.covariance * J.transpose();
  return pose;
}

/// What is left of the fit's χ² once the focal length is let off by its error, too.
double scatter(const std::vector<SeenPoint>& points, const Intrinsics& intrinsics,
               const FittedPose& fit, double focal_sigma) {
  const auto at = fit_points(points, intrinsics, fit.cMl);
  if (!at) return fit.chi2;
  Eigen::Matrix<double, 7, 7> information = at->information;
  information(6, 6) += 1.0 / std::max(focal_sigma * focal_sigma, 1e-18);
  return at->chi2 - at->gradient.dot(information.ldlt().solve(at->gradient));
}

/// What is left of an increment after @p stamp.
OdometryIncrement rest_of(const OdometryIncrement& u, Stamp stamp) {
  if (stamp <= u.from) return u;
  return second_part(u, (stamp - u.from).seconds() / (u.to - u.from).seconds());
}

}  // namespace

PatternFixLocalizer::PatternFixLocalizer(LandmarkMap map, const RigOnGround& on_ground,
                                         const PatternFixParams& params)
    : map_(std::move(map)), on_ground_(on_ground), params_(params) {
  reset(Stamp{}, std::nullopt);
}

void PatternFixLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  history_.clear();
  start_ = stamp;
  belief_ = Belief{};
  if (!prior) belief_.status = BeliefStatus::lost;
  believe(on_the_floor(prior.value_or(anywhere()), on_ground_.ground), stamp);
}

void PatternFixLocalizer::lose() {
  belief_.status = BeliefStatus::lost;
  belief_.lost_probability = kSaidLost;
}

void PatternFixLocalizer::believe(const SpatialPose& pose, Stamp stamp) {
  const PlanarEstimate planar = seen_from_above(pose, on_ground_.ground);
  belief_.stamp = stamp;
  belief_.pose = planar.pose;
  belief_.covariance = planar.covariance;
  belief_.in_space = pose;
  belief_.lost_probability = belief_.status == BeliefStatus::lost
                                 ? kSaidLost
                                 : probability_of_half_a_metre(belief_.position_sigma());
}

void PatternFixLocalizer::predict(const OdometryIncrement& increment) {
  // An image ahead of the odometry has moved the belief into this increment already.
  if (belief_.stamp < increment.to)
    believe(moved_by(*belief_.in_space, rest_of(increment, belief_.stamp), params_.odometry,
                     on_ground_.ground),
            increment.to);
  history_.push_back(increment);
  const Stamp oldest = increment.to - Duration::from_seconds(params_.history_s);
  while (history_.front().to < oldest) {
    start_ = history_.front().to;
    history_.pop_front();
  }
}

UpdateResult PatternFixLocalizer::update(const Observation& observation) {
  UpdateResult result;
  if (const auto* points = std::get_if<PointsObservation>(&observation)) result = process(*points);
  ++counts_[static_cast<std::size_t>(result.status)];
  return result;
}

UpdateResult PatternFixLocalizer::process(const PointsObservation& observation) {
  const Landmark* landmark = map_.find(observation.landmark);
  if (landmark == nullptr) return {UpdateStatus::gated, std::nullopt, 0.0, 0};
  if (!std::holds_alternative<PatternShape>(landmark->shape)) return {};
  const Shot& shot = observation.shot;
  if (shot.stamp < start_) return {UpdateStatus::too_late, landmark->id, 0.0, 0};
  const auto points = seen_points(*landmark, observation);
  const PointsPose solved = solve_points(points, pinhole(shot), params_.pose);
  if (!solved.has_pose() || solved.frontal) return {UpdateStatus::degenerate, landmark->id, 0.0, 0};
  const FittedPose* fit = upright(solved, *landmark, shot);
  if (fit == nullptr) {
    const bool both = solved.status == PointsPoseStatus::ambiguous;
    return {both ? UpdateStatus::ambiguous : UpdateStatus::gated, landmark->id, solved.pose.chi2,
            solved.pose.dof};
  }
  const double chi2 = scatter(points, pinhole(shot), *fit, params_.sensor.look_focal);
  const UpdateResult result{UpdateStatus::fused, landmark->id, chi2, fit->dof};
  if (fit->dof > 0 && chi2 > chi_square_quantile(params_.gate_probability, fit->dof))
    return {UpdateStatus::gated, result.landmark, result.nis, result.dof};

  SpatialPose pose = robot_in_space(*landmark, *fit, shot, on_ground_, params_.sensor);
  Stamp stamp = shot.stamp;
  for (const OdometryIncrement& u : history_) {
    if (u.to <= shot.stamp) continue;
    pose = moved_by(pose, rest_of(u, shot.stamp), params_.odometry, on_ground_.ground);
    stamp = u.to;
  }
  belief_.status = BeliefStatus::tracking;
  believe(pose, stamp);
  return result;
}

const FittedPose* PatternFixLocalizer::upright(const PointsPose& solved, const Landmark& landmark,
                                               const Shot& shot) const {
  const auto stands = [&](const FittedPose& fit) {
    const SpatialPose pose = robot_in_space(landmark, fit, shot, on_ground_, params_.sensor);
    return pose.wMr.linear()(2, 2) > std::cos(params_.max_slope);
  };
  const bool pose_stands = stands(solved.pose);
  if (solved.status != PointsPoseStatus::ambiguous) return pose_stands ? &solved.pose : nullptr;
  const bool twin_stands = stands(*solved.twin);
  if (pose_stands == twin_stands) return nullptr;
  return pose_stands ? &solved.pose : &*solved.twin;
}

}  // namespace vigia::localization
