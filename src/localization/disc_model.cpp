#include "vigia/localization/disc_model.hpp"

#include "camera_twists.hpp"
#include "space_geometry.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace vigia::localization {
namespace {

/// A disc in the camera frame.
struct Disc {
  Eigen::Vector3d p_c;
  Eigen::Vector3d n_c;  ///< unit normal, towards the viewer
  double radius;
};

/// An ellipse {c + S^½ e, |e| = 1} of the image plane, or the derivative of one.
struct PlaneEllipse {
  Eigen::Vector2d c;
  Eigen::Matrix2d S;
  double log_size;  ///< ln √(ab) = ¼ ln det S
};

Eigen::Matrix2d outer(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a * b.transpose();
}

/// p_z² − R²(1 − n_z²): positive when the disc lies wholly in front of the camera.
double front_measure(const Disc& disc) {
  const double nz = disc.n_c.z();
  return disc.p_c.z() * disc.p_c.z() - disc.radius * disc.radius * (1.0 - nz * nz);
}

bool has_image(const Disc& disc) {
  return disc.p_c.z() > 0.0 && front_measure(disc) > 1e-9 &&
         -disc.n_c.dot(disc.p_c) > kEdgeOn * disc.p_c.norm();
}

/// The circle's dual conic R²(I − nnᵀ) − ppᵀ is that of its image; with the last entry scaled to −1
/// it reads [S − ccᵀ, −c; −cᵀ, −1]. Its determinant gives det S = R⁴ (n·p)² / q³.
PlaneEllipse perspective(const Disc& disc) {
  const double R2 = disc.radius * disc.radius;
  const double q = front_measure(disc);
  const Eigen::Vector2d p = disc.p_c.head<2>();
  const Eigen::Vector2d n = disc.n_c.head<2>();
  PlaneEllipse image;
  image.c = (disc.p_c.z() * p + R2 * disc.n_c.z() * n) / q;
  image.S = (R2 * (Eigen::Matrix2d::Identity() - outer(n, n)) - outer(p, p)) / q +
            outer(image.c, image.c);
  image.log_size =
      std::log(disc.radius) + 0.5 * std::log(-disc.n_c.dot(disc.p_c)) - 0.75 * std::log(q);
  return image;
}

/// Derivative of perspective() along (dp, dn).
PlaneEllipse perspective_tangent(const Disc& disc, const PlaneEllipse& image,
                                 const Eigen::Vector3d& dp_c, const Eigen::Vector3d& dn_c) {
  const double R2 = disc.radius * disc.radius;
  const double q = front_measure(disc);
  const double pz = disc.p_c.z();
  const double nz = disc.n_c.z();
  const Eigen::Vector2d p = disc.p_c.head<2>();
  const Eigen::Vector2d n = disc.n_c.head<2>();
  const Eigen::Vector2d dp = dp_c.head<2>();
  const Eigen::Vector2d dn = dn_c.head<2>();
  const double dq = 2.0 * pz * dp_c.z() + 2.0 * R2 * nz * dn_c.z();
  PlaneEllipse d;
  d.c = (dp_c.z() * p + pz * dp + R2 * (dn_c.z() * n + nz * dn) - dq * image.c) / q;
  const Eigen::Matrix2d inner = image.S - outer(image.c, image.c);
  const Eigen::Matrix2d half = -R2 * outer(n, dn) - outer(p, dp);
  d.S = (half + half.transpose() - dq * inner) / q + outer(image.c, d.c) + outer(d.c, image.c);
  const double np = disc.n_c.dot(disc.p_c);
  d.log_size = 0.5 * (dn_c.dot(disc.p_c) + disc.n_c.dot(dp_c)) / np - 0.75 * dq / q;
  return d;
}

/// The lens at one point, in distorted normalised coordinates y: undistorted = (1 + k|y|²) y.
struct Lens {
  double k;
  Eigen::Vector2d y;
  Eigen::Matrix2d J;  ///< ∂y/∂(undistorted)
};

std::optional<Lens> lens_at(const Intrinsics& intrinsics, const Eigen::Vector2d& xy) {
  const auto uv = distort(intrinsics, xy);
  if (!uv) return std::nullopt;
  const double k = intrinsics.kdu;
  const Eigen::Vector2d y((uv->x() - intrinsics.u0) / intrinsics.px,
                          (uv->y() - intrinsics.v0) / intrinsics.py);
  const Eigen::Matrix2d dxy_dy =
      (1.0 + k * y.squaredNorm()) * Eigen::Matrix2d::Identity() + 2.0 * k * outer(y, y);
  return Lens{k, y, dxy_dy.inverse()};
}

/// 10 T + tr(T) I, of the centre's second-order shift.
Eigen::Matrix2d bend(const Eigen::Matrix2d& T) {
  return 10.0 * T + T.trace() * Eigen::Matrix2d::Identity();
}

/// The ellipse through the lens: centre and shape by the lens's linear map at the centre, and the
/// curvature of the lens to first order in k: it moves the centroid by −k/4 (10 T + tr T) y (0.3 px
/// at kdu = 0.05, radius 60 px, 280 px off axis) and shrinks the area by the factor 1 − k tr T.
PlaneEllipse through_lens(const Lens& lens, const PlaneEllipse& image) {
  PlaneEllipse seen;
  const Eigen::Matrix2d T = lens.J * image.S * lens.J.transpose();
  const double shrink = -0.5 * lens.k * T.trace();
  seen.c = lens.y - 0.25 * lens.k * bend(T) * lens.y;
  seen.S = std::exp(2.0 * shrink) * T;
  seen.log_size = image.log_size + 0.5 * std::log(lens.J.determinant()) + shrink;
  return seen;
}

/// Derivative of centre and size of through_lens(); the shape's is not needed.
Eigen::Vector3d through_lens_tangent(const Lens& lens, const PlaneEllipse& image,
                                     const PlaneEllipse& d) {
  const Eigen::Matrix2d T = lens.J * image.S * lens.J.transpose();
  const Eigen::Vector2d dy = lens.J * d.c;
  const Eigen::Matrix2d dJinv =
      2.0 * lens.k *
      (lens.y.dot(dy) * Eigen::Matrix2d::Identity() + outer(dy, lens.y) + outer(lens.y, dy));
  const Eigen::Matrix2d half = -lens.J * dJinv * T;
  const Eigen::Matrix2d dT = half + half.transpose() + lens.J * d.S * lens.J.transpose();
  Eigen::Vector3d tangent;
  tangent << dy - 0.25 * lens.k * (bend(dT) * lens.y + bend(T) * dy),
      d.log_size - 0.5 * (lens.J * dJinv).trace() - 0.5 * lens.k * dT.trace();
  return tangent;
}

Disc in_camera(const Landmark& landmark, double radius, const Eigen::Isometry3d& wMc) {
  return {wMc.inverse() * landmark.centre_w(), wMc.linear().transpose() * landmark.normal_w(),
          radius};
}

Ellipse to_pixels(const Intrinsics& intrinsics, const PlaneEllipse& seen) {
  const Eigen::Vector2d scale(intrinsics.px, intrinsics.py);
  const Eigen::Matrix2d shape = scale.asDiagonal() * seen.S * scale.asDiagonal();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(shape);
  const Eigen::Vector2d major = axes.eigenvectors().col(1);
  double psi = std::atan2(major.y(), major.x());
  if (psi > 0.5 * kPi) psi -= kPi;
  if (psi <= -0.5 * kPi) psi += kPi;
  return {intrinsics.u0 + intrinsics.px * seen.c.x(), intrinsics.v0 + intrinsics.py * seen.c.y(),
          std::sqrt(axes.eigenvalues()(1)), std::sqrt(axes.eigenvalues()(0)), psi};
}

}  // namespace

std::optional<Ellipse> disc_image(const Landmark& landmark, const Intrinsics& intrinsics,
                                  const Eigen::Isometry3d& wMc) {
  const auto radius = disc_radius(landmark);
  if (!radius) return std::nullopt;
  const Disc disc = in_camera(landmark, *radius, wMc);
  if (!has_image(disc)) return std::nullopt;
  const PlaneEllipse image = perspective(disc);
  const auto lens = lens_at(intrinsics, image.c);
  if (!lens) return std::nullopt;
  return to_pixels(intrinsics, through_lens(*lens, image));
}

std::optional<DiscMeasurement> predict_disc(const Landmark& landmark, const Shot& shot,
                                            const RigOnGround& on_ground, const Pose2& pose,
                                            const LookBias& bias) {
  const auto radius = disc_radius(landmark);
  if (!radius) return std::nullopt;
  const HeadAngles head{shot.head.pan + bias.pan, shot.head.tilt + bias.tilt};
  const PlacedCamera placed(on_ground, shot.camera, head, pose);
  const Disc disc = in_camera(landmark, *radius, placed.wMc);
  if (!has_image(disc)) return std::nullopt;
  const PlaneEllipse image = perspective(disc);
  const auto lens = lens_at(pinhole(shot), image.c);
  if (!lens) return std::nullopt;
  const PlaneEllipse seen = through_lens(*lens, image);

  const double px = pinhole(shot).px * std::exp(bias.log_focal);
  const double py = pinhole(shot).py * std::exp(bias.log_focal);
  const Eigen::Vector3d scale(px, py, 1.0);
  const Eigen::Matrix<double, 6, 5> twists = camera_twists(on_ground, placed, pose);
  Eigen::Matrix<double, 3, 5> dz;
  for (Eigen::Index i = 0; i < 5; ++i) {
    const Eigen::Vector3d w_c = twists.col(i).tail<3>();
    const Eigen::Vector3d dp_c = -twists.col(i).head<3>() - w_c.cross(disc.p_c);
    const Eigen::Vector3d dn_c = -w_c.cross(disc.n_c);
    dz.col(i) = scale.cwiseProduct(
        through_lens_tangent(*lens, image, perspective_tangent(disc, image, dp_c, dn_c)));
  }
  const Eigen::Vector2d off_axis(px * seen.c.x(), py * seen.c.y());
  DiscMeasurement measurement;
  measurement.z << pinhole(shot).u0 + off_axis.x(), pinhole(shot).v0 + off_axis.y(),
      seen.log_size + 0.5 * std::log(px * py);
  measurement.dz_dpose = dz.leftCols<3>();
  measurement.dz_dbias << dz.rightCols<2>(), Eigen::Vector3d(off_axis.x(), off_axis.y(), 1.0);
  return measurement;
}

Eigen::Vector3d measured_disc(const EllipseObservation& observation) {
  const Ellipse& e = observation.ellipse;
  return {e.u, e.v, 0.5 * std::log(e.a * e.b)};
}

Eigen::Matrix3d measured_disc_covariance(const EllipseObservation& observation) {
  const Ellipse& e = observation.ellipse;
  Eigen::Matrix<double, 3, 5> dz = Eigen::Matrix<double, 3, 5>::Zero();
  dz(0, 0) = 1.0;
  dz(1, 1) = 1.0;
  dz(2, 2) = 0.5 / e.a;
  dz(2, 3) = 0.5 / e.b;
  return dz * observation.covariance * dz.transpose();
}

}  // namespace vigia::localization
