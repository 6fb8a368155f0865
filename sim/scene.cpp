#include "vigia/sim/scene.hpp"

#include "scene_content.hpp"
#include "scene_frame.hpp"

#include "vigia/core/random.hpp"
#include "vigia/sim/appearance.hpp"

namespace vigia::sim {

struct Scene::Impl {
  SceneContent content;
};

Scene::Scene(const WorldMap& world, const std::shared_ptr<const Appearance>& appearance,
             std::uint64_t seed)
    : impl_(std::make_unique<Impl>(Impl{SceneContent(world, appearance ? *appearance : Appearance{},
                                                     derive_seed(seed, "pixel noise"))})) {}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::unique_ptr<imaging::Frame> Scene::expose(const Eigen::Isometry3d& wMc,
                                              const CameraModel& model, Stamp stamp,
                                              const ImagingParams& params, CameraId camera) const {
  return expose(Exposure{{{wMc, {}}}, std::nullopt}, model, stamp, params, camera);
}

std::unique_ptr<imaging::Frame> Scene::expose(const Exposure& exposure, const CameraModel& model,
                                              Stamp stamp, const ImagingParams& params,
                                              CameraId camera) const {
  const SceneContent& content = impl_->content;
  const PixelNoise noise(content.seed, camera, stamp);
  const auto frame_of = [&](const Exposure::Instant& instant) {
    return std::make_unique<SceneFrame>(content, instant, exposure.light, model, noise, params);
  };
  if (exposure.instants.size() == 1) return frame_of(exposure.instants.front());
  std::vector<std::unique_ptr<Radiance>> instants;
  for (const Exposure::Instant& instant : exposure.instants) instants.push_back(frame_of(instant));
  return std::make_unique<BlurredFrame>(std::move(instants), image_width(model),
                                        image_height(model), noise, params);
}

}  // namespace vigia::sim
