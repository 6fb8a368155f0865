#include "robot_parts.hpp"

#include "ptz_attention.hpp"
#include "sweep_recovery.hpp"

#include <algorithm>

namespace vigia::mission {
namespace {

/// The camera that an attention directs; rig.cameras.end() when none is on the head.
std::vector<Camera>::const_iterator directed_camera(const Rig& rig) {
  return std::find_if(rig.cameras.begin(), rig.cameras.end(), on_head);
}

}  // namespace

bool on_head(const Camera& camera) {
  return std::holds_alternative<HeadGeometry>(camera.mount);
}

std::vector<CameraFeed> make_feeds(const MissionSetup& setup, const Rig& rig, Duration delay,
                                   Duration processing) {
  std::vector<CameraFeed> feeds;
  for (auto camera = rig.cameras.begin(); camera != rig.cameras.end(); ++camera) {
    const bool directed = camera == directed_camera(rig);
    feeds.emplace_back(*camera, delay, processing,
                       find_name(perception::eyes(), "landmark")
                           ->make({setup.world.landmarks, setup.on_ground(), setup.noise.sensor,
                                   setup.tracker, directed}));
  }
  return feeds;
}

Duration longest_latency(const std::vector<CameraFeed>& feeds) {
  Duration longest;
  for (const CameraFeed& feed : feeds) longest = std::max(longest, feed.latency());
  return longest;
}

std::unique_ptr<Attention> make_attention(const MissionSetup& setup, const Rig& rig,
                                          std::uint64_t seed, EventLog& log) {
  const auto camera = directed_camera(rig);
  if (camera == rig.cameras.end()) return std::make_unique<NoAttention>();
  return std::make_unique<PtzAttention>(setup, camera->id, seed, log);
}

std::unique_ptr<Recovery> make_recovery(const MissionSetup& setup, const Rig& rig,
                                        const std::vector<CameraFeed>& feeds, EventLog& log) {
  const auto camera = directed_camera(rig);
  if (camera == rig.cameras.end()) return std::make_unique<WaitRecovery>();
  const auto index = static_cast<std::size_t>(camera - rig.cameras.begin());
  return std::make_unique<SweepRecovery>(setup, feeds[index].eye(), log);
}

}  // namespace vigia::mission
