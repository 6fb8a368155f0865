#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/localization/murea.hpp"

namespace vigia::localization {
namespace {

constexpr double kUsualVotesGain = 0.05;
// The search is never narrower than this about an estimate: σ in m and rad.
constexpr double kSearch_m = 0.1;
constexpr double kSearchTurn = 0.05;

}  // namespace

MureaLocalizer::MureaLocalizer(const FieldModel& model, const MureaLocalizerParams& params)
    : params_(params), murea_(model, params.murea) {}

void MureaLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  estimate_ = prior;
  usual_.reset();
  fewer_votes_ = 0;
  since_global_ = 0;
  belief_ = Belief{};
  belief_.stamp = stamp;
  belief_.status = prior ? BeliefStatus::tracking : BeliefStatus::lost;
  belief_.lost_probability = prior ? 0.0 : 1.0;
  if (prior) {
    belief_.pose = prior->pose;
    belief_.covariance = prior->covariance;
  }
}

void MureaLocalizer::predict(const OdometryIncrement& increment) {
  belief_.stamp = increment.to;
  const Eigen::Matrix3d F = move_jacobian_pose(belief_.pose, increment);
  const Eigen::Matrix3d G = move_jacobian_control(belief_.pose, increment);
  belief_.covariance = F * belief_.covariance * F.transpose() +
                       G * control_covariance(increment, params_.odometry) * G.transpose();
  belief_.pose = move(belief_.pose, increment);
  if (estimate_) estimate_ = Prior{belief_.pose, belief_.covariance};
}

bool MureaLocalizer::votes_have_fallen(const MureaFix& fix, const FieldScan& scan) {
  const double votes =
      fix.votes / static_cast<double>(std::max<std::size_t>(1, scan.points.size()));
  const bool fewer = usual_ && votes < params_.usual_share * *usual_;
  fewer_votes_ = fewer ? fewer_votes_ + 1 : 0;
  if (!fewer) usual_ = usual_ ? *usual_ + kUsualVotesGain * (votes - *usual_) : votes;
  return fewer_votes_ >= params_.fewer_votes_in_a_row;
}

void MureaLocalizer::accept(const MureaFix& fix, bool global) {
  belief_.pose = fix.pose;
  belief_.covariance = fix.covariance;
  belief_.hypotheses.clear();
  belief_.lost_probability = 0.0;
  estimate_ = Prior{fix.pose, fix.covariance};
  if (!global) return;
  const bool ambiguous = fix.runner_up > params_.ambiguous_share * fix.votes;
  belief_.status = ambiguous ? BeliefStatus::ambiguous : BeliefStatus::tracking;
  if (!ambiguous) return;
  const double share = fix.votes / (fix.votes + fix.runner_up);
  belief_.hypotheses = {{fix.pose, fix.covariance, share},
                        {fix.second, fix.covariance, 1.0 - share}};
  belief_.lost_probability = 1.0 - share;
}

void MureaLocalizer::update(const FieldScan& scan) {
  belief_.stamp = scan.stamp;
  const bool unsure = !estimate_ || belief_.status != BeliefStatus::tracking;
  if (!unsure && ++since_global_ < params_.check_every) {
    Prior about = *estimate_;
    about.covariance +=
        Eigen::Vector3d(kSearch_m * kSearch_m, kSearch_m * kSearch_m, kSearchTurn * kSearchTurn)
            .asDiagonal();
    const MureaFix fix = murea_.locate(scan, about);
    if (fix.found && !votes_have_fallen(fix, scan)) {
      if (fewer_votes_ == 0) accept(fix, false);
      return;
    }
  }
  since_global_ = 0;
  fewer_votes_ = 0;
  usual_.reset();
  const MureaFix fix = murea_.locate(scan);
  if (fix.found) {
    accept(fix, true);
  } else {
    belief_.status = BeliefStatus::lost;
    belief_.lost_probability = 1.0;
  }
}

}  // namespace vigia::localization
