#include "vigia/evaluation/quixote_setting.hpp"

#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/evaluation/view_bound.hpp"
#include "vigia/localization/points_model.hpp"
#include "vigia/localization/view_parameters.hpp"

namespace vigia::evaluation {
namespace {

constexpr int kRouteViews = 30;

/// wMc of a level camera at @p p_w whose axis passes through @p target_w.
Eigen::Isometry3d looking_at(const Eigen::Vector3d& p_w, const Eigen::Vector3d& target_w) {
  const Eigen::Vector3d z = (target_w - p_w).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d wMc = Eigen::Isometry3d::Identity();
  wMc.linear() << x, z.cross(x), z;
  wMc.translation() = p_w;
  return wMc;
}

/// Distance and φ within the limits that the paper keeps.
bool will_do(const QuixoteSetting& setting, const Landmark& pattern, const Eigen::Vector3d& p_w) {
  const Eigen::Vector3d view = spherical_view(pattern.wMl.inverse() * p_w).phi_theta_distance;
  return view.x() >= setting.min_phi && view.x() < 0.5 * kPi &&
         view.z() >= setting.min_distance_m && view.z() <= setting.max_distance_m;
}

/// Both rings, or the inner one whole: with less the paper's method has nothing to read.
bool ring_is_whole(const PatternView& view) {
  int inner = 0;
  for (const LabelledPoint& point : view.seen.points)
    if (point.label > kDotsPerRing) ++inner;
  return inner == kDotsPerRing;
}

Eigen::Vector2d centring_error(const QuixoteSetting& setting, RandomStream& random) {
  const double u = setting.centring_sigma_px * random.normal();
  return {u, setting.centring_sigma_px * random.normal()};
}

}  // namespace

LandmarkMap quixote_patterns(const QuixoteSetting& setting) {
  const double w = setting.room_m.x();
  const double d = setting.room_m.y();
  const double z = setting.pattern_height_m;
  const auto pattern = [](int id, const Eigen::Vector3d& at, double yaw_deg) {
    return Landmark{id, wall_mount(at, from_deg(yaw_deg)), PatternShape{{0, 0, id}}};
  };
  return LandmarkMap({pattern(0, {0.25 * w, 0.0, z}, 90.0), pattern(1, {0.75 * w, 0.0, z}, 90.0),
                      pattern(2, {w, 0.5 * d, z}, 180.0), pattern(3, {0.75 * w, d, z}, -90.0),
                      pattern(4, {0.25 * w, d, z}, -90.0), pattern(5, {0.0, 0.5 * d, z}, 0.0)});
}

FloorPlan quixote_room(const QuixoteSetting& setting) {
  const double w = setting.room_m.x();
  const double d = setting.room_m.y();
  return FloorPlan({{0.0, 0.0}, {w, 0.0}, {w, d}, {0.0, d}}, 2.5, {}, {});
}

PatternView quixote_view(const QuixoteSetting& setting, const Landmark& pattern,
                         const Eigen::Vector3d& p_w, const Eigen::Vector2d& off_px, double sigma_px,
                         RandomStream& random) {
  const Eigen::Vector3d ray_c(off_px.x() / setting.camera.px, off_px.y() / setting.camera.py, 1.0);
  PatternView view;
  view.landmark = pattern;
  view.wMc = looking_at(p_w, pattern.centre_w());
  view.wMc.linear() = view.wMc.linear() * localization::sight_rotation(ray_c);
  view.seen.shot.model = setting.camera;
  view.seen.expected = pattern.id;
  view.seen.landmark = pattern.id;
  const Eigen::Isometry3d cMl = view.wMc.inverse() * pattern.wMl;
  for (const auto& point : localization::landmark_points(pattern)) {
    const auto image = localization::predict_point(point, setting.camera, cMl);
    const double du = sigma_px * random.normal();
    const double dv = sigma_px * random.normal();
    const double size = setting.camera.px * point.radius_m / cMl.translation().z();
    if (!image || !in_image(setting.camera, image->uv, size)) continue;
    view.seen.points.push_back({point.label, image->uv + Eigen::Vector2d(du, dv),
                                sigma_px * sigma_px * Eigen::Matrix2d::Identity()});
  }
  return view;
}

std::vector<PatternView> random_views(const QuixoteSetting& setting, double sigma_px, int count,
                                      RandomStream& random) {
  const LandmarkMap patterns = quixote_patterns(setting);
  const double margin = setting.wall_distance_m;
  std::vector<PatternView> views;
  while (views.size() < static_cast<std::size_t>(count)) {
    const Landmark& pattern = patterns.all()[random.index(patterns.all().size())];
    const double x = random.uniform(margin, setting.room_m.x() - margin);
    const double y = random.uniform(margin, setting.room_m.y() - margin);
    const Eigen::Vector3d p_w(x, y, setting.camera_height_m);
    if (!will_do(setting, pattern, p_w)) continue;
    PatternView view =
        quixote_view(setting, pattern, p_w, centring_error(setting, random), sigma_px, random);
    if (ring_is_whole(view)) views.push_back(std::move(view));
  }
  return views;
}

std::vector<PatternView> route_views(const QuixoteSetting& setting, double sigma_px,
                                     RandomStream& random) {
  const LandmarkMap patterns = quixote_patterns(setting);
  const Eigen::Vector2d centre = 0.5 * setting.room_m;
  std::vector<PatternView> views;
  for (int i = 0; i < kRouteViews; ++i) {
    const double turn = 2.0 * kPi * i / kRouteViews;
    const Eigen::Vector3d p_w(centre.x() + 0.32 * setting.room_m.x() * std::cos(turn),
                              centre.y() + 0.28 * setting.room_m.y() * std::sin(turn),
                              setting.camera_height_m);
    const Landmark* nearest = nullptr;
    for (const Landmark& pattern : patterns.all()) {
      if (!will_do(setting, pattern, p_w)) continue;
      if (nearest == nullptr ||
          (pattern.centre_w() - p_w).norm() < (nearest->centre_w() - p_w).norm())
        nearest = &pattern;
    }
    if (nearest == nullptr) continue;
    views.push_back(
        quixote_view(setting, *nearest, p_w, centring_error(setting, random), sigma_px, random));
  }
  return views;
}

}  // namespace vigia::evaluation
