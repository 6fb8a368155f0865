#include "vigia/localization/running_fix_localizer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "vigia/localization/travelled.hpp"

namespace vigia::localization {
namespace {

constexpr double kLeastWeight = 0.01;
constexpr std::size_t kMostCandidates = 2;

/// What a candidate makes of what was believed: χ² of their difference and the log of its density.
struct Agreement {
  double square = 0.0;
  double log_density = 0.0;
};

Agreement agreement(const PoseHypothesis& candidate, const PoseHypothesis& believed) {
  const Eigen::LDLT<Eigen::Matrix3d> spread(candidate.covariance + believed.covariance);
  const Eigen::Vector3d e = difference(candidate.pose, believed.pose);
  const double square = e.dot(spread.solve(e));
  return {square, -0.5 * (square + spread.vectorD().array().log().sum())};
}

/// The candidate with the heading that the displacement was turned by, where that is the better
/// known: the bearing's own is that one, with the error of the position on top. Both are off by the
/// same angle, the position about the landmark.
PoseHypothesis with_better_heading(PoseHypothesis candidate, const Eigen::Vector2d& landmark_w,
                                   const HeadingPrior& heading) {
  const double variance = heading.sigma * heading.sigma;
  if (variance >= candidate.covariance(2, 2)) return candidate;
  const Eigen::Vector2d q = candidate.pose.position() - landmark_w;
  candidate.pose.theta = heading.heading;
  candidate.covariance(2, 2) = variance;
  candidate.covariance.topRightCorner<2, 1>() = variance * Eigen::Vector2d(-q.y(), q.x());
  candidate.covariance.bottomLeftCorner<1, 2>() =
      candidate.covariance.topRightCorner<2, 1>().transpose();
  return candidate;
}

/// The corner that is seen nearest the middle of the left image.
const StereoCorner* middle_corner(const StereoObservation& seen) {
  const double middle = 0.5 * (image_width(seen.shot.model) - 1);
  const StereoCorner* nearest = nullptr;
  for (const StereoCorner& corner : seen.corners)
    if (nearest == nullptr ||
        std::abs(corner.left_uv.x() - middle) < std::abs(nearest->left_uv.x() - middle))
      nearest = &corner;
  return nearest;
}

}  // namespace

RunningFixLocalizer::RunningFixLocalizer(FieldMap field, const RunningFixLocalizerParams& params)
    : field_(std::move(field)), params_(params) {}

void RunningFixLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  stamp_ = stamp;
  gated_ = 0;
  firsts_.clear();
  poses_.clear();
  if (prior) poses_.push_back({prior->pose, prior->covariance, 1.0});
  refresh_belief();
}

void RunningFixLocalizer::predict(const OdometryIncrement& u) {
  stamp_ = u.to;
  const Eigen::Matrix3d control = control_covariance(u, params_.pair.odometry);
  for (PoseHypothesis& one : poses_) {
    const Eigen::Matrix3d F = move_jacobian_pose(one.pose, u);
    const Eigen::Matrix3d G = move_jacobian_control(one.pose, u);
    one.pose = move(one.pose, u);
    one.covariance = F * one.covariance * F.transpose() + G * control * G.transpose();
  }
  for (auto& [corner, first] : firsts_) travel(first.since, u, params_.pair.odometry);
  refresh_belief();
}

UpdateResult RunningFixLocalizer::update(const Observation& observation) {
  const auto* seen = std::get_if<StereoObservation>(&observation);
  if (seen == nullptr) return {};
  UpdateResult result{UpdateStatus::no_prior, std::nullopt, 0.0, 0};
  if (poses_.empty()) return result;
  result.status = UpdateStatus::degenerate;
  const StereoCorner* corner = middle_corner(*seen);
  if (corner == nullptr) return result;
  result.status = UpdateStatus::too_late;
  if (seen->shot.stamp < stamp_) return result;
  result.status = UpdateStatus::degenerate;
  const auto place = goal_corner_place(field_, corner->corner);
  const auto point = triangulate(params_.pair.pair, ideal_columns(params_.pair, *corner),
                                 std::sqrt(0.5 * corner->covariance.trace()));
  if (!place || !point) return result;
  const PolarSighting now = polar(*point);
  const auto key = std::pair(static_cast<int>(corner->corner.goal), corner->corner.left);
  const auto first = firsts_.find(key);
  result.status = UpdateStatus::fused;
  if (first == firsts_.end()) {
    firsts_.emplace(key, First{now, {}});
    return result;
  }
  const double way = first->second.since.displacement_m.norm();
  if (way < params_.min_way_m) return {UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  // By value: a fix that loses the robot forgets the first sightings, this one among them.
  const First from = first->second;
  result = fix({*place, Eigen::Matrix2d::Zero()}, from, now);
  const bool used = result.status != UpdateStatus::degenerate || way > params_.max_way_m;
  if (used && !firsts_.empty()) firsts_[key] = {now, {}};
  refresh_belief();
  return result;
}

UpdateResult RunningFixLocalizer::fix(const LandmarkPlace& corner, const First& first,
                                      const PolarSighting& second) {
  std::vector<PoseHypothesis> weighed;
  std::vector<double> logs;
  double least_square = std::numeric_limits<double>::infinity();
  for (const PoseHypothesis& believed : poses_) {
    const HeadingPrior heading{believed.pose.theta, std::sqrt(believed.covariance(2, 2))};
    const RunningFix fix = running_fix({corner, first.sighting, second, first.since, heading},
                                       std::nullopt, params_.fix);
    if (fix.status != RunningFixStatus::found && fix.status != RunningFixStatus::ambiguous)
      continue;
    for (const PoseHypothesis& candidate : fix.candidates) {
      const Agreement with = agreement(candidate, believed);
      least_square = std::min(least_square, with.square);
      weighed.push_back(with_better_heading(candidate, corner.p_w, heading));
      logs.push_back(std::log(believed.weight) + with.log_density);
    }
  }
  if (weighed.empty()) return {UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  UpdateResult result{UpdateStatus::gated, std::nullopt, least_square, 3};
  if (least_square > params_.gate) {
    if (++gated_ >= params_.gated_to_lose) lose();
    return result;
  }
  gated_ = 0;
  const double top = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double& log : logs) sum += (log = std::exp(log - top));
  for (std::size_t i = 0; i < weighed.size(); ++i) weighed[i].weight = logs[i] / sum;
  std::stable_sort(
      weighed.begin(), weighed.end(),
      [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.weight > b.weight; });
  take(weighed);
  result.status = poses_.size() > 1 ? UpdateStatus::ambiguous : UpdateStatus::fused;
  return result;
}

/// Puts the candidates in the place of what was believed, unless that is one pose and better known
/// than the likeliest of them.
void RunningFixLocalizer::take(std::vector<PoseHypothesis> weighed) {
  const auto spread = [](const PoseHypothesis& one) {
    return one.covariance.topLeftCorner<2, 2>().trace();
  };
  if (poses_.size() == 1 && spread(weighed.front()) >= spread(poses_.front())) return;
  if (weighed.front().weight >= params_.fix.resolved) weighed.resize(1);
  while (weighed.size() > 1 &&
         (weighed.back().weight < kLeastWeight || weighed.size() > kMostCandidates))
    weighed.pop_back();
  double sum = 0.0;
  for (const PoseHypothesis& one : weighed) sum += one.weight;
  for (PoseHypothesis& one : weighed) one.weight /= sum;
  poses_ = std::move(weighed);
}

void RunningFixLocalizer::lose() {
  reset(stamp_, std::nullopt);
}

void RunningFixLocalizer::refresh_belief() {
  const Belief last = belief_;
  belief_ = {};
  belief_.stamp = stamp_;
  if (poses_.empty()) {
    belief_.pose = last.pose;
    belief_.covariance = anywhere().covariance;
    belief_.status = BeliefStatus::lost;
    belief_.lost_probability = 1.0;
    return;
  }
  belief_.pose = poses_.front().pose;
  belief_.covariance = poses_.front().covariance;
  if (poses_.size() == 1) return;
  belief_.status = BeliefStatus::ambiguous;
  belief_.hypotheses = poses_;
}

}  // namespace vigia::localization
