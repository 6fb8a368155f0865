#include "passage_guard.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kNarrow_m = 0.15;        // beside the robot: what is wider asks for nothing
constexpr double kNear_m = 1.2;           // before a passage, where the walls begin to be matched
constexpr double kPast_m = 0.5;           // behind it, where that ends
constexpr double kGate_m = 0.25;          // before it, where a robot that must not enter stops
constexpr double kNoDetour_m = 0.5;       // before it, from where nothing is driven round
constexpr double kStartsInside_m = 0.05;  // of a path that begins nearer to it
constexpr double kFullSpeed_m = 0.12;     // beside the robot: driven at the base's speed
constexpr double kSlowest = 0.35;         // of that speed
constexpr double kInSigmas = 3.0;         // that must fit beside the robot
constexpr double kTracking_m = 0.01;      // how well a straight line is followed
constexpr double kPatience_s = 5.0;       // before a gate, until the passage is refused
constexpr double kDisagrees_s = 1.0;      // after which the match begins anew …
constexpr double kAnew = 2.0;             // … with so many times the belief's σ
constexpr double kWallsWithin_m = 0.9;
constexpr double kWallStep_m = 0.02;
constexpr double kKeptBeside_m = 0.025;

}  // namespace

PassageGuard::PassageGuard(const FloorPlan& plan, double robot_radius_m, BaseLimits limits,
                           const RingParams& ring)
    : plan_(&plan), robot_radius_m_(robot_radius_m), limits_(limits), fix_(plan, ring) {}

void PassageGuard::follow(const Path& path) {
  passages_ = find_passages(*plan_, path, robot_radius_m_ + kNarrow_m);
  path_ = path;
  near_ = nullptr;
  held_s_ = 0.0;
}

/// A robot may start and end in a narrow place.
bool PassageGuard::leads_through(const Passage& passage) const {
  return passage.begin_m > kStartsInside_m && passage.end_m < path_.length() - robot_radius_m_;
}

bool PassageGuard::inside(double station) const {
  return near_ != nullptr && leads_through(*near_) && station >= near_->begin_m - kNoDetour_m &&
         station <= near_->end_m;
}

double PassageGuard::path_off(const Passage& passage) const {
  double farthest = 0.0;
  for (double s = passage.begin_m; s <= passage.end_m; s += kWallStep_m)
    farthest = std::max(farthest, std::abs(cross(passage.along, path_.at(s) - passage.middle)));
  return farthest;
}

double PassageGuard::room_beside(const Passage& passage) const {
  return 0.5 * passage.width_m - robot_radius_m_;
}

void PassageGuard::sense(const PilotInput& input, double station) {
  const auto it = std::find_if(passages_.begin(), passages_.end(), [station](const Passage& p) {
    return station >= p.begin_m - kNear_m && station <= p.end_m + kPast_m;
  });
  // A lost robot's passage is another.
  const bool none = it == passages_.end() || input.belief.status == BeliefStatus::lost;
  const Passage* near = none ? nullptr : &*it;
  const bool begins = near != nullptr && near_ == nullptr;
  if (near != near_) held_s_ = 0.0;
  near_ = near;
  if (near_ == nullptr) return;
  if (begins || disagreed_s_ > kDisagrees_s) {
    fix_.begin(input.belief, begins ? 1.0 : kAnew);
    disagreed_s_ = 0.0;
  } else {
    fix_.predict(input.odometry);
  }
  if (input.scan == nullptr || (scanned_ && *scanned_ == input.scan->stamp)) return;
  const double dt = scanned_ ? (input.scan->stamp - *scanned_).seconds() : 0.0;
  scanned_ = input.scan->stamp;
  fix_.update(*input.scan);
  disagreed_s_ = fix_.agrees() ? 0.0 : disagreed_s_ + std::min(dt, kDisagrees_s);
}

const Pose2& PassageGuard::base(const Belief& belief) const {
  return fixed() ? fix_.pose() : belief.pose;
}

PoseDoubt PassageGuard::doubt(const Belief& belief) const {
  Belief claimed = belief;
  if (fixed()) claimed.covariance = fix_.covariance();
  return {claimed.position_sigma(), std::sqrt(std::max(claimed.covariance(2, 2), 0.0))};
}

PassageOrder PassageGuard::order(const Belief& belief, double station, double dt) {
  PassageOrder order{limits_.speed, false, std::nullopt};
  if (near_ == nullptr) return order;
  const double room_m = room_beside(*near_);
  const double inside = limits_.speed * std::clamp(room_m / kFullSpeed_m, kSlowest, 1.0);
  const double away_m = std::max({0.0, near_->begin_m - station, station - near_->end_m});
  order.speed =
      std::min(limits_.speed, std::hypot(inside, braking_rate(limits_.acceleration, away_m)));
  const bool at_gate = station >= near_->begin_m - kGate_m && station <= near_->begin_m;
  if (!at_gate || !leads_through(*near_)) return order;

  const Vector2d normal(-near_->along.y(), near_->along.x());
  const double belief_sigma =
      std::sqrt(normal.dot(belief.covariance.topLeftCorner<2, 2>() * normal));
  const double sigma_m = fixed() ? fix_.sigma_across(near_->along) : belief_sigma;
  const double off_m = std::abs(cross(near_->along, base(belief).position() - near_->middle));
  const bool known = kInSigmas * sigma_m + kTracking_m <= room_m;
  // A path that leads through obliquely, round somebody behind the door, would not be braked for
  // there, but at the frame.
  const bool straight = path_off(*near_) + kTracking_m <= room_m - beside_m();
  const bool aligned = straight && kInSigmas * sigma_m + off_m <= room_m;
  if (known && aligned) {
    held_s_ = 0.0;
    return order;
  }
  order.hold = true;
  held_s_ += dt;
  if (held_s_ < kPatience_s) return order;
  held_s_ = 0.0;
  order.refused = PassageRefusal{near_->middle, near_->width_m, room_m, sigma_m, known};
  return order;
}

std::vector<Hazard> PassageGuard::hazards(const std::vector<Hazard>& seen, const EchoMemory& memory,
                                          const Belief& belief) const {
  if (!fixed()) return seen;
  std::vector<Hazard> hazards;
  for (const Echo& echo : memory.echoes())
    if (memory.confirmed(echo)) hazards.push_back({echo.front_r, false});
  const Pose2& here = base(belief);
  const double c = std::cos(here.theta);
  const double s = std::sin(here.theta);
  for (const Wall& face : plan_->faces()) {
    if (distance_to_segment(here.position(), face.a, face.b) > kWallsWithin_m) continue;
    const Vector2d ab = face.b - face.a;
    const int steps = static_cast<int>(std::ceil(ab.norm() / kWallStep_m));
    for (int i = 0; i <= steps; ++i) {
      const Vector2d d = face.a + ab * i / steps - here.position();
      if (d.norm() > kWallsWithin_m) continue;
      hazards.push_back({{c * d.x() + s * d.y(), -s * d.x() + c * d.y()}, true});
    }
  }
  return hazards;
}

double PassageGuard::beside_m() const {
  return near_ == nullptr ? kKeptBeside_m : std::min(kKeptBeside_m, 0.5 * room_beside(*near_));
}

}  // namespace vigia::pilot
