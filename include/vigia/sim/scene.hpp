#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/config.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/shot.hpp"
#include "vigia/core/stamp.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/sim/exposure.hpp"

namespace vigia::sim {

/// How the camera turns light into grey levels.
struct ImagingParams {
  double noise_sigma = 4.0;  ///< grey levels, Gaussian, independent per pixel and frame
  double blur_px = 0.7;      ///< σ of the optical blur at the landmarks' outlines
  bool colour = false;       ///< whether frames carry colour (grey frames are cheaper)
  /// Of which the light of a pixel's square is the mean, and blur_px then blurs every outline. 1:
  /// outlines of surfaces and solids are sharp and a pixel shows what lies in its middle.
  int samples = 1;
};

// Looks of the building: texture of walls, floor and ceiling, light, dark round clutter.
// Read from the world file; see vigia/sim/appearance.hpp.
struct Appearance;

/// The true world as a camera sees it: walls, floor, ceiling and obstacles with texture, discs,
/// patterns and tags on light sheets, lines on floor and ceiling, clutter.
class Scene {
 public:
  Scene(const WorldMap& world, const std::shared_ptr<const Appearance>& appearance,
        std::uint64_t seed);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// The exposure of a camera at wMc whose true model is @p model. The noise of a pixel is a hash
  /// of seed, camera, stamp, u and v. The frame refers to the scene and must not outlive it.
  std::unique_ptr<imaging::Frame> expose(const Eigen::Isometry3d& wMc, const CameraModel& model,
                                         Stamp stamp, const ImagingParams& params,
                                         CameraId camera = 0) const;
  /// The same of a camera and people that move while the shutter is open, in uneven light. @p stamp
  /// is the middle of the exposure, which has at least one instant.
  std::unique_ptr<imaging::Frame> expose(const Exposure& exposure, const CameraModel& model,
                                         Stamp stamp, const ImagingParams& params,
                                         CameraId camera = 0) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads `appearance`, `stripes` and `clutter` of a world file; absent keys have pleasant defaults.
std::shared_ptr<const Appearance> read_appearance(MapReader& reader, const WorldMap& world);

}  // namespace vigia::sim
