#include "vigia/sim/kidnapping.hpp"

#include <algorithm>
#include <limits>

namespace vigia::sim {
namespace {

constexpr int kAttempts = 1000;
constexpr double kFromWall = 0.2;    // m, beyond the radius
constexpr double kFromPeople = 0.5;  // m, beyond the radius

}  // namespace

Kidnapping::Kidnapping(const KidnappingParams& params, std::uint64_t seed)
    : params_(params), random_(seed, "kidnapping") {
  when_ = Stamp::from_seconds(random_.uniform(params_.earliest_s, params_.latest_s));
}

std::optional<Pose2> Kidnapping::due(Stamp now, const Pose2& from, double radius_m,
                                     const FloorPlan& plan, const Walkers* people) {
  if (done_ || now < when_) return std::nullopt;
  done_ = true;
  const Eigen::Vector2d low = plan.min_corner();
  const Eigen::Vector2d high = plan.max_corner();
  Pose2 best = from;
  double best_room = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kAttempts && best_room < 0.0; ++i) {
    Pose2 pose;
    pose.x = random_.uniform(low.x(), high.x());
    pose.y = random_.uniform(low.y(), high.y());
    pose.theta = random_.uniform(-kPi, kPi);
    double clearance = plan.clearance(pose.position()) - kFromWall;
    if (people != nullptr)
      clearance = std::min(clearance, people->clearance(pose.position()) - kFromPeople);
    const double room =
        std::min(clearance - radius_m, (pose.position() - from.position()).norm() - params_.min_m);
    if (room <= best_room) continue;
    best = pose;
    best_room = room;
  }
  return best;
}

}  // namespace vigia::sim
