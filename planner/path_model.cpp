#include "vigia/planner/path_model.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::planner {
namespace {

constexpr double kStep_m = 0.02;
constexpr double kTolerance_m = 1e-6;

double turn_at(const Path& path, double s, double window) {
  return std::abs(wrap_angle(path.heading(std::min(s + 0.5 * window, path.length())) -
                             path.heading(std::max(s - 0.5 * window, 0.0))));
}

/// Each stretch over which the heading turns too fast, by its middle.
std::vector<double> find_turn_points(const Path& path, const PathModelParams& params) {
  std::vector<double> turns;
  const double limit = from_deg(params.turn_deg);
  double began = -1.0;
  const auto steps = static_cast<int>(std::floor(path.length() / kStep_m));
  for (int i = 0; i <= steps + 1; ++i) {
    const double s = i * kStep_m;
    const bool turning = i <= steps && turn_at(path, s, params.turn_window_m) > limit;
    if (turning && began < 0.0) began = s;
    if (!turning && began >= 0.0) {
      turns.push_back(0.5 * (began + s - kStep_m));
      began = -1.0;
    }
  }
  return turns;
}

std::vector<double> position_stations(const Path& path, const PathModelParams& params) {
  std::vector<double> stations;
  for (double s = params.radius_m; s + params.radius_m <= path.length() + kTolerance_m;
       s += params.spacing_m)
    stations.push_back(s);
  if (stations.empty()) stations.push_back(0.5 * path.length());
  return stations;
}

/// Whether every landmark that is seen from several of the poses is seen at about one distance.
bool uniform(const std::vector<Pose2>& poses, const LandmarkMap& landmarks,
             const Visibility& visibility, double ratio) {
  for (const Landmark& landmark : landmarks.all()) {
    double nearest = 1e9;
    double farthest = 0.0;
    for (const Pose2& pose : poses) {
      if (visibility.sight(landmark, pose) != Sight::visible) continue;
      nearest = std::min(nearest, visibility.range(landmark, pose));
      farthest = std::max(farthest, visibility.range(landmark, pose));
    }
    if (farthest > ratio * nearest) return false;
  }
  return true;
}

}  // namespace

Pose2 pose_on_path(const Path& path, double station_m) {
  const Eigen::Vector2d p = path.at(station_m);
  return {p.x(), p.y(), path.heading(station_m)};
}

std::size_t PathModel::area_at(double station_m) const {
  for (std::size_t i = 0; i + 1 < areas.size(); ++i)
    if (station_m < areas[i].to_m) return i;
  return areas.empty() ? 0 : areas.size() - 1;
}

PathModel model_path(const Path& path, const LandmarkMap& landmarks, const Visibility& visibility,
                     const PathModelParams& params) {
  PathModel model;
  model.turn_points = find_turn_points(path, params);
  const auto at_turn = [&](double s) {
    return std::any_of(model.turn_points.begin(), model.turn_points.end(),
                       [&](double turn) { return std::abs(turn - s) < params.turn_margin_m; });
  };
  std::vector<Pose2> poses;  // of the area that grows
  for (const double s : position_stations(path, params)) {
    const Pose2 pose = pose_on_path(path, s);
    const double from = std::max(s - params.radius_m, 0.0);
    const double to = std::min(s + params.radius_m, path.length());
    poses.push_back(pose);
    const bool fits = !model.areas.empty() &&
                      to - model.areas.back().from_m <= params.area_m + kTolerance_m &&
                      uniform(poses, landmarks, visibility, params.distance_ratio);
    if (!fits) {
      model.areas.push_back({from, to, {}});
      poses = {pose};
    }
    model.areas.back().to_m = to;
    if (!at_turn(s)) model.areas.back().positions.push_back({s, pose});
  }
  model.areas.front().from_m = 0.0;
  for (std::size_t i = 1; i < model.areas.size(); ++i)
    model.areas[i - 1].to_m = model.areas[i].from_m;
  model.areas.back().to_m = path.length();
  return model;
}

}  // namespace vigia::planner
