#include "vigia/tracking/radial_scan.hpp"

#include "colour_search.hpp"
#include "light_status.hpp"
#include "line_search.hpp"
#include "radial_plan.hpp"
#include "ray_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace vigia::tracking {
namespace {

int rays_of(const RadialScanParams& params) {
  const double rays = std::round(2.0 * kPi / params.ray_step);
  if (!(rays >= 4.0 && rays <= 3600.0))
    throw std::invalid_argument("RadialScanParams: ray_step must lie in [0.1°, 90°]");
  return static_cast<int>(rays);
}

MirrorImage image_of(const FloorView& view) {
  // The mirror's edge, by the projection of the unified model.
  const double z = min_z(view.mirror);
  const double edge = std::sqrt(std::max(0.0, 1.0 - z * z)) / (z + view.mirror.xi);
  return {{view.mirror.u0, view.mirror.v0}, view.inner_px, std::abs(view.mirror.px) * edge};
}

double scan_median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector3d mean_green(const RadialPlan& plan, const RaySamples& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < plan.samples.size(); ++i) {
    if (samples.classes[i] != FieldClass::green) continue;
    const vpRGBa& pixel = samples.pixels[static_cast<std::size_t>(plan.samples[i].near)];
    sum += Eigen::Vector3d(pixel.R, pixel.G, pixel.B);
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : sum;
}

void count_classes(const RaySamples& samples, RadialScan& scan) {
  for (const FieldClass of : samples.classes) scan.shares[static_cast<std::size_t>(of)] += 1.0;
  for (double& share : scan.shares)
    share /= static_cast<double>(std::max<std::size_t>(1, samples.classes.size()));
}

}  // namespace

std::optional<Eigen::Vector2d> floor_point(const FloorView& view, const Eigen::Vector2d& uv) {
  constexpr double kShallowest = 1e-3;  // rad below the horizon
  const auto direction_c = ray(view.mirror, uv);
  if (!direction_c) return std::nullopt;
  const Eigen::Vector3d direction_r = view.rMc.linear() * *direction_c;
  if (direction_r.z() > -kShallowest) return std::nullopt;
  const Eigen::Vector3d& eye_r = view.rMc.translation();
  return (eye_r - direction_r * (eye_r.z() / direction_r.z())).head<2>();
}

Eigen::Vector2d RadialScan::pixel(int ray, double radius_px) const {
  return centre + radius_px * Eigen::Vector2d(std::cos(angle(ray)), std::sin(angle(ray)));
}

class RadialScanner::State {
 public:
  State(std::optional<FloorView> view, MirrorImage mirror, FieldPalette palette,
        const RadialScanParams& params)
      : view_(std::move(view)),
        mirror_(std::move(mirror)),
        palette_(std::move(palette)),
        params_(params),
        rays_(rays_of(params)) {}

  RadialScan scan(const imaging::Frame& frame) {
    if (plan_.width != frame.width() || plan_.height != frame.height())
      plan_ = plan_rays(mirror_, rays_, frame.width(), frame.height());
    read_samples(frame, plan_, palette_, samples_);
    RadialScan scan;
    scan.centre = mirror_.centre;
    scan.rays = rays_;
    scan.noise = samples_.noise;
    LineSearchResult lines =
        search_lines(plan_, samples_, palette_, params_, view_ ? &*view_ : nullptr);
    scan.points = std::move(lines.points);
    scan.refused = lines.refused;
    scan.blur_px = scan_median(std::move(lines.blurs_px));
    ColourSearchResult colours = search_colours(plan_, samples_, params_);
    scan.goals = std::move(colours.goals);
    scan.posts = std::move(colours.posts);
    count_classes(samples_, scan);
    scan.green_mean = mean_green(plan_, samples_);
    scan.light = light_status(palette_, scan);
    return scan;
  }

 private:
  std::optional<FloorView> view_;
  MirrorImage mirror_;
  FieldPalette palette_;
  RadialScanParams params_;
  int rays_;
  RadialPlan plan_;
  RaySamples samples_;
};

RadialScanner::RadialScanner(const MirrorImage& mirror, const FieldPalette& palette,
                             const RadialScanParams& params)
    : state_(std::make_unique<State>(std::nullopt, mirror, palette, params)) {}

RadialScanner::RadialScanner(const FloorView& view, const FieldPalette& palette,
                             const RadialScanParams& params)
    : state_(std::make_unique<State>(view, image_of(view), palette, params)) {}

RadialScanner::~RadialScanner() = default;
RadialScanner::RadialScanner(RadialScanner&&) noexcept = default;

RadialScan RadialScanner::scan(const imaging::Frame& frame) {
  return state_->scan(frame);
}

}  // namespace vigia::tracking
