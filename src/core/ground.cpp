#include "vigia/core/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "vigia/core/plane_geometry.hpp"

namespace vigia {
namespace {

constexpr double kHinge_m = 1e-3;  // by which two pieces may differ along their hinge
constexpr double kLevel = 1e-9;    // sine of a slope that is none

/// How far inside a counter-clockwise convex polygon a point lies; negative: outside.
double depth_in(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - polygon[i];
    depth = std::min(depth, cross(along, p - polygon[i]) / along.norm());
  }
  return depth;
}

bool is_convex(const std::vector<Eigen::Vector2d>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i)
    if (cross(polygon[(i + 1) % n] - polygon[i], polygon[(i + 2) % n] - polygon[(i + 1) % n]) <=
        0.0)
      return false;
  return n >= 3;
}

std::vector<Eigen::Vector2d> counter_clockwise(std::vector<Eigen::Vector2d> polygon) {
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  if (area < 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

/// Turns plan axes into those of a slope: what points uphill is raised.
Eigen::Matrix3d slope_axes(double slope, double uphill) {
  const Eigen::Vector3d across(-std::sin(uphill), std::cos(uphill), 0.0);
  return Eigen::AngleAxisd(-slope, across).toRotationMatrix();
}

Eigen::Vector3d on(const Eigen::Isometry3d& wMg, const Eigen::Vector2d& p) {
  return wMg * Eigen::Vector3d(p.x(), p.y(), 0.0);
}

/// The part that two edges share, if they run along each other.
std::optional<std::array<Eigen::Vector2d, 2>> shared_part(const Eigen::Vector2d& a,
                                                          const Eigen::Vector2d& b,
                                                          const Eigen::Vector2d& c,
                                                          const Eigen::Vector2d& d) {
  const double length = (b - a).norm();
  const Eigen::Vector2d u = (b - a) / length;
  if (std::abs(cross(u, c - a)) > kHinge_m || std::abs(cross(u, d - a)) > kHinge_m)
    return std::nullopt;
  const auto [low, high] = std::minmax({u.dot(c - a), u.dot(d - a)});
  const double from = std::max(0.0, low);
  const double to = std::min(length, high);
  if (to - from < 0.01) return std::nullopt;
  return std::array<Eigen::Vector2d, 2>{a + from * u, a + to * u};
}

/// Where @p patch must lie to be hinged to @p earlier along an edge, if it can be.
std::optional<Eigen::Vector3d> hinged(const GroundPatch& patch, const GroundPatch& earlier) {
  const auto& p = patch.polygon;
  const auto& q = earlier.polygon;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) {
      const auto part = shared_part(p[i], p[(i + 1) % p.size()], q[j], q[(j + 1) % q.size()]);
      if (!part) continue;
      const auto [a, b] = *part;
      const Eigen::Vector3d origin =
          on(earlier.wMg, a) - on(patch.wMg, a) + patch.wMg.translation();
      const Eigen::Vector3d gap =
          on(earlier.wMg, b) - on(earlier.wMg, a) - on(patch.wMg, b) + on(patch.wMg, a);
      if (gap.norm() < kHinge_m) return origin;
    }
  }
  return std::nullopt;
}

/// Height of a point above a plane along the vertical, and the point's foot in plan coordinates.
Eigen::Vector3d above(const Eigen::Isometry3d& wMg, const Eigen::Vector3d& p_w) {
  const Eigen::Vector3d q = wMg.inverse(Eigen::Isometry) * p_w;
  const Eigen::Vector3d up = wMg.linear().row(2).transpose();
  const double height = q.z() / up.z();
  const Eigen::Vector3d foot = q - height * up;
  return {foot.x(), foot.y(), height};
}

}  // namespace

/// The four points that the wheels touch and the axes that they span.
struct Ground::Contacts {
  std::array<const GroundPatch*, 4> patches{};  ///< front, rear, left, right
  std::array<Eigen::Vector2d, 4> offsets;       ///< from the robot's centre, plan axes
  std::array<Eigen::Vector3d, 4> p_w;
  Eigen::Vector3d x_axis;
  Eigen::Vector3d y_axis;
  double wheelbase = 0.0;  ///< of the points, along the chord
  Eigen::Vector3d across;  ///< from right to left, square to x_axis

  bool on_one() const {
    return std::all_of(patches.begin(), patches.end(),
                       [this](const GroundPatch* patch) { return patch == patches[0]; });
  }
};

Ground::Ground(const std::vector<GroundPiece>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string name = "piece " + std::to_string(i + 1) + " of the ground";
    GroundPatch patch;
    patch.polygon = counter_clockwise(pieces[i].polygon);
    if (!is_convex(patch.polygon)) throw std::invalid_argument(name + " is not convex");
    patch.wMg.linear() = slope_axes(pieces[i].slope, pieces[i].uphill);
    std::optional<Eigen::Vector3d> origin;
    for (auto earlier = patches_.begin(); earlier != patches_.end() && !origin; ++earlier)
      origin = hinged(patch, *earlier);
    if (!origin && i > 0)
      throw std::invalid_argument(name +
                                  " shares no level edge with an earlier one to be hinged along");
    if (origin) patch.wMg.translation() = *origin;
    patches_.push_back(std::move(patch));
  }
}

Ground Ground::under(const WheelStance& stance) const {
  Ground ground = *this;
  ground.stance_ = stance;
  return ground;
}

Ground Ground::with_steeper_ramps(double steeper) const {
  if (patches_.empty()) return *this;
  std::vector<GroundPiece> pieces;
  for (const GroundPatch& patch : patches_) {
    const Eigen::Vector3d up = patch.wMg.linear().row(2).transpose();  // in plan axes
    const double sine = up.head<2>().norm();
    GroundPiece piece{patch.polygon};
    if (sine > kLevel) {
      piece.slope = std::atan2(sine, up.z()) + steeper;
      piece.uphill = std::atan2(up.y(), up.x());
    }
    pieces.push_back(std::move(piece));
  }
  return Ground(pieces).under(stance_);
}

std::size_t Ground::patch_at(const Eigen::Vector2d& p) const {
  std::size_t best = 0;
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const double depth = depth_in(patches_[i].polygon, p);
    if (depth >= 0.0) return i;
    if (depth > deepest) {
      deepest = depth;
      best = i;
    }
  }
  return best;
}

Ground::Contacts Ground::contacts(const Pose2& pose) const {
  Contacts at;
  const Eigen::Vector2d ahead = unit_vector(pose.theta);
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const double half_base = 0.5 * stance_.base_m;
  const double half_track = 0.5 * stance_.track_m;
  at.offsets = {half_base * ahead, -half_base * ahead, half_track * left, -half_track * left};
  for (std::size_t i = 0; i < at.offsets.size(); ++i) {
    const Eigen::Vector2d p = pose.position() + at.offsets[i];
    at.patches[i] = &patches_[patch_at(p)];
    at.p_w[i] = on(at.patches[i]->wMg, p);
  }
  const Eigen::Vector3d chord = at.p_w[0] - at.p_w[1];
  at.wheelbase = chord.norm();
  at.x_axis = chord / at.wheelbase;
  const Eigen::Vector3d side = at.p_w[2] - at.p_w[3];
  at.across = side - at.x_axis * at.x_axis.dot(side);
  at.y_axis = at.across.normalized();
  return at;
}

Eigen::Isometry3d Ground::place_on_patches(const Pose2& pose) const {
  const Contacts at = contacts(pose);
  if (at.on_one()) return at.patches[0]->wMg * to_isometry(pose);
  Eigen::Isometry3d wMr = Eigen::Isometry3d::Identity();
  wMr.linear() << at.x_axis, at.y_axis, at.x_axis.cross(at.y_axis);
  wMr.translation() = 0.25 * (at.p_w[0] + at.p_w[1] + at.p_w[2] + at.p_w[3]);
  return wMr;
}

Eigen::Matrix<double, 6, 3> Ground::dplace_dpose(const Pose2& pose) const {
  Eigen::Matrix<double, 6, 3> jacobian = Eigen::Matrix<double, 6, 3>::Zero();
  const auto of_plane = [&jacobian](const Eigen::Matrix3d& wRg) {
    jacobian.topLeftCorner<3, 2>() = wRg.leftCols<2>();
    jacobian.bottomRightCorner<3, 1>() = wRg.col(2);
    return jacobian;
  };
  if (wMg_) return of_plane(wMg_->linear());
  if (patches_.empty()) return of_plane(Eigen::Matrix3d::Identity());
  const Contacts at = contacts(pose);
  if (at.on_one()) return of_plane(at.patches[0]->wMg.linear());

  std::array<Eigen::Matrix3d, 4> dp;  // of the contacts
  for (std::size_t i = 0; i < dp.size(); ++i) {
    Eigen::Matrix<double, 2, 3> in_plan;
    in_plan << 1.0, 0.0, -at.offsets[i].y(), 0.0, 1.0, at.offsets[i].x();
    dp[i] = at.patches[i]->wMg.linear().leftCols<2>() * in_plan;
    jacobian.topRows<3>() += 0.25 * dp[i];
  }
  const Eigen::Vector3d& x = at.x_axis;
  const Eigen::Vector3d& y = at.y_axis;
  const Eigen::Vector3d z = x.cross(y);
  const Eigen::Vector3d side = at.p_w[2] - at.p_w[3];
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Vector3d dchord = dp[0].col(k) - dp[1].col(k);
    const Eigen::Vector3d dside = dp[2].col(k) - dp[3].col(k);
    const Eigen::Vector3d dx = (dchord - x * x.dot(dchord)) / at.wheelbase;
    const Eigen::Vector3d dacross = dside - dx * x.dot(side) - x * (dx.dot(side) + x.dot(dside));
    const Eigen::Vector3d dy = (dacross - y * y.dot(dacross)) / at.across.norm();
    const Eigen::Vector3d dz = dx.cross(y) + x.cross(dy);
    // δφ of axes that move by δφ × axis.
    jacobian.block<3, 1>(3, k) = 0.5 * (x.cross(dx) + y.cross(dy) + z.cross(dz));
  }
  return jacobian;
}

Eigen::Vector3d Ground::lift(const Eigen::Vector2d& p, double height_m) const {
  Eigen::Vector3d in_plan(p.x(), p.y(), height_m);
  if (wMg_) return *wMg_ * in_plan;
  if (patches_.empty()) return in_plan;
  return on(patches_[patch_at(p)].wMg, p) + height_m * Eigen::Vector3d::UnitZ();
}

Eigen::Vector3d Ground::in_plan(const Eigen::Vector3d& p_w) const {
  if (wMg_) return wMg_->inverse() * p_w;
  if (patches_.empty()) return p_w;
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const GroundPatch& patch : patches_) {
    const Eigen::Vector3d point = above(patch.wMg, p_w);
    const double outside = std::max(0.0, -depth_in(patch.polygon, point.head<2>()));
    // Of patches one above the other the next one below; what is beside all of them belongs to the
    // nearest one.
    constexpr double kBelow_m = 0.5;
    const double height = point.z() < -kBelow_m ? 1e3 - point.z() : std::abs(point.z());
    const double badness = 1e6 * outside + height;
    if (badness >= least) continue;
    least = badness;
    best = point;
  }
  return best;
}

Eigen::Isometry3d Ground::frame_under(const Eigen::Vector3d& p_w) const {
  if (wMg_) return *wMg_;
  if (patches_.empty()) return Eigen::Isometry3d::Identity();
  return patches_[patch_at(in_plan(p_w).head<2>())].wMg;
}

Eigen::Isometry3d Ground::hang(const Eigen::Isometry3d& gMl) const {
  if (wMg_) return *wMg_ * gMl;
  if (patches_.empty()) return gMl;
  const Eigen::Vector2d p = gMl.translation().head<2>();
  // The wall runs along the landmark's x axis; on a slope its level direction turns a little.
  const Eigen::Vector3d along = patches_[patch_at(p)].wMg.linear() * gMl.linear().col(0);
  Eigen::Isometry3d wMl = Eigen::Isometry3d::Identity();
  wMl.linear().col(0) = Eigen::Vector3d(along.x(), along.y(), 0.0).normalized();
  wMl.linear().col(1) = Eigen::Vector3d::UnitZ();
  wMl.linear().col(2) = wMl.linear().col(0).cross(wMl.linear().col(1));
  wMl.translation() = lift(p, gMl.translation().z());
  return wMl;
}

}  // namespace vigia
