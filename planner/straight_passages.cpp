#include "straight_passages.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vigia/core/passage.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::planner {
namespace {

using Eigen::Vector2d;
using Polyline = std::vector<Vector2d>;

constexpr double kSettle_m = 0.35;  // straight before the first face and behind the last
constexpr double kCloser_m = 0.05;  // between two places to turn that are tried
constexpr double kOffMiddle_m = 0.01;
constexpr double kEnds_m = 0.05;  // a passage so near to a leg's end is its end's
constexpr int kMaxPassages = 20;

/// The straight way through a passage.
struct Channel {
  Vector2d from;
  Vector2d to;
};

/// How far along the passage's middle line from its narrowest place @p p lies.
double along_of(const Passage& passage, const Vector2d& p) {
  return (p - passage.middle).dot(passage.along);
}

/// The place on the middle line farthest beyond @p nearest_m, by kSettle_m at most, where the robot
/// fits and from where it reaches the narrowest place.
std::optional<Vector2d> place_to_turn(const RoomToMove& body, const Passage& passage,
                                      double nearest_m, double sense) {
  for (double more = kSettle_m; more > 0.0; more -= kCloser_m) {
    const Vector2d p = passage.middle + sense * (nearest_m + more) * passage.along;
    if (body.fits(p) && body.passes(p, passage.middle)) return p;
  }
  return std::nullopt;
}

std::optional<Channel> channel_through(const RoomToMove& body, const Path& path,
                                       const Passage& passage, double reach_m) {
  if (!body.fits(passage.middle)) return std::nullopt;
  // On the middle line the faces end to be near somewhat farther out than beside it.
  const double open_m =
      std::sqrt(std::max(0.0, reach_m * reach_m - 0.25 * passage.width_m * passage.width_m));
  const double before_m = std::max(open_m, -along_of(passage, path.at(passage.begin_m)));
  const double behind_m = std::max(open_m, along_of(passage, path.at(passage.end_m)));
  const auto from = place_to_turn(body, passage, before_m, -1.0);
  const auto to = place_to_turn(body, passage, behind_m, 1.0);
  if (!from || !to) return std::nullopt;
  return Channel{*from, *to};
}

/// Whether the path keeps to the passage's middle line all the way through.
bool straight_already(const Path& path, const Passage& passage) {
  for (double s = passage.begin_m; s <= passage.end_m; s += kOffMiddle_m)
    if (std::abs(cross(passage.along, path.at(s) - passage.middle)) > kOffMiddle_m) return false;
  return true;
}

}  // namespace

std::vector<Vector2d> with_straight_passages(const RoomToMove& body, Polyline leg, double reach_m,
                                             const LegPlanner& plan) {
  Polyline done;
  for (int i = 0; i < kMaxPassages && leg.size() > 1; ++i) {
    const Path path(leg);
    std::optional<Channel> channel;
    for (const Passage& passage : find_passages(body.plan(), path, reach_m)) {
      const bool at_an_end = passage.begin_m < kEnds_m || passage.end_m > path.length() - kEnds_m;
      if (at_an_end || straight_already(path, passage)) continue;
      channel = channel_through(body, path, passage, reach_m);
      if (channel) break;
    }
    if (!channel) break;
    const Polyline to_it = plan(leg.front(), channel->from);
    const Polyline rest = plan(channel->to, leg.back());
    if (to_it.empty() || rest.empty()) break;
    done.insert(done.end(), to_it.begin(), to_it.end());
    leg = rest;
  }
  done.insert(done.end(), leg.begin(), leg.end());
  return done;
}

}  // namespace vigia::planner
