#include "vigia/localization/flow_fed_localizer.hpp"

#include <utility>

#include "vigia/localization/motion.hpp"
#include "vigia/localization/motion_fusion.hpp"

namespace vigia::localization {

std::optional<OdometryIncrement> joined_with_flow(const std::vector<OdometryIncrement>& parts,
                                                  const ImageShift& shift,
                                                  const CeilingCamera& camera,
                                                  const CeilingFilterParams& params,
                                                  FlowTrust& trust) {
  const double tilt = params.tilt_sigma * params.tilt_sigma;
  const double height = params.height_sigma * params.height_sigma;
  FlowMotion seen = flow_motion(camera, shift, {}, 2.0 * tilt, params.flow_floor);
  const Eigen::Vector3d errors(tilt, tilt, height);
  const OdometryIncrement read = joined(parts);
  const bool trusted =
      trust.holds(read, params.odometry, seen, errors.asDiagonal().toDenseMatrix(), params.gate);
  seen.covariance += seen.derrors * errors.asDiagonal() * seen.derrors.transpose();
  const auto fused = fuse_motions(read, params.odometry, seen, params.gate);
  if (!trusted || !fused) return std::nullopt;
  return as_increment(*fused, read);
}

FlowFedLocalizer::FlowFedLocalizer(std::unique_ptr<Localizer> fed, const CeilingCamera& camera,
                                   const CeilingFilterParams& params)
    : fed_(std::move(fed)), camera_(camera), params_(params) {
  refresh_belief();
}

void FlowFedLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  waiting_.clear();
  trust_ = {};
  fed_->reset(stamp, prior);
  refresh_belief();
}

void FlowFedLocalizer::predict(const OdometryIncrement& increment) {
  waiting_.push_back(increment);
  pass_until(increment.to - longest_wait());
  refresh_belief();
}

UpdateResult FlowFedLocalizer::update(const Observation& observation) {
  UpdateResult result;
  if (const auto* flow = std::get_if<FlowObservation>(&observation)) {
    result = follow(*flow);
  } else {
    pass_until(shot_of(observation).stamp);
    result = fed_->update(observation);
  }
  refresh_belief();
  return result;
}

void FlowFedLocalizer::lose() {
  fed_->lose();
  refresh_belief();
}

/// The increments that wait, up to a time that may lie within one.
std::vector<OdometryIncrement> FlowFedLocalizer::take_until(Stamp stamp) {
  std::vector<OdometryIncrement> taken;
  std::vector<OdometryIncrement> rest;
  for (OdometryIncrement& u : waiting_) {
    if (u.to <= stamp) {
      taken.push_back(u);
    } else if (u.from < stamp) {
      const double share = (stamp - u.from).seconds() / (u.to - u.from).seconds();
      taken.push_back(first_part(u, share));
      taken.back().to = stamp;
      rest.push_back(second_part(u, share));
      rest.back().from = stamp;
    } else {
      rest.push_back(u);
    }
  }
  waiting_ = std::move(rest);
  return taken;
}

void FlowFedLocalizer::pass_until(Stamp stamp) {
  for (const OdometryIncrement& u : take_until(stamp)) fed_->predict(u);
}

UpdateResult FlowFedLocalizer::follow(const FlowObservation& flow) {
  UpdateResult result;
  pass_until(flow.from);
  const bool whole = !waiting_.empty() && waiting_.front().from == flow.from &&
                     flow.shot.stamp <= waiting_.back().to;
  if (!whole) {
    result.status = UpdateStatus::too_late;
    return result;
  }
  const std::vector<OdometryIncrement> parts = take_until(flow.shot.stamp);
  result.dof = 3;
  if (const auto increment = joined_with_flow(parts, flow.shift, camera_, params_, trust_)) {
    fed_->predict(*increment);
    result.status = UpdateStatus::fused;
    return result;
  }
  for (const OdometryIncrement& u : parts) fed_->predict(u);
  result.status = UpdateStatus::gated;
  return result;
}

void FlowFedLocalizer::refresh_belief() {
  belief_ = fed_->belief();
  for (const OdometryIncrement& u : waiting_) {
    const Eigen::Matrix3d F = move_jacobian_pose(belief_.pose, u);
    const Eigen::Matrix3d G = move_jacobian_control(belief_.pose, u);
    belief_.covariance = F * belief_.covariance * F.transpose() +
                         G * control_covariance(u, params_.odometry) * G.transpose();
    belief_.pose = move(belief_.pose, u);
    for (PoseHypothesis& hypothesis : belief_.hypotheses)
      hypothesis.pose = move(hypothesis.pose, u);
    belief_.stamp = u.to;
    belief_.in_space.reset();
  }
}

}  // namespace vigia::localization
