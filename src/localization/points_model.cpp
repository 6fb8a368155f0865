#include "vigia/localization/points_model.hpp"

#include "camera_twists.hpp"
#include "space_geometry.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace vigia::localization {
namespace {

/// Share of the greatest information below which a direction of the state is not measured. Rounding
/// leaves about as much, and some weak direction that points do measure is below 1e-11.
constexpr double kNothing = 1e-13;

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + skew(w);
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

/// Centre of a circle's perspective image in the normalised plane, and its derivatives.
struct CircleCentre {
  Eigen::Vector2d c;
  Eigen::Matrix<double, 2, 3> dc_dp;
  Eigen::Matrix<double, 2, 3> dc_dn;
  Eigen::Matrix2d S;  ///< the ellipse is {c + S^½ e, |e| = 1}
};

std::optional<CircleCentre> circle_centre(const Eigen::Vector3d& p, const Eigen::Vector3d& n,
                                          double radius) {
  const double R2 = radius * radius;
  const double q = p.z() * p.z() - R2 * (1.0 - n.z() * n.z());
  if (p.z() <= 1e-9 || q <= 1e-9 || -n.dot(p) <= kEdgeOn * p.norm()) return std::nullopt;
  CircleCentre image;
  image.c = (p.z() * p.head<2>() + R2 * n.z() * n.head<2>()) / q;
  image.dc_dp << p.z() * Eigen::Matrix2d::Identity(), p.head<2>() - 2.0 * p.z() * image.c;
  image.dc_dn << R2 * n.z() * Eigen::Matrix2d::Identity(),
      R2 * (n.head<2>() - 2.0 * n.z() * image.c);
  image.dc_dp /= q;
  image.dc_dn /= q;
  image.S = (R2 * (Eigen::Matrix2d::Identity() - n.head<2>() * n.head<2>().transpose()) -
             p.head<2>() * p.head<2>().transpose()) /
                q +
            image.c * image.c.transpose();
  return image;
}

/// By how much the lens's curvature moves the centre of a small ellipse with shape S at pixel uv,
/// −k/4 (10 T + tr T) y in distorted normalised coordinates.
Eigen::Vector2d lens_shift(const Intrinsics& intrinsics, const Eigen::Vector2d& uv,
                           const Eigen::Matrix2d& duv_dxy, const Eigen::Matrix2d& S) {
  const Eigen::Vector2d focal(intrinsics.px, intrinsics.py);
  const Eigen::Vector2d y =
      (uv - Eigen::Vector2d(intrinsics.u0, intrinsics.v0)).cwiseQuotient(focal);
  const Eigen::Matrix2d J = focal.cwiseInverse().asDiagonal() * duv_dxy;
  const Eigen::Matrix2d T = J * S * J.transpose();
  return focal.cwiseProduct(-0.25 * intrinsics.kdu * (10.0 * T * y + T.trace() * y));
}

/// H with HᵀH = A and y with Hᵀy = b, by a pivoted Cholesky decomposition; b lies in the range of
/// A.
void compress(const Eigen::Matrix<double, 6, 6>& A, const Eigen::Matrix<double, 6, 1>& b,
              PointsMeasurement& measurement) {
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(A);
  const Eigen::Matrix<double, 6, 1> D = factor.vectorD();
  const double min_pivot = kNothing * D.maxCoeff();
  Eigen::Matrix<double, 6, 1> root;
  Eigen::Matrix<double, 6, 1> inverse_root;
  for (Eigen::Index i = 0; i < 6; ++i) {
    root(i) = D(i) > min_pivot ? std::sqrt(D(i)) : 0.0;
    inverse_root(i) = D(i) > min_pivot ? 1.0 / root(i) : 0.0;
  }
  Eigen::Matrix<double, 6, 6> permutation = Eigen::Matrix<double, 6, 6>::Identity();
  permutation = factor.transpositionsP() * permutation;
  measurement.H = root.asDiagonal() * (factor.matrixU() * permutation);
  const Eigen::Matrix<double, 6, 1> permuted = factor.transpositionsP() * b;
  measurement.y = inverse_root.asDiagonal() * factor.matrixL().solve(permuted);
}

struct PointsOf {
  std::vector<LandmarkPoint> operator()(const DiscShape& /*disc*/) const { return {}; }
  std::vector<LandmarkPoint> operator()(const PatternShape& pattern) const {
    std::vector<LandmarkPoint> points;
    for (const PatternDot& dot : pattern_dots(pattern))
      points.push_back({dot.label, dot.centre_l, dot.radius_m});
    return points;
  }
  std::vector<LandmarkPoint> operator()(const TagShape& tag) const {
    const double h = 0.5 * tag.side_m;
    return {{0, {-h, -h}, 0.0}, {1, {h, -h}, 0.0}, {2, {h, h}, 0.0}, {3, {-h, h}, 0.0}};
  }
};

}  // namespace

std::vector<LandmarkPoint> landmark_points(const Landmark& landmark) {
  return std::visit(PointsOf{}, landmark.shape);
}

std::vector<SeenPoint> seen_points(const Landmark& landmark, const PointsObservation& observation,
                                   double floor_px) {
  const std::vector<LandmarkPoint> model = landmark_points(landmark);
  std::vector<SeenPoint> seen;
  for (const LabelledPoint& point : observation.points) {
    const auto known = std::find_if(model.begin(), model.end(), [&point](const LandmarkPoint& m) {
      return m.label == point.label;
    });
    const Eigen::Matrix2d R = point.covariance + floor_px * floor_px * Eigen::Matrix2d::Identity();
    const bool usable = known != model.end() && point.uv.allFinite() && R.allFinite() &&
                        R(0, 0) > 0.0 && R.determinant() > 0.0;
    if (usable) seen.push_back({*known, point.uv, R.inverse()});
  }
  return seen;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& cMl, const PoseVector& delta) {
  Eigen::Isometry3d result = cMl;
  result.translation() += delta.head<3>();
  result.linear() = exp_so3(delta.tail<3>()) * cMl.linear();
  return result;
}

PoseVector move_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  PoseVector delta;
  delta << to.translation() - from.translation(), turn.angle() * turn.axis();
  return delta;
}

std::optional<PointImage> predict_point(const LandmarkPoint& point, const Intrinsics& intrinsics,
                                        const Eigen::Isometry3d& cMl) {
  const Eigen::Vector3d arm =
      cMl.linear().leftCols<2>() * point.centre_l;  // from the landmark's centre, camera axes
  const Eigen::Vector3d n = cMl.linear().col(2);
  const auto image = circle_centre(cMl.translation() + arm, n, point.radius_m);
  if (!image) return std::nullopt;
  const auto uv = distort(intrinsics, image->c);
  if (!uv) return std::nullopt;
  const Eigen::Matrix2d duv_dxy = distort_jacobian(intrinsics, *uv);
  PointImage result;
  result.uv = *uv;
  if (intrinsics.kdu != 0.0 && point.radius_m > 0.0)
    result.uv += lens_shift(intrinsics, *uv, duv_dxy, image->S);
  // dp = v + ω × arm, dn = ω × n.
  result.duv_dpose << duv_dxy * image->dc_dp,
      -duv_dxy * (image->dc_dp * skew(arm) + image->dc_dn * skew(n));
  result.duv_dlog_focal = result.uv - Eigen::Vector2d(intrinsics.u0, intrinsics.v0);
  return result;
}

std::optional<PointsFit> fit_points(const std::vector<SeenPoint>& points,
                                    const Intrinsics& intrinsics, const Eigen::Isometry3d& cMl) {
  PointsFit fit;
  fit.information.setZero();
  fit.gradient.setZero();
  for (const SeenPoint& seen : points) {
    const auto image = predict_point(seen.point, intrinsics, cMl);
    if (!image) return std::nullopt;
    Eigen::Matrix<double, 2, 7> J;
    J << image->duv_dpose, image->duv_dlog_focal;
    const Eigen::Vector2d r = seen.uv - image->uv;
    const Eigen::Matrix<double, 7, 2> JtW = J.transpose() * seen.information;
    fit.information.noalias() += JtW.lazyProduct(J);
    fit.gradient.noalias() += JtW * r;
    fit.chi2 += r.dot(seen.information * r);
  }
  return fit;
}

std::optional<PointsMeasurement> measure_points(const std::vector<SeenPoint>& points,
                                                const Eigen::Isometry3d& wMl, const Shot& shot,
                                                const RigOnGround& on_ground, const Pose2& pose,
                                                const LookBias& bias) {
  const HeadAngles head{shot.head.pan + bias.pan, shot.head.tilt + bias.tilt};
  const PlacedCamera placed(on_ground, shot.camera, head, pose);
  const Eigen::Isometry3d cMl = placed.wMc.inverse() * wMl;
  Intrinsics intrinsics = pinhole(shot);
  intrinsics.px *= std::exp(bias.log_focal);
  intrinsics.py *= std::exp(bias.log_focal);
  const auto fit = fit_points(points, intrinsics, cMl);
  if (!fit) return std::nullopt;

  // A camera that moves by (v, ω) sees the landmark move by (−v − ω × t, −ω).
  const Eigen::Matrix<double, 6, 5> twists = camera_twists(on_ground, placed, pose);
  Eigen::Matrix<double, 7, 6> dfit_dstate = Eigen::Matrix<double, 7, 6>::Zero();
  dfit_dstate.block<3, 5>(0, 0) =
      skew(cMl.translation()) * twists.bottomRows<3>() - twists.topRows<3>();
  dfit_dstate.block<3, 5>(3, 0) = -twists.bottomRows<3>();
  dfit_dstate(6, 5) = 1.0;
  const Eigen::Matrix<double, 6, 6> A = dfit_dstate.transpose() * fit->information * dfit_dstate;
  const Eigen::Matrix<double, 6, 1> b = dfit_dstate.transpose() * fit->gradient;
  PointsMeasurement measurement;
  measurement.chi2 = fit->chi2;
  compress(A, b, measurement);
  return measurement;
}

}  // namespace vigia::localization
