#include "vigia/sim/ceiling_scene.hpp"

#include "scene_content.hpp"
#include "scene_frame.hpp"

#include <optional>

#include "vigia/core/random.hpp"

namespace vigia::sim {

struct CeilingScene::Impl {
  SceneContent content;
};

CeilingScene::CeilingScene(const WorldMap& world, const Appearance& look,
                           const CeilingTruth& ceiling, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(
          Impl{SceneContent(world, look, derive_seed(seed, "pixel noise"))})) {
  impl_->content.hang(ceiling, world.plan);
}

CeilingScene::~CeilingScene() = default;
CeilingScene::CeilingScene(CeilingScene&&) noexcept = default;
CeilingScene& CeilingScene::operator=(CeilingScene&&) noexcept = default;

std::unique_ptr<imaging::Frame> CeilingScene::expose(const Eigen::Isometry3d& wMc,
                                                     const CameraModel& model, Stamp stamp,
                                                     const ImagingParams& params) const {
  const PixelNoise noise(impl_->content.seed, 0, stamp);
  return std::make_unique<SceneFrame>(impl_->content, Exposure::Instant{wMc, {}}, std::nullopt,
                                      model, noise, params);
}

}  // namespace vigia::sim
