#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/pose.hpp"

namespace vigia {

/// What the robot stands on: lifts a planar pose, in plan coordinates, into the world. Flat at
/// z = 0, or one plane in space.
class Ground {
 public:
  Ground() = default;
  /// A plane: plan coordinates (x, y) are those of frame g, its z the plane's normal.
  explicit Ground(const Eigen::Isometry3d& wMg) : wMg_(wMg) {}

  /// wMr of a robot whose wheels stand there.
  Eigen::Isometry3d place(const Pose2& pose) const {
    return wMg_ ? *wMg_ * to_isometry(pose) : to_isometry(pose);
  }
  /// ∂place/∂(x, y, θ) as (δp, δφ) in world axes: p + δp, Exp(δφ) · R.
  Eigen::Matrix<double, 6, 3> dplace_dpose(const Pose2& pose) const;
  /// Plan coordinates of a point of the world, its height above the ground the third.
  Eigen::Vector3d in_plan(const Eigen::Vector3d& p_w) const {
    return wMg_ ? Eigen::Vector3d(wMg_->inverse() * p_w) : p_w;
  }
  /// Whether plan and world coordinates are the same.
  bool flat() const { return !wMg_; }

 private:
  std::optional<Eigen::Isometry3d> wMg_;
};

}  // namespace vigia
