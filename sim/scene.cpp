#include "vigia/sim/scene.hpp"

#include "scene_content.hpp"
#include "scene_frame.hpp"

#include "vigia/core/random.hpp"
#include "vigia/sim/appearance.hpp"

namespace vigia::sim {
namespace {

/// i in base 2, mirrored at the point: spreads evenly over [0, 1).
double radical_inverse(int i) {
  double inverse = 0.0;
  for (double digit = 0.5; i > 0; i /= 2, digit *= 0.5) inverse += digit * (i % 2);
  return inverse;
}

/// The model whose pixels' middles are the sample @p i of @p count of @p model's pixels:
/// Hammersley's points, whose columns part the pixel evenly.
CameraModel sample_of(CameraModel model, int i, int count) {
  const Eigen::Vector2d offset((i + 0.5) / count - 0.5, radical_inverse(i) + 0.5 / count - 0.5);
  std::visit(
      [&](auto& shifted) {
        shifted.u0 -= offset.x();
        shifted.v0 -= offset.y();
      },
      model);
  return model;
}

}  // namespace

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
  const auto frame_of = [&](const Exposure::Instant& instant, const CameraModel& seen_by,
                            const ImagingParams& imaging) {
    return std::make_unique<SceneFrame>(content, instant, exposure.light, seen_by, noise, imaging);
  };
  const bool sampled = params.samples > 1;
  if (exposure.instants.size() == 1 && !sampled)
    return frame_of(exposure.instants.front(), model, params);
  ImagingParams each = params;
  if (sampled) each.blur_px = 0.0;  // the lens blurs the mean
  std::vector<std::unique_ptr<Radiance>> parts;
  for (const Exposure::Instant& instant : exposure.instants)
    for (int i = 0; i < params.samples; ++i)
      parts.push_back(
          frame_of(instant, sampled ? sample_of(model, i, params.samples) : model, each));
  return std::make_unique<BlurredFrame>(std::move(parts), image_width(model), image_height(model),
                                        noise, params, sampled ? params.blur_px : 0.0);
}

}  // namespace vigia::sim
