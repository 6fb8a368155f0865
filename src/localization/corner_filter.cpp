#include "vigia/localization/corner_filter.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "vigia/core/angle.hpp"

namespace vigia::localization {
namespace {

constexpr double kCornerAtRest = 1e-7;

double ideal_column(const Intrinsics& lens, const StereoPair& pair, const Eigen::Vector2d& uv) {
  return pair.u0 + pair.focal_px * unproject(lens, uv).x();
}

}  // namespace

StereoColumns ideal_columns(const CornerFilterParams& params, const StereoCorner& corner) {
  return {ideal_column(params.lens, params.pair, corner.left_uv),
          ideal_column(params.lens, params.pair, corner.right_uv)};
}

CornerFilter::CornerFilter(const FieldMap& field, const CornerFilterParams& params)
    : field_(field), params_(params) {
  reset({}, anywhere());
}

void CornerFilter::reset(Stamp stamp, const Prior& prior) {
  Vector6 mean = Vector6::Zero();
  mean.head<3>() = prior.pose.vector();
  Matrix6 covariance = Matrix6::Zero();
  covariance.topLeftCorner<3, 3>() = prior.covariance;
  covariance.diagonal().tail<3>() = params_.calibration_sigma.vector().cwiseAbs2();
  reset(stamp, mean, covariance);
}

void CornerFilter::reset(Stamp stamp, const Vector6& mean, const Matrix6& covariance) {
  x_ = mean;
  P_ = covariance;
  refresh_belief(stamp);
}

void CornerFilter::relinearise(const Pose2& pose) {
  x_.setZero();
  x_.head<3>() = pose.vector();
  refresh_belief(belief_.stamp);
}

void CornerFilter::predict(const OdometryIncrement& u) {
  const Pose2 from = Pose2::from_vector(x_.head<3>());
  Matrix6 F = Matrix6::Identity();
  F.topLeftCorner<3, 3>() = move_jacobian_pose(from, u);
  const Eigen::Matrix3d G = move_jacobian_control(from, u);
  x_.head<3>() = move(from, u).vector();
  const Matrix6 moved = F * P_ * F.transpose();
  P_ = 0.5 * (moved + moved.transpose());
  P_.topLeftCorner<3, 3>() += G * control_covariance(u, params_.odometry) * G.transpose();
  refresh_belief(u.to);
}

/// y = seen − h(x) and H = ∂h/∂x; nothing where the corner is behind the cameras or of no goal.
std::optional<CornerFilter::Rows> CornerFilter::rows_at(const StereoCorner& corner,
                                                        const Vector6& x) const {
  const auto place = goal_corner_place(field_, corner.corner);
  if (!place) return std::nullopt;
  const Eigen::Matrix2d rRw = Eigen::Rotation2Dd(-x[2]).toRotationMatrix();
  const Eigen::Vector2d p_r = rRw * (*place - x.head<2>());
  const auto image = stereo_image(params_.pair, {x[3], x[4], x[5]}, p_r);
  if (!image) return std::nullopt;
  Rows rows;
  rows.y = ideal_columns(params_, corner).vector() - image->columns;
  Eigen::Matrix<double, 2, 3> dp_r;
  dp_r << -rRw, Eigen::Vector2d(p_r.y(), -p_r.x());
  rows.H << image->dcolumns_dp * dp_r, image->dcolumns_derrors;
  return rows;
}

bool CornerFilter::passes(const StereoCorner& corner) const {
  const auto rows = rows_at(corner, x_);
  if (!rows) return false;
  const Eigen::Matrix2d S = rows->H * P_ * rows->H.transpose() + corner.covariance;
  return rows->y.dot(S.ldlt().solve(rows->y)) <= params_.gate;
}

CornerUpdate CornerFilter::update(const std::vector<StereoCorner>& corners) {
  CornerUpdate result;
  std::vector<StereoCorner> fused;
  for (const StereoCorner& corner : corners) {
    if (passes(corner))
      fused.push_back(corner);
    else
      ++result.gated;
  }
  if (fused.empty()) return result;
  const auto count = 2 * static_cast<Eigen::Index>(fused.size());
  Eigen::VectorXd y(count);
  Eigen::MatrixXd H(count, 6);
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(count, count);
  Vector6 at = x_;
  Eigen::MatrixXd K;
  for (int i = 0; i < params_.iterations; ++i) {
    for (std::size_t k = 0; k < fused.size(); ++k) {
      const auto row = 2 * static_cast<Eigen::Index>(k);
      const auto rows = rows_at(fused[k], at);
      if (!rows) return result;
      y.segment<2>(row) = rows->y;
      H.middleRows<2>(row) = rows->H;
      R.block<2, 2>(row, row) = fused[k].covariance;
    }
    Vector6 off = at - x_;
    off[2] = wrap_angle(off[2]);
    const Eigen::VectorXd innovation = y + H * off;
    const Eigen::MatrixXd S = H * P_ * H.transpose() + R;
    const Eigen::LDLT<Eigen::MatrixXd> solver(S);
    if (i == 0) result.nis = innovation.dot(solver.solve(innovation));
    K = solver.solve(H * P_).transpose();
    Vector6 next = x_ + K * innovation;
    next[2] = wrap_angle(next[2]);
    Vector6 step = next - at;
    step[2] = wrap_angle(step[2]);
    at = next;
    if (step.norm() < kCornerAtRest) break;
  }
  x_ = at;
  const Matrix6 A = Matrix6::Identity() - K * H;
  const Matrix6 updated = A * P_ * A.transpose() + K * R * K.transpose();
  P_ = 0.5 * (updated + updated.transpose());
  result.fused = static_cast<int>(fused.size());
  refresh_belief(belief_.stamp);
  return result;
}

void CornerFilter::refresh_belief(Stamp stamp) {
  belief_ = {};
  belief_.stamp = stamp;
  belief_.pose = Pose2::from_vector(x_.head<3>());
  belief_.covariance = P_.topLeftCorner<3, 3>();
}

}  // namespace vigia::localization
