#include "vigia/evaluation/field_frames.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::evaluation {
namespace {

constexpr double kMinRange_m = 0.3;  // the robot's own body hides what is nearer

/// Where a ray truly meets something.
struct TrueHit {
  double bearing = 0.0;  ///< in the robot's frame
  double range_m = 0.0;
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< of the line in the world; zero for clutter
};

double range_sigma(const FieldFrameParams& params, double range_m) {
  return params.range_floor_m + params.range_share * range_m;
}

std::vector<double> ray_bearings(const FieldFrameParams& params, RandomStream& random) {
  const int rays = static_cast<int>(std::lround(360.0 / params.ray_step_deg));
  const double first = random.uniform(0.0, 2.0 * kPi / rays);
  std::vector<double> bearings;
  bearings.reserve(static_cast<std::size_t>(rays));
  for (int i = 0; i < rays; ++i) bearings.push_back(wrap_angle(first + 2.0 * kPi * i / rays));
  return bearings;
}

std::vector<TrueHit> hits_on(const std::vector<FieldLine>& lines, const Pose2& truth,
                             const std::vector<double>& bearings, double sight_m, bool real) {
  std::vector<TrueHit> hits;
  std::vector<LineCrossing> crossings;
  for (const double bearing : bearings) {
    crossings.clear();
    const Eigen::Vector2d u = unit_vector(truth.theta + bearing);
    for (const FieldLine& line : lines) cross_line(line, truth.position(), u, sight_m, crossings);
    for (const LineCrossing& crossing : crossings)
      if (crossing.range_m >= kMinRange_m)
        hits.push_back({bearing, crossing.range_m,
                        real ? crossing.normal : Eigen::Vector2d(Eigen::Vector2d::Zero())});
  }
  return hits;
}

/// @p count of them at random, or all.
void keep_some(std::vector<TrueHit>& hits, std::size_t count, RandomStream& random) {
  for (std::size_t i = 0; i < std::min(count, hits.size()); ++i)
    std::swap(hits[i], hits[i + random.index(hits.size() - i)]);
  if (hits.size() > count) hits.resize(count);
}

/// Uniform over the floor within sight.
TrueHit random_hit(const FieldMap& map, const Pose2& truth, double sight_m, RandomStream& random) {
  for (;;) {
    const double x =
        random.uniform(-0.5 * map.length_m - map.margin_m, 0.5 * map.length_m + map.margin_m);
    const double y =
        random.uniform(-0.5 * map.width_m - map.margin_m, 0.5 * map.width_m + map.margin_m);
    const Eigen::Vector2d to = Eigen::Vector2d(x, y) - truth.position();
    const double range = to.norm();
    if (range < kMinRange_m || range > sight_m) continue;
    return {wrap_angle(std::atan2(to.y(), to.x()) - truth.theta), range, Eigen::Vector2d::Zero()};
  }
}

std::vector<TrueHit> false_hits(const FieldMap& map, const FieldFrameParams& params,
                                const Pose2& truth, const std::vector<double>& bearings,
                                const std::vector<FalseLine>& given, RandomStream& random) {
  const auto count = static_cast<std::size_t>(std::lround(params.clutter_share * params.points));
  std::vector<TrueHit> hits;
  if (count == 0) return hits;
  if (params.clutter == FieldFrameParams::Clutter::straight) {
    std::vector<FieldLine> lines;
    for (const FalseLine& line :
         given.empty() ? random_false_lines(map, params.false_lines, random) : given)
      lines.push_back(FieldLine::segment(line.a, line.b, 0.125));
    hits = hits_on(lines, truth, bearings, params.sight_m, false);
    keep_some(hits, count, random);
  }
  while (hits.size() < count) hits.push_back(random_hit(map, truth, params.sight_m, random));
  return hits;
}

/// Adds what the point says of the pose were its line known.
void add_information(const FieldFrameParams& params, const Pose2& truth, const TrueHit& hit,
                     Eigen::Matrix3d& information) {
  const Eigen::Vector2d u = unit_vector(truth.theta + hit.bearing);
  const Eigen::Vector2d across(-u.y(), u.x());
  const double along_ray = hit.normal.dot(u) * range_sigma(params, hit.range_m);
  const double across_ray =
      hit.normal.dot(across) * from_deg(params.bearing_sigma_deg) * hit.range_m;
  const Eigen::Vector3d J(hit.normal.x(), hit.normal.y(), hit.range_m * hit.normal.dot(across));
  information += J * J.transpose() / (along_ray * along_ray + across_ray * across_ray);
}

void add_goal_information(const FieldFrameParams& params, const Pose2& truth,
                          const Eigen::Vector2d& at, Eigen::Matrix3d& information) {
  const Eigen::Vector2d to = at - truth.position();
  const double range = to.norm();
  const Eigen::Vector2d u = to / range;
  const Eigen::Vector3d dbearing(u.y() / range, -u.x() / range, -1.0);
  const Eigen::Vector3d drange(-u.x(), -u.y(), 0.0);
  const double sigma_b = from_deg(params.bearing_sigma_deg);
  const double sigma_r = params.goal_range_share * range;
  information += dbearing * dbearing.transpose() / (sigma_b * sigma_b) +
                 drange * drange.transpose() / (sigma_r * sigma_r);
}

ColourSighting sight(const FieldFrameParams& params, const Pose2& truth, FieldColour colour,
                     const Eigen::Vector2d& at, RandomStream& random) {
  const Eigen::Vector2d to = at - truth.position();
  const double range = to.norm();
  const double sigma_b = from_deg(params.bearing_sigma_deg);
  const double bearing = std::atan2(to.y(), to.x()) - truth.theta + sigma_b * random.normal();
  const double measured =
      std::max(0.05, range * (params.range_scale + params.goal_range_share * random.normal()));
  return {colour, wrap_angle(bearing), measured, sigma_b, params.goal_range_share * measured};
}

}  // namespace

Pose2 random_field_pose(const FieldMap& map, double margin_m, RandomStream& random) {
  const double x = random.uniform(margin_m - 0.5 * map.length_m, 0.5 * map.length_m - margin_m);
  const double y = random.uniform(margin_m - 0.5 * map.width_m, 0.5 * map.width_m - margin_m);
  return {x, y, random.uniform(-kPi, kPi)};
}

std::vector<FalseLine> random_false_lines(const FieldMap& map, int count, RandomStream& random) {
  std::vector<FalseLine> lines;
  for (int i = 0; i < count; ++i) {
    const Pose2 middle = random_field_pose(map, 0.5, random);
    const Eigen::Vector2d half = random.uniform(1.0, 4.0) * unit_vector(middle.theta);
    lines.push_back({middle.position() - half, middle.position() + half});
  }
  return lines;
}

FieldFrame draw_field_frame(const FieldMap& map, const FieldFrameParams& params, const Pose2& truth,
                            RandomStream& random, const std::vector<FalseLine>& false_lines) {
  FieldFrame frame;
  frame.truth = truth;
  const std::vector<double> bearings = ray_bearings(params, random);
  std::vector<TrueHit> hits = false_hits(map, params, truth, bearings, false_lines, random);
  const std::size_t clutter = hits.size();
  std::vector<TrueHit> real = hits_on(map.lines, truth, bearings, params.sight_m, true);
  keep_some(real, static_cast<std::size_t>(params.points) - clutter, random);
  frame.true_points = static_cast<int>(real.size());
  hits.insert(hits.end(), real.begin(), real.end());
  const double sigma_b = from_deg(params.bearing_sigma_deg);
  for (const TrueHit& hit : hits) {
    const double bearing = hit.bearing + sigma_b * random.normal();
    const double range = std::max(0.05, params.range_scale * hit.range_m +
                                            range_sigma(params, hit.range_m) * random.normal());
    frame.scan.points.push_back(polar_point(bearing, range, sigma_b, range_sigma(params, range)));
    if (!hit.normal.isZero()) add_information(params, truth, hit, frame.information);
  }
  if (params.goals)
    for (const FieldGoal& goal : map.goals) {
      frame.scan.goals.push_back(sight(params, truth, goal.colour, goal.centre(), random));
      add_goal_information(params, truth, goal.centre(), frame.goal_information);
    }
  frame.bound = frame.information.inverse();
  return frame;
}

}  // namespace vigia::evaluation
