#include "ring_fix.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/sector.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kFixGate = 3.5;       // σ beyond which an echo is no face's
constexpr double kFixTempering = 2.0;  // a reading's σ counts so many times: scans share errors
constexpr int kFixScans = 10;          // before its word counts
constexpr double kFixMemory = 0.1;     // share of the latest scan in the agreement
constexpr double kFixAgrees = 0.65;    // of the echoes that can be compared
constexpr double kFixShort = 0.25;     // of an echo that comes too early: people stand before walls
// Of a belief, so that walls can correct it.
constexpr double kFixMinSigma_m = 0.02;
constexpr double kFixMinSigma_rad = from_deg(0.5);
/// Wheels that are worse than most: what they do is corrected within a second.
const OdometryNoise kFixOdometry{0.03, from_deg(1.0), from_deg(1.0)};

/// The distance of a beam and how it changes with the pose, where it changes smoothly.
struct BeamModel {
  double range_m = 0.0;
  Eigen::RowVector3d drange_dpose = Eigen::RowVector3d::Zero();
};

/// Where a base at @p base has the nearest face in a beam.
std::optional<double> nearest_in_beam(const FloorPlan& plan, const Pose2& base, double bearing,
                                      double half_angle, double reach_m) {
  const Sector beam = Sector::about(base.theta + bearing, half_angle);
  return nearest_face(plan, base.position(), beam, reach_m, 0.0);
}

/// Nothing where a face enters or leaves the cone within @p sigmas of (x, y, θ): there the range
/// jumps.
std::optional<BeamModel> beam_model(const FloorPlan& plan, const Pose2& base, double bearing,
                                    double half_angle, double reach_m,
                                    const Eigen::Vector3d& sigmas, double range_sigma_m) {
  const auto here = nearest_in_beam(plan, base, bearing, half_angle, reach_m);
  if (!here) return std::nullopt;
  BeamModel model{*here, {}};
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    step[i] = 2.0 * sigmas[i];
    const Pose2 more{base.x + step.x(), base.y + step.y(), base.theta + step.z()};
    const Pose2 less{base.x - step.x(), base.y - step.y(), base.theta - step.z()};
    const auto ahead = nearest_in_beam(plan, more, bearing, half_angle, reach_m);
    const auto behind = nearest_in_beam(plan, less, bearing, half_angle, reach_m);
    if (!ahead || !behind) return std::nullopt;
    if (std::abs(*ahead + *behind - 2.0 * *here) > range_sigma_m) return std::nullopt;
    model.drange_dpose[i] = (*ahead - *behind) / (2.0 * step[i]);
  }
  return model;
}

}  // namespace

void RingFix::begin(const Belief& belief, double doubt) {
  pose_ = belief.pose;
  covariance_ = doubt * doubt * belief.covariance;
  for (int i = 0; i < 3; ++i) {
    const double least = i < 2 ? kFixMinSigma_m : kFixMinSigma_rad;
    covariance_(i, i) = std::max(covariance_(i, i), least * least);
  }
  scans_ = 0;
  agreement_ = 0.0;
}

void RingFix::predict(const OdometryIncrement& odometry) {
  const Eigen::Matrix3d F = move_jacobian_pose(pose_, odometry);
  const Eigen::Matrix3d G = move_jacobian_control(pose_, odometry);
  covariance_ = F * covariance_ * F.transpose() +
                G * control_covariance(odometry, kFixOdometry) * G.transpose();
  pose_ = move(pose_, odometry);
}

void RingFix::update(const RangeScan& scan) {
  double compared = 0.0;
  double agreed = 0.0;
  const double half_angle = from_deg(params_.half_angle_deg);
  for (const RangeReading& reading : scan.readings) {
    if (!reading.echo || reading.range_m > params_.horizon_m) continue;
    const double sigma =
        kFixTempering * std::hypot(params_.sigma_m, params_.sigma_relative * reading.range_m);
    const auto model = beam_model(*plan_, pose_, reading.bearing, half_angle, scan.reach_m,
                                  covariance_.diagonal().cwiseSqrt(), sigma);
    if (!model) continue;
    const Eigen::RowVector3d H = model->drange_dpose;
    const double innovation = reading.range_m - model->range_m;
    const double variance = (H * covariance_ * H.transpose())(0, 0) + sigma * sigma;
    if (innovation * innovation > kFixGate * kFixGate * variance) {
      compared += innovation < 0.0 ? kFixShort : 1.0;
      continue;
    }
    compared += 1.0;
    agreed += 1.0;
    const Eigen::Vector3d gain = covariance_ * H.transpose() / variance;
    const Eigen::Vector3d change = gain * innovation;
    pose_ = {pose_.x + change.x(), pose_.y + change.y(), wrap_angle(pose_.theta + change.z())};
    const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain * H;
    covariance_ = kept * covariance_ * kept.transpose() + gain * sigma * sigma * gain.transpose();
  }
  if (compared <= 0.0) return;
  const double share = agreed / compared;
  agreement_ = scans_ == 0 ? share : agreement_ + kFixMemory * (share - agreement_);
  ++scans_;
}

bool RingFix::agrees() const {
  return scans_ >= kFixScans && agreement_ >= kFixAgrees;
}

double RingFix::sigma_across(const Vector2d& direction) const {
  const Vector2d normal(-direction.y(), direction.x());
  return std::sqrt(normal.dot(covariance_.topLeftCorner<2, 2>() * normal));
}

}  // namespace vigia::pilot
