#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "vigia/core/image_shift.hpp"
#include "vigia/localization/ceiling_model.hpp"
#include "vigia/sim/ceiling_scene.hpp"
#include "vigia/sim/ceiling_truth.hpp"
#include "vigia/sim/scene.hpp"
#include "vigia/tracking/edge_flow.hpp"
#include "vigia/tracking/patch_finder.hpp"

namespace vigia::evaluation {

/// A hall with a patched ceiling and a camera that looks up, as they truly are beside what the
/// robot knows of them.
struct CeilingSetting {
  sim::CeilingTruth ceiling;
  Intrinsics camera;             ///< 640×480, 60° across unless changed
  double camera_height_m = 0.5;  ///< above the ground; the ceiling 2.2 m above that
  double tilt = 0.0;             ///< rad, of the true camera about tilt_axis
  double tilt_axis = 0.0;        ///< rad from the robot's x
  double height_error = 0.0;     ///< true distance to the ceiling over the known one, less 1
  double contrast = 1.0;         ///< of the ceiling's texture
  sim::ImagingParams imaging;
  std::uint64_t seed = 1;

  CeilingSetting();
  /// As the robot knows it.
  localization::CeilingCamera known_camera() const;
  localization::CeilingCameraErrors true_errors() const;
  tracking::PatchFinderParams finder() const;
};

/// The hall, to be photographed.
class CeilingHall {
 public:
  explicit CeilingHall(const CeilingSetting& setting);
  /// The exposure at a pose; its noise depends on the number.
  std::unique_ptr<imaging::Frame> expose(const Pose2& pose, std::int64_t number) const;

 private:
  CeilingSetting setting_;
  Eigen::Isometry3d rMc_;  ///< true
  sim::CeilingScene scene_;
};

/// What one frame of a drive shows.
struct CeilingFrame {
  Pose2 truth;
  tracking::PatchScan scan;
  std::optional<tracking::EdgeMatch> edges;  ///< from the frame before, as published
  std::optional<ImageShift> flow;            ///< from the frame before, by key frames
  double flow_agreement = 0.0;
};

/// Which flow is computed.
struct CeilingFlows {
  bool published = false;
  bool by_key_frames = false;
};

/// Renders and reads the frames of a drive.
std::vector<CeilingFrame> read_ceiling_drive(const CeilingSetting& setting,
                                             const std::vector<Pose2>& poses,
                                             const CeilingFlows& flows = {});

/// One drive of several.
struct CeilingDrive {
  CeilingSetting setting;
  std::vector<Pose2> poses;
};
std::vector<std::vector<CeilingFrame>> read_ceiling_drives(const std::vector<CeilingDrive>& drives,
                                                           const CeilingFlows& flows, int threads);

/// A straight drive, a frame every @p step_m, the heading its direction.
std::vector<Pose2> straight_poses(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                  double step_m);

/// Eq. 9, mended: the camera's motion by how the picture moved, and the robot's.
ImageShift image_shift(const localization::CeilingCamera& camera, const tracking::EdgeMatch& match);
Pose2 published_motion(const localization::CeilingCamera& camera, const tracking::EdgeMatch& match);

}  // namespace vigia::evaluation
