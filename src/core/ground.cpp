#include "vigia/core/ground.hpp"

namespace vigia {

Eigen::Matrix<double, 6, 3> Ground::dplace_dpose(const Pose2& /*pose*/) const {
  const Eigen::Matrix3d wRg = wMg_ ? Eigen::Matrix3d(wMg_->linear()) : Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 6, 3> jacobian = Eigen::Matrix<double, 6, 3>::Zero();
  jacobian.topLeftCorner<3, 2>() = wRg.leftCols<2>();
  jacobian.bottomRightCorner<3, 1>() = wRg.col(2);
  return jacobian;
}

}  // namespace vigia
