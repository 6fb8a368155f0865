#include "ray_samples.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::tracking {
namespace {

/// Whiteness of a colour is axis·colour + offset.
struct WhiteAxis {
  float r;
  float g;
  float b;
  float offset;
};

WhiteAxis white_axis(const FieldColours& colours) {
  const Eigen::Vector3d difference = colours.white_mean - colours.green_mean;
  const Eigen::Vector3d axis = difference / difference.squaredNorm();
  const Eigen::Vector3f a = axis.cast<float>();
  return {a.x(), a.y(), a.z(), static_cast<float>(-axis.dot(colours.green_mean))};
}

float whiteness_of(const WhiteAxis& axis, const vpRGBa& pixel) {
  return axis.r * static_cast<float>(pixel.R) + axis.g * static_cast<float>(pixel.G) +
         axis.b * static_cast<float>(pixel.B) + axis.offset;
}

/// σ of a pixel's whiteness from second differences along green stretches of the rays, by their
/// median, which edges do not move.
double whiteness_noise(const RadialPlan& plan, const RaySamples& samples, double quantum) {
  constexpr int kStride = 5;
  constexpr std::size_t kEnough = 40;
  constexpr double kMedianToSigma = 1.4826;
  std::vector<float> sizes;
  for (const PlannedRay& ray : plan.rays)
    for (int i = 1; i + 1 < ray.count; i += kStride) {
      const auto at = static_cast<std::size_t>(ray.first) + static_cast<std::size_t>(i);
      if (samples.classes[at - 1] != FieldClass::green ||
          samples.classes[at] != FieldClass::green || samples.classes[at + 1] != FieldClass::green)
        continue;
      const float bend =
          samples.whiteness[at - 1] - 2.0F * samples.whiteness[at] + samples.whiteness[at + 1];
      const float variance = plan.samples[at - 1].variance() + 4.0F * plan.samples[at].variance() +
                             plan.samples[at + 1].variance();
      sizes.push_back(std::abs(bend) / std::sqrt(variance));
    }
  // A level's rounding is noise, too, where there is no other.
  const double rounding = quantum / std::sqrt(12.0);
  if (sizes.size() < kEnough) return rounding;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max(rounding, kMedianToSigma * static_cast<double>(*middle));
}

}  // namespace

Eigen::Vector3f RaySamples::rgb(const PlannedSample& sample) const {
  const vpRGBa& near = pixels[static_cast<std::size_t>(sample.near)];
  const vpRGBa& far = pixels[static_cast<std::size_t>(sample.far)];
  return (1.0F - sample.share) * Eigen::Vector3f(near.R, near.G, near.B) +
         sample.share * Eigen::Vector3f(far.R, far.G, far.B);
}

void read_samples(const imaging::Frame& frame, const RadialPlan& plan, const FieldPalette& palette,
                  RaySamples& samples) {
  samples.pixels.resize(plan.pixels);
  samples.whiteness.resize(plan.samples.size());
  samples.classes.resize(plan.samples.size());
  frame.read_colour_runs(plan.runs, samples.pixels.data());
  const WhiteAxis axis = white_axis(palette.colours());
  for (std::size_t i = 0; i < plan.samples.size(); ++i) {
    const PlannedSample& sample = plan.samples[i];
    const vpRGBa& near = samples.pixels[static_cast<std::size_t>(sample.near)];
    const vpRGBa& far = samples.pixels[static_cast<std::size_t>(sample.far)];
    samples.whiteness[i] =
        (1.0F - sample.share) * whiteness_of(axis, near) + sample.share * whiteness_of(axis, far);
    samples.classes[i] = palette(sample.share < 0.5F ? near : far);
  }
  const double quantum = Eigen::Vector3d(axis.r, axis.g, axis.b).norm();
  samples.noise = whiteness_noise(plan, samples, quantum);
}

}  // namespace vigia::tracking
