#include "vigia/localization/view_parameters.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia::localization {
namespace {

/// cRe: Adán's camera axes are ours turned by 180° about the optical axis.
const Eigen::Vector3d kCameraAxes(-1.0, -1.0, 1.0);

/// WRl: X_w = −x, Y_w = z, Z_w = y.
Eigen::Matrix3d world_from_landmark() {
  Eigen::Matrix3d WRl;
  WRl << -1, 0, 0, 0, 0, 1, 0, 1, 0;
  return WRl;
}

/// Adán eq. 15, mended.
Eigen::Matrix3d unswung(double phi, double theta) {
  const double cp = std::cos(phi);
  const double sp = std::sin(phi);
  const double ct = std::cos(theta);
  const double st = std::sin(theta);
  Eigen::Matrix3d eRW;
  eRW << ct, 0.0, -st, cp * st, sp, cp * ct, sp * st, -cp, sp * ct;
  return eRW;
}

Eigen::Matrix3d swing(double psi) {
  return Eigen::AngleAxisd(psi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

Eigen::Isometry3d pose_of(const ViewParameters& view) {
  Eigen::Isometry3d cMl = Eigen::Isometry3d::Identity();
  cMl.linear() = kCameraAxes.asDiagonal() * swing(view.psi) * unswung(view.phi, view.theta) *
                 world_from_landmark();
  cMl.translation().z() = view.distance;
  return cMl;
}

ViewParameters view_of(const Eigen::Isometry3d& cMl) {
  const Eigen::Matrix3d vRl = sight_rotation(cMl.translation()) * cMl.linear();
  const Eigen::Matrix3d eRW = kCameraAxes.asDiagonal() * vRl * world_from_landmark().transpose();
  ViewParameters view;
  const double sine = std::hypot(eRW(2, 0), eRW(2, 2));
  view.phi = std::atan2(sine, -eRW(2, 1));
  view.theta = sine > 0.0 ? std::atan2(eRW(2, 0), eRW(2, 2)) : 0.0;
  // ψ from all of Rz(ψ) = eRW · unswungᵀ, well defined for frontal views too.
  const Eigen::Matrix3d Rz = eRW * unswung(view.phi, view.theta).transpose();
  view.psi = std::atan2(Rz(1, 0) - Rz(0, 1), Rz(0, 0) + Rz(1, 1));
  view.distance = cMl.translation().norm();
  return view;
}

ViewParameters twin_of(const ViewParameters& view) {
  return {view.phi, wrap_angle(view.theta + kPi), wrap_angle(view.psi + kPi), view.distance};
}

Eigen::Isometry3d twin_of(const Eigen::Isometry3d& cMl) {
  Eigen::Isometry3d twin = cMl;
  twin.linear() =
      sight_rotation(cMl.translation()).transpose() * pose_of(twin_of(view_of(cMl))).linear();
  return twin;
}

Eigen::Matrix3d sight_rotation(const Eigen::Vector3d& p_c) {
  return Eigen::Quaterniond::FromTwoVectors(p_c, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

CentredImage centre_image(const Intrinsics& intrinsics, const Eigen::Vector2d& centre,
                          const std::vector<Eigen::Vector2d>& uv) {
  CentredImage image;
  image.vRc = sight_rotation(unproject(intrinsics, centre).homogeneous());
  std::transform(uv.begin(), uv.end(), std::back_inserter(image.points),
                 [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
                   const Eigen::Vector3d ray =
                       image.vRc * unproject(intrinsics, pixel).homogeneous();
                   return ray.hnormalized();
                 });
  return image;
}

}  // namespace vigia::localization
