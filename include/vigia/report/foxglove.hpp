#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/belief.hpp"
#include "vigia/core/camera_model.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/path.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/overlay.hpp"
#include "vigia/report/mcap_writer.hpp"

/// Messages of Foxglove's schemas as JSON. Frames are named by text; poses are in the world's
/// frame.
namespace vigia::report::foxglove {

/// The kinds of message that are written, in alphabetical order.
enum class Message {
  camera_calibration,
  compressed_image,
  frame_transforms,
  image_annotations,
  log,
  odometry,
  pose_in_frame,
  poses_in_frame,
  scene_update,
};

/// Foxglove's own.
const McapSchema& schema(Message message);

inline constexpr const char* kWorldFrame = "world";

/// Where frame @p child lies in frame @p parent.
struct Transform {
  std::string parent;
  std::string child;
  Eigen::Isometry3d parent_M_child = Eigen::Isometry3d::Identity();
};

std::string frame_transforms(Stamp at, const std::vector<Transform>& transforms);
std::string pose_in_frame(Stamp at, const Eigen::Isometry3d& wMr);
std::string poses_in_frame(Stamp at, const std::vector<Eigen::Isometry3d>& wMr);
/// @p body: the frame whose pose it is. @p covariance: of (δp, δφ) in world axes.
std::string odometry(Stamp at, const std::string& body, const Eigen::Isometry3d& wMr,
                     const Eigen::Matrix<double, 6, 6>& covariance);
/// @p jpeg: a file's bytes.
std::string compressed_image(Stamp at, const std::string& frame, std::string_view jpeg);
/// What is not finite is left out.
std::string image_annotations(Stamp at, const imaging::Overlay& overlay);
/// Nothing for a mirror camera, whose model the schema does not know. The distortion is the series
/// of the camera's own to the seventh power of the distance from the middle.
std::optional<std::string> camera_calibration(Stamp at, const std::string& frame,
                                              const CameraModel& model);

enum class LogLevel { info = 2, warning = 3, error = 4 };
std::string log(Stamp at, LogLevel level, const std::string& name, const std::string& message);

/// Walls, landmarks, field, ceiling and the planned route, in space.
std::string world_scene(Stamp at, const WorldMap& world, const Path& route);
/// A cylinder in the frame @p frame, which it follows.
std::string robot_scene(Stamp at, const std::string& frame, double radius_m);

/// What one localizer believes.
struct NamedBelief {
  std::string name;
  const Belief* belief = nullptr;
};
/// The 95 % ellipse of each belief, or of its hypotheses, on the ground; σ and status as metadata.
std::string beliefs_scene(Stamp at, const std::vector<NamedBelief>& beliefs, const Ground& ground);

}  // namespace vigia::report::foxglove
