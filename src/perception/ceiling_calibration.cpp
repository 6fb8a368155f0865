#include "vigia/perception/ceiling_calibration.hpp"

#include <Eigen/Cholesky>

namespace vigia::perception {
namespace {

constexpr int kPasses = 2;  // after the first; a third changes none of five digits (eight drives)

}  // namespace

CeilingCalibration::CeilingCalibration(const CeilingView& view) : view_(view), follower_(view) {}

CeilingFollower::Step CeilingCalibration::next(const vpImage<unsigned char>& picture, Stamp stamp) {
  sights_.push_back(follower_.look(picture, stamp));
  return follower_.follow(sights_.back());
}

CeilingCalibration::Result CeilingCalibration::result() const {
  Result result{follower_.camera_errors(), follower_.camera_errors_covariance()};
  const Eigen::Vector3d prior_sigma(view_.tilt_sigma, view_.tilt_sigma, view_.height_sigma);
  if (!follower_.belief() || prior_sigma.minCoeff() <= 0.0) return result;
  const Eigen::Vector3d prior_information = prior_sigma.cwiseAbs2().cwiseInverse();
  for (int pass = 0; pass < kPasses; ++pass) {
    CeilingFollower again(view_, result.errors);
    for (const CeilingFollower::Sight& sight : sights_) again.follow(sight);
    // The pass took the last result for its prior's mean, which is 0: information about the same
    // three numbers adds up, so that what it drew towards that mean is known.
    const Eigen::Matrix3d P = again.camera_errors_covariance();
    const Eigen::Vector3d drawn = P * prior_information.cwiseProduct(result.errors.vector()).eval();
    result.errors =
        localization::CeilingCameraErrors::from_vector(again.camera_errors().vector() - drawn);
    result.covariance = P;
  }
  return result;
}

}  // namespace vigia::perception
