#include "vigia/localization/ring_pose.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/QR>

#include "vigia/core/angle.hpp"

namespace vigia::localization {
namespace {

using RingPoints = std::array<Eigen::Vector2d, kDotsPerRing>;

const LabelledPoint* find_label(const PointsObservation& observation, int label) {
  const auto it = std::find_if(observation.points.begin(), observation.points.end(),
                               [label](const LabelledPoint& p) { return p.label == label; });
  return it != observation.points.end() && it->uv.allFinite() ? &*it : nullptr;
}

Eigen::Vector2d turned(const Eigen::Vector2d& p, double psi) {
  const double c = std::cos(psi);
  const double s = std::sin(psi);
  return {c * p.x() + s * p.y(), -s * p.x() + c * p.y()};
}

/// The ring with the other branch of ψ.
RingImage other_branch(RingImage image) {
  image.psi = wrap_angle(image.psi + kPi);
  image.centre = -image.centre;
  for (Eigen::Vector2d& p : image.points) p = -p;
  return image;
}

/// Adán eq. 16 (mended) and 17 by atan2, averaged over first, third, fifth and seventh point. The
/// third lies at the viewer's right, which is −X_w. Where @p origin is off the centre-point, the
/// average cancels that to first order.
double theta_of(RingPoints p, const Eigen::Vector2d& origin, double phi) {
  for (Eigen::Vector2d& point : p) point -= origin;
  const double c = std::cos(phi);
  const std::array<double, 4> thetas{
      std::atan2(-p[0].x() * c, p[0].y()), std::atan2(-p[2].y(), -p[2].x() * c),
      std::atan2(p[4].x() * c, -p[4].y()), std::atan2(p[6].y(), p[6].x() * c)};
  double sum = 0.0;
  for (const double theta : thetas) sum += wrap_angle(theta - thetas[0]);
  return wrap_angle(thetas[0] + sum / 4.0);
}

/// φ and D of a circle of radius @p R whose ellipse has the semi-axes a and b, f = 1.
ViewParameters published_view(const RingImage& image, double R) {
  ViewParameters view;
  view.phi = std::acos(std::min(1.0, image.b / image.a));  // eq. 12
  view.distance = R / image.a;                             // eq. 11
  return view;
}

/// Eq. 9 made two-sided, a = R/√(D² − R²s²) and b = R c D/(D² − R²s²), inverted.
ViewParameters exact_view(const RingImage& image, double R) {
  const double a2 = image.a * image.a;
  const double S = R * R / a2 + R * R;
  const double product = R * R * image.b * image.b * R * R / (a2 * a2);
  const double D2 = 0.5 * (S + std::sqrt(std::max(0.0, S * S - 4.0 * product)));
  ViewParameters view;
  view.distance = std::sqrt(D2);
  view.phi = std::acos(std::min(1.0, image.b * R / (a2 * view.distance)));
  return view;
}

/// What the ring's pixels are in the camera whose axis the method takes for that of the pattern.
struct RingInput {
  RingPoints points;                            ///< normalised, x left, y up
  std::optional<Eigen::Vector2d> centre_point;  ///< likewise
  Eigen::Matrix3d vRc = Eigen::Matrix3d::Identity();
  double sigma = 0.0;  ///< of a coordinate, normalised
};

std::optional<RingInput> read_ring(const PointsObservation& observation,
                                   const RingPoseParams& params) {
  const Intrinsics& intrinsics = pinhole(observation.shot);
  const LabelledPoint* middle = find_label(observation, 0);
  if (params.centre_view && middle == nullptr) return std::nullopt;
  std::vector<Eigen::Vector2d> pixels;
  double variance = 0.0;
  const int first = params.ring == Ring::outer ? 1 : 1 + kDotsPerRing;
  for (int label = first; label < first + kDotsPerRing; ++label) {
    const LabelledPoint* point = find_label(observation, label);
    if (point == nullptr) return std::nullopt;
    pixels.push_back(point->uv);
    variance += 0.5 * point->covariance.trace() / kDotsPerRing;
  }
  if (middle != nullptr) pixels.push_back(middle->uv);
  const Eigen::Vector2d axis(intrinsics.u0, intrinsics.v0);
  const CentredImage image =
      centre_image(intrinsics, params.centre_view ? middle->uv : axis, pixels);
  RingInput input;
  for (std::size_t i = 0; i < input.points.size(); ++i) input.points[i] = -image.points[i];
  if (middle != nullptr) input.centre_point = -image.points.back();
  input.vRc = image.vRc;
  input.sigma = std::sqrt(variance) / intrinsics.px;
  return input;
}

/// How far the ellipse's centre lies from the centre-point towards the near side, −y', where the
/// branch of ψ is right; negative on the wrong branch.
double near_offset(const RingImage& image, const Eigen::Vector2d& centre_point) {
  return turned(centre_point, image.psi).y() - image.centre.y();
}

}  // namespace

std::optional<RingImage> fit_ring(const RingPoints& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p / kDotsPerRing;
  double scale = 0.0;
  for (const Eigen::Vector2d& p : points) scale += (p - mean).norm() / kDotsPerRing;
  if (!(scale > 0.0)) return std::nullopt;

  // Eq. 1, A x² + B xy + C y² + D x + E y = 1.
  Eigen::Matrix<double, kDotsPerRing, 5> rows;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d p = (points[i] - mean) / scale;
    rows.row(static_cast<Eigen::Index>(i)) << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(),
        p.y();
  }
  const Eigen::Matrix<double, 5, 1> conic =
      rows.colPivHouseholderQr().solve(Eigen::Matrix<double, kDotsPerRing, 1>::Ones());
  const double A = conic(0);
  const double B = conic(1);
  const double C = conic(2);
  if (!conic.allFinite() || A + C <= 0.0 || 4.0 * A * C - B * B <= 0.0) return std::nullopt;

  RingImage image;
  image.psi = 0.5 * std::atan2(-B, C - A);  // eq. 2 with its branch: the long axis
  const double c = std::cos(image.psi);
  const double s = std::sin(image.psi);
  const double Ap = A * c * c + B * s * c + C * s * s;  // eq. 4
  const double Cp = A * s * s - B * s * c + C * c * c;
  const double Dp = conic(3) * c + conic(4) * s;
  const double Ep = conic(4) * c - conic(3) * s;
  const double M = Dp * Dp / (4.0 * Ap) + Ep * Ep / (4.0 * Cp) + 1.0;  // eq. 5
  image.a = scale * std::sqrt(M / Ap);                                 // eq. 6
  image.b = scale * std::sqrt(M / Cp);
  image.centre =
      scale * Eigen::Vector2d(-Dp / (2.0 * Ap), -Ep / (2.0 * Cp)) + turned(mean, image.psi);
  for (std::size_t i = 0; i < points.size(); ++i) image.points[i] = turned(points[i], image.psi);
  return image;
}

std::optional<RingPose> ring_pose(const PatternShape& shape, const PointsObservation& observation,
                                  const RingPoseParams& params) {
  const auto input = read_ring(observation, params);
  if (!input) return std::nullopt;
  auto image = fit_ring(input->points);
  if (!image) return std::nullopt;
  const double R = params.ring == Ring::outer ? shape.outer_radius_m : shape.inner_radius_m;
  const bool exact = params.method == RingMethod::exact;
  ViewParameters view = exact ? exact_view(*image, R) : published_view(*image, R);
  // The axis of a turned view passes through the centre-point, the published method takes that for
  // granted, else the ellipse's centre stands for it.
  const bool about_axis = params.centre_view || !exact;
  const auto theta_in = [&](const RingImage& ring) {
    const Eigen::Vector2d origin = about_axis ? Eigen::Vector2d(0.0, 0.0) : ring.centre;
    return theta_of(ring.points, origin, view.phi);
  };
  const auto& middle = input->centre_point;
  const bool wrong =
      exact && middle ? near_offset(*image, *middle) < 0.0 : std::abs(theta_in(*image)) > 0.5 * kPi;
  if (wrong) image = other_branch(*image);
  view.theta = theta_in(*image);
  view.psi = image->psi;

  RingPose pose;
  pose.view = view;
  pose.cMl = Eigen::Isometry3d(input->vRc.transpose()) * pose_of(view);
  pose.frontal = view.phi < params.frontal_below;
  // The offsets of view and twin are ±e; the centre's and the centre-point's noise blur it.
  const double e = image->b * R * std::sin(view.phi) / view.distance;
  const double variance = input->sigma * input->sigma * (2.0 / kDotsPerRing + 1.0);
  const double offset = middle ? std::abs(near_offset(*image, *middle)) : 0.0;
  pose.twin_as_good = 2.0 * offset * e < variance * std::log(params.ambiguity_ratio);
  return pose;
}

}  // namespace vigia::localization
