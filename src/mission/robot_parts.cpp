#include "robot_parts.hpp"

#include "ptz_attention.hpp"
#include "sweep_recovery.hpp"
#include "wander_recovery.hpp"

#include <algorithm>

namespace vigia::mission {

const char* eye_of(const Camera& camera, const WorldMap& world, const Rig& rig) {
  if (world.field && !world.field->goals.empty() && stereo_cameras(rig)) return "stereo";
  if (world.ceiling && looks_up(camera)) return "ceiling";
  return zoom_calibration(camera.optics) ? "landmark" : "field";
}

std::vector<CameraFeed> make_feeds(const MissionSetup& setup, const Rig& rig, Duration delay,
                                   Duration processing) {
  const Camera* directed = directed_camera(rig);
  const auto pair = stereo_cameras(rig);
  std::vector<CameraFeed> feeds;
  for (const Camera& camera : rig.cameras) {
    const bool right = pair && camera.id == pair->right;
    feeds.emplace_back(camera, delay, processing,
                       find_name(perception::eyes(), eye_of(camera, setup.world, rig))
                           ->make({setup.world.landmarks,
                                   setup.on_ground(),
                                   setup.noise.sensor,
                                   setup.tracker,
                                   &camera == directed,
                                   setup.world.field ? &*setup.world.field : nullptr,
                                   {setup.robot.robot.radius_m, setup.robot.robot.body_height_m},
                                   setup.world.ceiling ? &*setup.world.ceiling : nullptr,
                                   right ? &feeds.front().eye() : nullptr}));
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
  const Camera* directed = directed_camera(rig);
  if (directed == nullptr) return std::make_unique<NoAttention>();
  return std::make_unique<PtzAttention>(setup, *directed, seed, log);
}

std::unique_ptr<Recovery> make_recovery(const MissionSetup& setup, const Rig& rig,
                                        const std::vector<CameraFeed>& feeds, EventLog& log) {
  const Camera* directed = directed_camera(rig);
  if (directed == nullptr) return std::make_unique<WanderRecovery>(setup, log);
  const auto index = static_cast<std::size_t>(directed - rig.cameras.data());
  return std::make_unique<SweepRecovery>(setup, feeds[index].eye(), log);
}

}  // namespace vigia::mission
