#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/shot.hpp"

namespace vigia {

/// A camera that does not move on the base.
struct FixedMount {
  Eigen::Isometry3d rMc = Eigen::Isometry3d::Identity();
};

/// Turned by the head, or fixed to the base.
using CameraMount = std::variant<HeadGeometry, FixedMount>;

/// rMc of a camera so mounted when the head stands at @p head.
Eigen::Isometry3d mounted_camera(const CameraMount& mount, const HeadAngles& head);

/// A motorised zoom, or optics that do not change.
using Optics = std::variant<ZoomCalibration, CameraModel>;

/// The focal length by the zoom's position: of a pinhole that does not zoom a table of one row at
/// 0 mm, of other optics nothing.
std::optional<ZoomCalibration> zoom_calibration(const Optics& optics);

/// One camera of a robot, as the robot knows it.
struct Camera {
  CameraId id = 0;
  CameraMount mount;
  Optics optics = ZoomCalibration{};
  double period_s = 0.0;   ///< between two exposures; 0: one in every tick
  double phase_s = 0.0;    ///< of the first exposure
  double latency_s = 0.0;  ///< from the middle of the exposure to the delivery

  /// Where it is in the base frame when the head stands at @p head.
  Eigen::Isometry3d rMc(const HeadAngles& head) const;
  /// Its model at a zoom position, which fixed optics do not have.
  CameraModel model(double zoom_mm) const;
};

/// The cameras of a robot. At least one, with ids of their own.
struct Rig {
  std::vector<Camera> cameras{Camera{}};

  /// The camera of that id, or nullptr.
  const Camera* find(CameraId id) const;
  /// The camera of that id, which the rig must have: std::out_of_range.
  const Camera& at(CameraId id) const;
};

bool on_head(const Camera& camera);
/// Fixed to the base, a pinhole, its axis within 45° of the vertical.
bool looks_up(const Camera& camera);

/// The camera that an attention directs: the first on the head that is a pinhole, with a zoom or
/// without, or nullptr.
const Camera* directed_camera(const Rig& rig);

/// A pair of level pinhole cameras on the base that look ahead, alike and at one height, to the
/// left and the right of the base's x axis by half the baseline, the left one first; they expose
/// and deliver together.
struct StereoCameras {
  CameraId left = 0;
  CameraId right = 1;
  double baseline_m = 0.0;
  double forward_m = 0.0;  ///< x of their centres
  double height_m = 0.0;
  Intrinsics intrinsics;  ///< of both
};

/// The pair of a rig that is nothing else, if it is one.
std::optional<StereoCameras> stereo_cameras(const Rig& rig);

/// What places a robot's cameras in the world.
struct RigOnGround {
  Rig rig;
  Ground ground;

  /// wMc of a camera on a robot at @p pose whose head stands at @p head.
  Eigen::Isometry3d wMc(CameraId camera, const HeadAngles& head, const Pose2& pose) const {
    return ground.place(pose) * rig.at(camera).rMc(head);
  }
};

/// The rig of one camera, of id 0, on a head.
Rig head_rig(const HeadGeometry& geometry, Optics optics = ZoomCalibration{});

}  // namespace vigia
