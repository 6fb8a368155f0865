#pragma once

#include "attention.hpp"
#include "camera_feed.hpp"
#include "event_log.hpp"
#include "recovery.hpp"

#include <memory>
#include <vector>

#include "vigia/core/rig.hpp"

namespace vigia::mission {

// What looks through a robot's cameras, where it looks and what it does when it is lost, as its rig
// allows. What is made refers to the setup and the log.

/// The name of the eye that looks through a camera of the rig: a stereo pair finds the corners of a
/// field's goals, one that looks up at a patched ceiling finds patches,
/// other perspective cameras look for landmarks, others for a field.
const char* eye_of(const Camera& camera, const WorldMap& world, const Rig& rig);

/// One for each camera of the rig, in its order. @p delay: of every delivery. @p processing: of a
/// frame.
std::vector<CameraFeed> make_feeds(const MissionSetup& setup, const Rig& rig, Duration delay,
                                   Duration processing);
/// From an exposure to its delivery, the longest of the cameras.
Duration longest_latency(const std::vector<CameraFeed>& feeds);

/// Of the camera that the head directs; none where it directs none.
std::unique_ptr<Attention> make_attention(const MissionSetup& setup, const Rig& rig,
                                          std::uint64_t seed, EventLog& log);
std::unique_ptr<Recovery> make_recovery(const MissionSetup& setup, const Rig& rig,
                                        const std::vector<CameraFeed>& feeds, EventLog& log);

}  // namespace vigia::mission
