#include "vigia/localization/points_pose.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "vigia/localization/view_parameters.hpp"

namespace vigia::localization {
namespace {

constexpr int kMinPoints = 4;
/// Two minima nearer than this (m, rad) are one.
constexpr double kSameMinimum = 1e-5;
/// Smallest share of the spread that points off a line have across it.
constexpr double kThin = 1e-6;

/// Maps points to mean 0 and mean distance 1.
Eigen::Matrix3d conditioner(const std::vector<Eigen::Vector2d>& points) {
  const auto count = static_cast<double>(points.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p / count;
  double distance = 0.0;
  for (const Eigen::Vector2d& p : points) distance += (p - mean).norm() / count;
  const double s = 1.0 / std::max(distance, 1e-12);
  Eigen::Matrix3d T;
  T << s, 0.0, -s * mean.x(), 0.0, s, -s * mean.y(), 0.0, 0.0, 1.0;
  return T;
}

bool on_a_line(const std::vector<Eigen::Vector2d>& points) {
  const Eigen::Matrix3d T = conditioner(points);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d q = (T * p.homogeneous()).head<2>();
    spread += q * q.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(spread);
  return !(axes.eigenvalues()(0) > kThin * axes.eigenvalues()(1));
}

/// H with image ~ H · plane, by the direct linear transform in conditioned coordinates.
Eigen::Matrix3d homography(const std::vector<Eigen::Vector2d>& plane,
                           const std::vector<Eigen::Vector2d>& image) {
  const Eigen::Matrix3d Tp = conditioner(plane);
  const Eigen::Matrix3d Ti = conditioner(image);
  Eigen::Matrix<double, 9, 9> A = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const Eigen::Vector3d X = Tp * plane[i].homogeneous();
    const Eigen::Vector3d x = Ti * image[i].homogeneous();
    Eigen::Matrix<double, 2, 9> rows = Eigen::Matrix<double, 2, 9>::Zero();
    rows.block<1, 3>(0, 0) = X.transpose();
    rows.block<1, 3>(0, 6) = -x.x() * X.transpose();
    rows.block<1, 3>(1, 3) = X.transpose();
    rows.block<1, 3>(1, 6) = -x.y() * X.transpose();
    A += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(A);
  const Eigen::Matrix<double, 9, 1> h = solver.eigenvectors().col(0);
  Eigen::Matrix3d H;
  H << h.segment<3>(0).transpose(), h.segment<3>(3).transpose(), h.segment<3>(6).transpose();
  return Ti.inverse() * H * Tp;
}

/// The pose of the plane z = 0 whose homography is nearest to H.
std::optional<Eigen::Isometry3d> pose_from_homography(Eigen::Matrix3d H) {
  if (H(2, 2) < 0.0) H = -H;
  H /= 0.5 * (H.col(0).norm() + H.col(1).norm());
  Eigen::Matrix3d axes;
  axes << H.col(0), H.col(1), H.col(0).cross(H.col(1));
  if (!axes.allFinite() || !(H(2, 2) > 0.0)) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d cMl = Eigen::Isometry3d::Identity();
  cMl.linear() = svd.matrixU() * svd.matrixV().transpose();
  cMl.translation() = H.col(2);
  if (cMl.linear().determinant() < 0.0) return std::nullopt;
  return cMl;
}

std::optional<Eigen::Isometry3d> start_pose(const std::vector<SeenPoint>& points,
                                            const Intrinsics& intrinsics) {
  std::vector<Eigen::Vector2d> plane;
  std::vector<Eigen::Vector2d> image;
  for (const SeenPoint& seen : points) {
    plane.push_back(seen.point.centre_l);
    image.push_back(unproject(intrinsics, seen.uv));
  }
  if (on_a_line(plane) || on_a_line(image)) return std::nullopt;
  return pose_from_homography(homography(plane, image));
}

bool same(const FittedPose& a, const FittedPose& b) {
  return move_between(a.cMl, b.cMl).cwiseAbs().maxCoeff() < kSameMinimum;
}

void describe(const PointsFit& fit, std::size_t points, FittedPose& pose) {
  const PoseMatrix A = fit.information.topLeftCorner<6, 6>();
  const Eigen::LDLT<PoseMatrix> factor(A);
  pose.covariance = factor.solve(PoseMatrix::Identity());
  pose.covariance = 0.5 * (pose.covariance + pose.covariance.transpose()).eval();
  pose.dpose_dlog_focal = -factor.solve(fit.information.topRightCorner<6, 1>());
  pose.chi2 = fit.chi2;
  pose.dof = 2 * static_cast<int>(points) - 6;
}

}  // namespace

std::optional<FittedPose> refine_pose(const std::vector<SeenPoint>& points,
                                      const Intrinsics& intrinsics, const Eigen::Isometry3d& start,
                                      const PointsPoseParams& params) {
  FittedPose pose;
  pose.cMl = start;
  auto fit = fit_points(points, intrinsics, start);
  if (!fit) return std::nullopt;
  double damping = 1e-6;
  for (pose.iterations = 1; pose.iterations <= params.iterations; ++pose.iterations) {
    PoseMatrix A = fit->information.topLeftCorner<6, 6>();
    A.diagonal() *= 1.0 + damping;
    const PoseVector step = A.ldlt().solve(fit->gradient.head<6>());
    if (!step.allFinite()) return std::nullopt;
    const Eigen::Isometry3d next = moved(pose.cMl, step);
    const auto there = fit_points(points, intrinsics, next);
    const bool small = step.cwiseAbs().maxCoeff() < params.converged;
    if (there && there->chi2 <= fit->chi2) {
      pose.cMl = next;
      fit = there;
      damping *= 0.1;
    } else {
      damping *= 10.0;
    }
    if (!small) continue;
    describe(*fit, points.size(), pose);
    return pose;
  }
  return std::nullopt;
}

PointsPose solve_points(const std::vector<SeenPoint>& points, const Intrinsics& intrinsics,
                        const PointsPoseParams& params) {
  PointsPose result;
  if (points.size() < kMinPoints) return result;
  const auto start = start_pose(points, intrinsics);
  result.status = PointsPoseStatus::degenerate;
  if (!start) return result;
  auto best = refine_pose(points, intrinsics, *start, params);
  auto other = refine_pose(points, intrinsics, twin_of(best ? best->cMl : *start), params);
  result.status = PointsPoseStatus::not_converged;
  if (!best) std::swap(best, other);
  if (!best || !best->covariance.allFinite()) return result;
  if (other && same(*best, *other)) other.reset();
  if (other && other->chi2 < best->chi2) std::swap(best, other);
  result.pose = *best;
  result.twin = other;
  const bool as_good = other && other->chi2 - best->chi2 < 2.0 * std::log(params.ambiguity_ratio);
  result.status = as_good ? PointsPoseStatus::ambiguous : PointsPoseStatus::solved;
  result.phi = view_of(best->cMl).phi;
  result.frontal = result.phi < params.frontal_below;
  return result;
}

}  // namespace vigia::localization
