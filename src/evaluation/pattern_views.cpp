#include "vigia/evaluation/pattern_views.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/evaluation/view_bound.hpp"
#include "vigia/localization/points_pose.hpp"
#include "vigia/localization/ring_pose.hpp"
#include "vigia/localization/view_parameters.hpp"

namespace vigia::evaluation {
namespace {

using localization::Ring;
using localization::RingMethod;
using localization::ViewParameters;

bool from_below(const ViewParameters& view) {
  return std::abs(view.theta) <= 0.5 * kPi;
}

const LabelledPoint* point_of(const PatternView& view, int label) {
  const auto it = std::find_if(view.seen.points.begin(), view.seen.points.end(),
                               [label](const LabelledPoint& p) { return p.label == label; });
  return it == view.seen.points.end() ? nullptr : &*it;
}

bool has_ring(const PatternView& view, Ring ring) {
  const int first = ring == Ring::outer ? 1 : 1 + kDotsPerRing;
  for (int label = first; label < first + kDotsPerRing; ++label)
    if (point_of(view, label) == nullptr) return false;
  return true;
}

/// The larger complete ring, as the paper's image processing prefers.
Ring ring_of(const PatternView& view) {
  return has_ring(view, Ring::outer) ? Ring::outer : Ring::inner;
}

/// Eq. 16 and 17 as printed, averaged over first, third, fifth and seventh point; the third at the
/// viewer's right, x and y of a camera that looks along the pattern's axis.
std::optional<double> printed_theta(const PatternView& view, Ring ring, double phi) {
  const Intrinsics& intrinsics = pinhole(view.seen.shot);
  const int first = ring == Ring::outer ? 1 : 1 + kDotsPerRing;
  std::array<Eigen::Vector2d, kDotsPerRing> points;
  for (int i = 0; i < kDotsPerRing; ++i)
    points[static_cast<std::size_t>(i)] = -unproject(intrinsics, point_of(view, first + i)->uv);
  const auto image = localization::fit_ring(points);
  if (!image) return std::nullopt;
  const auto& x = image->points;
  double sum = 0.0;
  for (const std::size_t i : {0U, 4U}) sum += std::atan(x[i].x() / x[i].y() * std::cos(phi));
  for (const std::size_t i : {2U, 6U}) sum += std::atan(x[i].y() / (x[i].x() * std::cos(phi)));
  return sum / 4.0;
}

std::optional<ViewParameters> ring_view(const PatternView& view, ViewMethod method) {
  localization::RingPoseParams params;
  params.ring = ring_of(view);
  if (!has_ring(view, params.ring)) return std::nullopt;
  const bool exact = method == ViewMethod::exact || method == ViewMethod::uncentred;
  params.method = exact ? RingMethod::exact : RingMethod::as_published;
  params.centre_view = method == ViewMethod::exact;
  const auto pose = ring_pose(std::get<PatternShape>(view.landmark.shape), view.seen, params);
  if (!pose) return std::nullopt;
  ViewParameters found = pose->view;
  if (!from_below(found)) found = twin_of(found);
  if (method == ViewMethod::printed) {
    const auto theta = printed_theta(view, params.ring, found.phi);
    if (!theta) return std::nullopt;
    found.theta = *theta;
  }
  return found;
}

std::optional<ViewParameters> refined_view(const PatternView& view) {
  const auto solved = localization::solve_points(
      localization::seen_points(view.landmark, view.seen), pinhole(view.seen.shot));
  if (!solved.has_pose()) return std::nullopt;
  const ViewParameters found = localization::view_of(solved.pose.cMl);
  if (solved.twin && !from_below(found)) return localization::view_of(solved.twin->cMl);
  return found;
}

/// Where the camera stands in frame l: D (−sin φ sin θ, cos φ, −sin φ cos θ) in the paper's axes.
Eigen::Vector3d position_of(const ViewParameters& view) {
  return pose_of(view).inverse().translation();
}

}  // namespace

std::optional<ViewErrors> view_errors(const PatternView& view, ViewMethod method) {
  const auto found = method == ViewMethod::refined ? refined_view(view) : ring_view(view, method);
  if (!found) return std::nullopt;
  const Eigen::Isometry3d lMc = view.landmark.wMl.inverse() * view.wMc;
  const Eigen::Vector3d truth = spherical_view(lMc.translation()).phi_theta_distance;
  const Eigen::Vector3d shift =
      view.landmark.wMl.linear() * (position_of(*found) - lMc.translation());
  return ViewErrors{found->phi - truth.x(),
                    wrap_angle(found->theta - truth.y()),
                    found->distance - truth.z(),
                    shift.x(),
                    shift.y(),
                    shift.z()};
}

MethodErrors judge_views(const std::vector<PatternView>& views, ViewMethod method) {
  MethodErrors result;
  std::array<std::vector<double>, kViewQuantities> errors;
  for (const PatternView& view : views) {
    const auto found = view_errors(view, method);
    if (!found) continue;
    ++result.views;
    for (std::size_t i = 0; i < kViewQuantities; ++i) errors[i].push_back(std::abs((*found)[i]));
  }
  if (result.views == 0) return result;
  for (std::size_t i = 0; i < kViewQuantities; ++i) {
    QuantityErrors& q = result.quantities[i];
    double squares = 0.0;
    for (const double e : errors[i]) {
      q.mean += e / result.views;
      squares += e * e / result.views;
    }
    q.rms = std::sqrt(squares);
    q.deviation = std::sqrt(std::max(0.0, squares - q.mean * q.mean));
    q.greatest = *std::max_element(errors[i].begin(), errors[i].end());
    q.smallest = *std::min_element(errors[i].begin(), errors[i].end());
  }
  return result;
}

LimitErrors limit_of_views(const std::vector<PatternView>& views) {
  LimitErrors limit;
  int counted = 0;
  for (const PatternView& view : views) {
    const auto bound = view_bound(localization::seen_points(view.landmark, view.seen),
                                  pinhole(view.seen.shot), view.wMc.inverse() * view.landmark.wMl);
    if (!bound) continue;
    ++counted;
    const Eigen::Matrix3d wRl = view.landmark.wMl.linear();
    Eigen::Matrix<double, 6, 1> variances;
    variances << bound->phi_theta_distance.diagonal(),
        (wRl * bound->position_l * wRl.transpose()).diagonal();
    for (std::size_t i = 0; i < kViewQuantities; ++i) {
      const double variance = variances(static_cast<Eigen::Index>(i));
      limit.mean[i] += std::sqrt(2.0 / kPi * variance);
      limit.rms[i] += variance;
    }
  }
  for (std::size_t i = 0; i < kViewQuantities && counted > 0; ++i) {
    limit.mean[i] /= counted;
    limit.rms[i] = std::sqrt(limit.rms[i] / counted);
  }
  return limit;
}

}  // namespace vigia::evaluation
