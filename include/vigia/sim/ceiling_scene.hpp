#pragma once

#include <cstdint>
#include <memory>

#include "vigia/core/ceiling_grid.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/sim/ceiling_truth.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {

/// A building whose ceiling has patches and lamps, as a camera sees it.
class CeilingScene {
 public:
  CeilingScene(const WorldMap& world, const Appearance& look, const CeilingTruth& ceiling,
               std::uint64_t seed);
  ~CeilingScene();
  CeilingScene(CeilingScene&&) noexcept;
  CeilingScene& operator=(CeilingScene&&) noexcept;

  /// As Scene::expose(). The frame must not outlive the scene.
  std::unique_ptr<imaging::Frame> expose(const Eigen::Isometry3d& wMc, const CameraModel& model,
                                         Stamp stamp, const ImagingParams& params) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vigia::sim
