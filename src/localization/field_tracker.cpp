#include "vigia/localization/field_tracker.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/localization/field_posterior.hpp"
#include "vigia/localization/normal_density.hpp"

namespace vigia::localization {
namespace {

constexpr double kSameHypothesis_m = 0.15;
constexpr double kSameTurn = 0.06;
constexpr double kForgotten = 60.0;        // log weight below the best's at which a hypothesis goes
constexpr double kIntegrated = -7.0;       // log weight from which a hypothesis is integrated over
constexpr double kForgottenWeight = 1e-6;  // of a belief's hypotheses
constexpr double kUsualGain = 0.05;
constexpr double kFallen = 0.35;  // of the log-likelihood a point: about a fifth of the points lost

bool same_hypothesis(const Pose2& a, const Pose2& b) {
  const Eigen::Vector3d d = difference(a, b);
  return d.head<2>().norm() < kSameHypothesis_m && std::abs(d.z()) < kSameTurn;
}

/// Whether a pose lies within a prior's 4σ.
bool could_be(const Prior& prior, const Pose2& pose) {
  const Eigen::Vector3d off = difference(pose, prior.pose);
  return off.dot(prior.covariance.ldlt().solve(off)) < 16.0;
}

}  // namespace

void FieldTracker::Hypothesis::half_turn() {
  pose = FieldModel::half_turned(pose);
  covariance = FieldModel::half_turned(covariance);
  turned = 1.0 - turned;
}

FieldTracker::FieldTracker(const FieldModel& model, const FieldTrackerParams& params)
    : model_(&model), params_(params), matcher_(model), clutter_(model.params().clutter) {}

void FieldTracker::reset(Stamp stamp, const std::optional<Prior>& prior) {
  hypotheses_.clear();
  usual_.reset();
  since_check_ = params_.check_every;
  if (prior) hypotheses_.push_back({prior->pose, prior->covariance, 0.0, 0.0});
  belief_ = Belief{};
  belief_.stamp = stamp;
  refresh_belief();
}

void FieldTracker::predict(const OdometryIncrement& increment) {
  for (Hypothesis& hypothesis : hypotheses_) {
    const Eigen::Matrix3d F = move_jacobian_pose(hypothesis.pose, increment);
    const Eigen::Matrix3d G = move_jacobian_control(hypothesis.pose, increment);
    hypothesis.covariance = F * hypothesis.covariance * F.transpose() +
                            G * control_covariance(increment, params_.odometry) * G.transpose();
    hypothesis.pose = move(hypothesis.pose, increment);
  }
  belief_.stamp = increment.to;
  refresh_belief();
}

void FieldTracker::refine_all(const FieldScan& scan, const std::vector<StraightGroup>& groups,
                              const Matches& matches) {
  FieldRefineParams fixed;
  fixed.clutter = clutter_;
  for (Hypothesis& hypothesis : hypotheses_) {
    const Prior prior{hypothesis.pose, hypothesis.covariance + 1e-10 * Eigen::Matrix3d::Identity()};
    // From where it is believed, and from where the image has it: the nearer peak of the likelihood
    // need not be the higher one.
    std::optional<FieldFix> best;
    double evidence = 0.0;
    const auto refine_from = [&](const Pose2& start) {
      const FieldFix fix = refine_field_pose(*model_, scan.points, start, prior, fixed);
      if (fix.status == FieldFixStatus::degenerate) return;
      const double of_fix = log_evidence_of(*model_, scan, groups, fix, clutter_);
      if (best && of_fix <= evidence) return;
      best = fix;
      evidence = of_fix;
    };
    refine_from(prior.pose);
    for (const auto& match : matches)
      if (could_be(prior, match.fix.pose)) refine_from(match.fix.pose);
    if (!best) continue;
    hypothesis.pose = best->pose;
    hypothesis.covariance = best->covariance;
    if (hypothesis.log_weight > kIntegrated) {
      const FieldPosterior posterior = posterior_about(*model_, scan.points, groups, *best, prior);
      hypothesis.pose = posterior.mean;
      hypothesis.covariance = posterior.covariance;
      evidence = posterior.log_evidence + model_->log_likelihood_of_sightings(scan, posterior.mean);
    }
    hypothesis.log_weight += evidence + weigh_sightings(scan, hypothesis);
  }
}

/// What is to be added to the log evidence of a hypothesis, which counts the sightings as seen from
/// its pose, for its twin's share.
double FieldTracker::weigh_sightings(const FieldScan& scan, Hypothesis& hypothesis) const {
  const auto either = model_->weigh_halves(scan, hypothesis.pose, hypothesis.turned);
  hypothesis.turned = either.turned;
  return either.log_likelihood - model_->log_likelihood_of_sightings(scan, hypothesis.pose);
}

/// Of a pose that a match suggests, before the scan: anywhere after a kidnapping, or beside one of
/// the hypotheses.
double FieldTracker::prior_density(const Pose2& pose,
                                   const std::vector<Hypothesis>& predicted) const {
  const FieldMap& map = model_->map();
  const double anywhere = 1.0 / (map.length_m * map.width_m * 2.0 * kPi);
  if (predicted.empty()) return anywhere;
  const Eigen::Vector3d beside(params_.beside_m, params_.beside_m, params_.beside_rad);
  const Eigen::Matrix3d push = beside.cwiseAbs2().asDiagonal();
  double density = params_.kidnapped * anywhere;
  for (Hypothesis hypothesis : predicted)
    for (int half = 0; half < 2; ++half) {
      const Eigen::Vector3d off = difference(pose, hypothesis.pose);
      density += params_.beside * hypothesis.own_weight() *
                 std::exp(log_normal_density(off, hypothesis.covariance + push));
      hypothesis.half_turn();
    }
  return density;
}

/// The hypothesis that stands for a pose.
FieldTracker::Hypothesis* FieldTracker::known_place(const Pose2& pose) {
  const auto known =
      std::find_if(hypotheses_.begin(), hypotheses_.end(),
                   [&](const Hypothesis& other) { return same_hypothesis(other.pose, pose); });
  return known == hypotheses_.end() ? nullptr : &*known;
}

void FieldTracker::add_matches(const FieldScan& scan, const std::vector<StraightGroup>& groups,
                               const Matches& matches, const std::vector<Hypothesis>& predicted) {
  FieldRefineParams fixed;
  fixed.clutter = clutter_;
  const bool twins = model_->lines_symmetric();
  for (const auto& suggestion : twins ? without_twins(matches) : matches) {
    const FieldFix fix =
        refine_field_pose(*model_, scan.points, suggestion.fix.pose, std::nullopt, fixed);
    if (fix.status == FieldFixStatus::degenerate) continue;
    const double here = prior_density(fix.pose, predicted);
    const double there = twins ? prior_density(FieldModel::half_turned(fix.pose), predicted) : 0.0;
    Hypothesis found{fix.pose, fix.covariance, std::log(here + there), there / (here + there)};
    found.log_weight +=
        log_evidence_of(*model_, scan, groups, fix, clutter_) + weigh_sightings(scan, found);
    if (twins && found.turned > 0.5) found.half_turn();
    Hypothesis* known = known_place(found.pose);
    if (known == nullptr && twins) {
      found.half_turn();
      known = known_place(found.pose);
      if (known == nullptr) found.half_turn();
    }
    if (known == nullptr)
      hypotheses_.push_back(found);
    else if (found.log_weight > known->log_weight)
      *known = found;
  }
}

bool FieldTracker::evidence_has_fallen() const {
  return usual_ && last_ < *usual_ - kFallen;
}

void FieldTracker::merge_and_prune() {
  std::sort(hypotheses_.begin(), hypotheses_.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_weight > b.log_weight; });
  std::vector<Hypothesis> kept;
  for (const Hypothesis& hypothesis : hypotheses_) {
    if (kept.size() >= static_cast<std::size_t>(params_.hypotheses)) break;
    if (!kept.empty() && hypothesis.log_weight < kept.front().log_weight - kForgotten) break;
    const bool double_of_another = std::any_of(kept.begin(), kept.end(), [&](const auto& other) {
      return same_hypothesis(other.pose, hypothesis.pose) ||
             (model_->lines_symmetric() &&
              same_hypothesis(other.pose, FieldModel::half_turned(hypothesis.pose)));
    });
    if (!double_of_another) kept.push_back(hypothesis);
  }
  if (!kept.empty()) {
    const double highest = kept.front().log_weight;
    for (Hypothesis& hypothesis : kept) hypothesis.log_weight -= highest;
  }
  hypotheses_ = std::move(kept);
}

void FieldTracker::update(const FieldScan& scan) {
  belief_.stamp = scan.stamp;
  if (scan.points.empty()) return;
  // Log weights that are to be compared with a match's carry the norm of all: one.
  double sum = 0.0;
  for (const Hypothesis& hypothesis : hypotheses_) sum += std::exp(hypothesis.log_weight);
  for (Hypothesis& hypothesis : hypotheses_) hypothesis.log_weight -= std::log(sum);
  ++since_check_;
  const bool unsure = belief_.status != BeliefStatus::tracking && since_check_ >= 3;
  const bool check = hypotheses_.empty() || since_check_ >= params_.check_every || unsure ||
                     (evidence_has_fallen() && since_check_ >= 2);
  const std::vector<StraightGroup> groups = model_->groups_of(scan);
  const Matches matches = check ? matcher_.match(scan) : Matches{};
  const std::vector<Hypothesis> predicted = hypotheses_;
  if (check && model_->lines_symmetric())
    for (Hypothesis& hypothesis : hypotheses_)
      hypothesis.turned = std::max(hypothesis.turned, params_.kidnapped);
  refine_all(scan, groups, matches);
  if (check) {
    add_matches(scan, groups, matches, predicted);
    since_check_ = 0;
  }
  for (Hypothesis& hypothesis : hypotheses_)
    if (hypothesis.turned > 0.5) hypothesis.half_turn();
  merge_and_prune();
  refresh_belief();
  if (hypotheses_.empty()) return;
  const FieldLinearisation at = model_->linearise(scan.points, hypotheses_.front().pose, clutter_);
  const double points = static_cast<double>(scan.points.size());
  last_ = at.log_likelihood / points;
  usual_ = usual_ ? *usual_ + kUsualGain * (last_ - *usual_) : last_;
  const double off = (points - at.on_lines + 1.0) / (points + 5.0);
  clutter_ = std::clamp(clutter_ + 0.1 * (off - clutter_), 0.01, 0.7);
}

double FieldTracker::doubt() const {
  double sum = 0.0;
  double best = 0.0;
  for (const Hypothesis& hypothesis : hypotheses_) {
    sum += std::exp(hypothesis.log_weight);
    best = std::max(best, hypothesis.own_weight());
  }
  return hypotheses_.empty() ? 1.0 : 1.0 - best / sum;
}

void FieldTracker::refresh_belief() {
  belief_.hypotheses.clear();
  belief_.status = BeliefStatus::lost;
  belief_.lost_probability = doubt();
  if (hypotheses_.empty()) {
    const FieldMap& map = model_->map();
    belief_.pose = {};
    belief_.covariance = Eigen::Vector3d(map.length_m * map.length_m / 12.0,
                                         map.width_m * map.width_m / 12.0, kPi * kPi / 3.0)
                             .asDiagonal();
    return;
  }
  const auto best = std::max_element(
      hypotheses_.begin(), hypotheses_.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.own_weight() < b.own_weight(); });
  belief_.pose = best->pose;
  belief_.covariance = best->covariance;
  const double weight = 1.0 - doubt();
  if (belief_.position_sigma() > params_.lost_sigma_m || weight < 0.3) return;
  belief_.status = weight >= params_.sure ? BeliefStatus::tracking : BeliefStatus::ambiguous;
  if (belief_.status != BeliefStatus::ambiguous) return;
  double sum = 0.0;
  for (const Hypothesis& hypothesis : hypotheses_) sum += std::exp(hypothesis.log_weight);
  for (Hypothesis hypothesis : hypotheses_)
    for (int half = 0; half < 2; ++half) {
      if (hypothesis.own_weight() > kForgottenWeight * sum)
        belief_.hypotheses.push_back(
            {hypothesis.pose, hypothesis.covariance, hypothesis.own_weight() / sum});
      hypothesis.half_turn();
    }
  std::stable_sort(belief_.hypotheses.begin(), belief_.hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
}

}  // namespace vigia::localization
