#include "vigia/localization/disc_pose.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "vigia/core/angle.hpp"
#include "vigia/localization/disc_model.hpp"

namespace vigia::localization {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

const double kUniformTurn = kPi * kPi / 3.0;   // variance of an angle, uniform over a turn
const double kUniformTilt = kPi * kPi / 12.0;  // over half a turn

Eigen::Matrix2d shape_matrix(const Ellipse& e) {
  const Eigen::Rotation2Dd turn(e.psi);
  return turn.toRotationMatrix() * Eigen::Vector2d(e.a * e.a, e.b * e.b).asDiagonal() *
         turn.toRotationMatrix().transpose();
}

/// An ellipse beside a seen one, in px: centre, along the seen axes a and b, and across them, which
/// is (a − b)·dψ and, unlike ψ, regular for a circle.
Vector5 offset(const Ellipse& predicted, const Ellipse& seen) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(seen.psi).toRotationMatrix();
  const Eigen::Matrix2d sigma = turn.transpose() * shape_matrix(predicted) * turn;
  Vector5 out;
  out << predicted.u - seen.u, predicted.v - seen.v,
      (sigma(0, 0) - seen.a * seen.a) / (2.0 * seen.a),
      (sigma(1, 1) - seen.b * seen.b) / (2.0 * seen.b), sigma(0, 1) / (seen.a + seen.b);
  return out;
}

/// The covariance of offset(), from that of (u, v, a, b, ψ). Of axes that are not told apart, a ≈ b
/// within what var(a − b) lets expect, ψ says nothing: a circle's outline r + A cos 2θ + B sin 2θ
/// has a − b = 2A, and B, which is across, as uncertain as A.
Matrix5 offset_covariance(const Ellipse& e, const Matrix5& covariance) {
  constexpr double kKnown = 0.5;  // of a uniform angle's variance
  const double psi = covariance(4, 4);
  const double apart = std::pow(e.a - e.b, 2);
  const double alike = covariance(2, 2) + covariance(3, 3) - 2.0 * covariance(2, 3);
  Matrix5 out = covariance;
  if (psi < kKnown * kUniformTilt) {
    const double scale = std::sqrt(apart / (1.0 - psi / kUniformTilt));
    out.row(4) *= scale;
    out.col(4) *= scale;
    out(4, 4) += 0.25 * alike * std::exp(-0.5 * apart / alike);
  } else {
    out.row(4).setZero();
    out.col(4).setZero();
    out(4, 4) = 0.25 * alike;
  }
  return out;
}

/// The cone through the ellipse, xᵀQx = 0 in normalised undistorted coordinates; the lens is taken
/// as linear over the ellipse.
Eigen::Matrix3d cone_of(const Ellipse& e, const Intrinsics& intrinsics) {
  const Eigen::Vector2d uv(e.u, e.v);
  const Eigen::Vector2d c = unproject(intrinsics, uv);
  const Eigen::Matrix2d duv_dxy = distort_jacobian(intrinsics, uv);
  const Eigen::Matrix2d A = duv_dxy.transpose() * shape_matrix(e).inverse() * duv_dxy;
  Eigen::Matrix3d Q;
  Q.topLeftCorner<2, 2>() = A;
  Q.topRightCorner<2, 1>() = -A * c;
  Q.bottomLeftCorner<1, 2>() = (-A * c).transpose();
  Q(2, 2) = c.dot(A * c) - 1.0;
  return Q;
}

/// Frame l with its centre and normal; x is chosen to lie in the camera's horizontal plane.
Eigen::Isometry3d frame_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal) {
  Eigen::Isometry3d cMl = Eigen::Isometry3d::Identity();
  Eigen::Vector3d x = (-Eigen::Vector3d::UnitY()).cross(normal);
  if (x.norm() < 1e-6) x = Eigen::Vector3d::UnitX();
  x.normalize();
  cMl.linear() << x, normal.cross(x), normal;
  cMl.translation() = centre;
  return cMl;
}

// Chen et al. eqs. 17–20: with eigenvalues λ₁ ≥ λ₂ > 0 > λ₃ of the cone the circle's plane has the
// normal (±√(λ₁−λ₂), 0, √(λ₂−λ₃))/√(λ₁−λ₃) along the eigenvectors.
std::vector<Eigen::Isometry3d> circular_sections(const Eigen::Matrix3d& cone, double radius) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(cone);
  const double l1 = solver.eigenvalues()[2];
  const double l2 = solver.eigenvalues()[1];
  const double l3 = solver.eigenvalues()[0];
  if (!(l3 < 0.0 && l2 > 0.0)) return {};
  Eigen::Matrix3d axes;
  axes << solver.eigenvectors().col(2), solver.eigenvectors().col(1), solver.eigenvectors().col(0);
  const double g = std::sqrt((l2 - l3) / (l1 - l3));
  const double h = std::sqrt(std::max(0.0, l1 - l2) / (l1 - l3));
  const double distance = l2 * radius / std::sqrt(-l1 * l3);
  std::vector<Eigen::Isometry3d> poses;
  for (const double side : {1.0, -1.0}) {
    Eigen::Vector3d centre =
        distance * axes * Eigen::Vector3d(side * h * l3 / l2, 0.0, -g * l1 / l2);
    Eigen::Vector3d normal = axes * Eigen::Vector3d(side * h, 0.0, -g);
    if (centre.z() < 0.0) centre = -centre;
    if (normal.dot(centre) > 0.0) normal = -normal;
    poses.push_back(frame_at(centre, normal));
  }
  return poses;
}

/// δ of (v, ω_x, ω_y) in the disc's own axes for the turn.
PoseVector pose_step(const Eigen::Isometry3d& cMl, const Vector5& step) {
  PoseVector delta;
  delta << step.head<3>(), cMl.linear().leftCols<2>() * step.tail<2>();
  return delta;
}

class DiscFit {
 public:
  DiscFit(const Ellipse& seen, const Matrix5& covariance, double radius,
          const Intrinsics& intrinsics)
      : seen_(seen),
        information_(offset_covariance(seen, covariance).inverse()),
        radius_(radius),
        intrinsics_(intrinsics) {}

  std::optional<DiscPose> polish(Eigen::Isometry3d cMl) const {
    constexpr int kSteps = 8;
    auto here = misfit(cMl);
    for (int k = 0; here && k < kSteps; ++k) {
      const auto normal = information_at(cMl);
      if (!normal) return std::nullopt;
      const Vector5 step =
          normal->matrix.ldlt().solve(-normal->jacobian.transpose() * information_ * *here);
      const Eigen::Isometry3d next = moved(cMl, pose_step(cMl, step));
      const auto there = misfit(next);
      if (!there || cost(*there) >= cost(*here)) break;
      cMl = next;
      here = there;
    }
    const auto normal = here ? information_at(cMl) : std::nullopt;
    if (!normal) return std::nullopt;
    const Matrix5 small = normal->matrix.inverse();
    Eigen::Matrix<double, 6, 5> spread = Eigen::Matrix<double, 6, 5>::Zero();
    spread.topLeftCorner<3, 3>().setIdentity();
    spread.bottomRightCorner<3, 2>() = cMl.linear().leftCols<2>();
    DiscPose out{cMl, spread * small * spread.transpose(), here->norm()};
    const Eigen::Vector3d n = cMl.linear().col(2);
    out.covariance.bottomRightCorner<3, 3>() += kUniformTurn * n * n.transpose();
    if (!out.covariance.allFinite()) return std::nullopt;
    return out;
  }

 private:
  struct Normal {
    Eigen::Matrix<double, 5, 5> jacobian;
    Matrix5 matrix;
  };

  std::optional<Vector5> misfit(const Eigen::Isometry3d& cMl) const {
    Landmark disc;
    disc.wMl = cMl;
    disc.shape = DiscShape{radius_};
    const auto image = disc_image(disc, intrinsics_, Eigen::Isometry3d::Identity());
    if (!image) return std::nullopt;
    return offset(*image, seen_);
  }
  double cost(const Vector5& off) const { return off.dot(information_ * off); }

  // By central differences; with what is known of a tilt before anything is seen.
  std::optional<Normal> information_at(const Eigen::Isometry3d& cMl) const {
    Normal out;
    for (int i = 0; i < 5; ++i) {
      const double h = i < 3 ? 1e-5 * cMl.translation().norm() : 1e-4;
      const Vector5 step = h * Vector5::Unit(i);
      const auto ahead = misfit(moved(cMl, pose_step(cMl, step)));
      const auto back = misfit(moved(cMl, pose_step(cMl, -step)));
      if (!ahead || !back) return std::nullopt;
      out.jacobian.col(i) = (*ahead - *back) / (2.0 * h);
    }
    out.matrix = out.jacobian.transpose() * information_ * out.jacobian;
    out.matrix.bottomRightCorner<2, 2>() += Eigen::Matrix2d::Identity() / kUniformTilt;
    return out;
  }

  Ellipse seen_;
  Matrix5 information_;
  double radius_;
  Intrinsics intrinsics_;
};

}  // namespace

std::vector<DiscPose> disc_poses(const Ellipse& ellipse, const Matrix5& covariance, double radius_m,
                                 const Intrinsics& intrinsics) {
  const DiscFit fit(ellipse, covariance, radius_m, intrinsics);
  std::vector<DiscPose> poses;
  for (const Eigen::Isometry3d& start : circular_sections(cone_of(ellipse, intrinsics), radius_m))
    if (const auto pose = fit.polish(start)) poses.push_back(*pose);
  constexpr double kSame = 1e-3;  // of the normals
  if (poses.size() == 2) {
    if (poses[1].misfit_px < 0.99 * poses[0].misfit_px) std::swap(poses[0], poses[1]);
    const Eigen::Vector3d n0 = poses[0].cMl.linear().col(2);
    if ((n0 - poses[1].cMl.linear().col(2)).norm() < kSame) poses.pop_back();
  }
  return poses;
}

}  // namespace vigia::localization
