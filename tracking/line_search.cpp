#include "line_search.hpp"

#include "stripe_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vigia::tracking {
namespace {

/// Samples [begin, end) of a ray that are brighter than its ground.
struct BrightRun {
  int begin = 0;
  int end = 0;
};

/// Searches one ray.
class RaySearch {
 public:
  RaySearch(const RadialPlan& plan, const RaySamples& samples, const FieldPalette& palette,
            const RadialScanParams& params, int ray)
      : plan_(plan),
        samples_(samples),
        palette_(palette),
        params_(params),
        ray_(plan.rays[static_cast<std::size_t>(ray)]),
        rise_(std::max(params.min_contrast, params.min_significance * samples.noise)) {}

  /// Runs that rise above the green before them by the least contrast and fall again.
  std::vector<BrightRun> bright_runs() const {
    constexpr float kAdapt = 0.25F;
    const int longest = static_cast<int>(params_.max_line_px / ray_.step_px);
    std::vector<BrightRun> runs;
    std::optional<float> ground;
    for (int i = 0; i < ray_.count; ++i) {
      const float value = whiteness(i);
      if (!ground) {
        if (is_green(i)) ground = value;
        continue;
      }
      if (value <= *ground + static_cast<float>(rise_)) {
        // What is darker than green is no ground of a line.
        if (is_green(i)) *ground += kAdapt * (value - *ground);
        continue;
      }
      BrightRun run{i, i};
      while (run.end < ray_.count && run.end - run.begin <= longest &&
             whiteness(run.end) > *ground + static_cast<float>(rise_))
        ++run.end;
      if (run.end < ray_.count && run.end - run.begin <= longest)
        runs.push_back(run);
      else
        ground.reset();
      i = run.end - 1;
    }
    return runs;
  }

  /// Green before and after, where the blur has ended.
  bool on_green(const BrightRun& run) const {
    return green_from(run.begin - 1, -1) && green_from(run.end, 1);
  }

  /// Whether what a run has more than the green beside it has the colour of white.
  bool white_on_green(const BrightRun& run) const {
    const int beside = 1 + blur_samples();
    const Eigen::Vector3f ground = 0.5F * (rgb(run.begin - beside) + rgb(run.end - 1 + beside));
    Eigen::Vector3f excess = Eigen::Vector3f::Zero();
    for (int i = run.begin; i < run.end; ++i) excess += rgb(i) - ground;
    const Eigen::Vector3f white =
        (palette_.colours().white_mean - palette_.colours().green_mean).cast<float>();
    return static_cast<double>(excess.dot(white)) >=
           params_.min_whiteness * static_cast<double>(excess.norm() * white.norm());
  }

  std::optional<StripeFit> fit(const BrightRun& run) const {
    const int beside = 3 + blur_samples();
    const int begin = std::max(0, run.begin - beside);
    const int end = std::min(ray_.count, run.end + beside);
    if (end - begin > StripeProfile::kMost) return std::nullopt;
    StripeProfile profile;
    profile.count = end - begin;
    profile.start_px = ray_.radius(begin);
    profile.step_px = ray_.step_px;
    for (int i = begin; i < end; ++i) {
      const auto at = static_cast<std::size_t>(i - begin);
      profile.values[at] = static_cast<double>(whiteness(i));
      profile.variances[at] =
          samples_.noise * samples_.noise * static_cast<double>(sample(i).variance());
    }
    return fit_stripe(profile, run.begin - begin, run.end - begin, {1.0, params_.blur_px});
  }

 private:
  std::size_t index(int i) const { return static_cast<std::size_t>(ray_.first + i); }
  float whiteness(int i) const { return samples_.whiteness[index(i)]; }
  const PlannedSample& sample(int i) const { return plan_.samples[index(i)]; }
  bool is_green(int i) const { return samples_.classes[index(i)] == FieldClass::green; }
  Eigen::Vector3f rgb(int i) const {
    return samples_.rgb(sample(std::clamp(i, 0, ray_.count - 1)));
  }
  int blur_samples() const {
    return static_cast<int>(std::ceil(1.5 * params_.blur_px / ray_.step_px));
  }

  /// Whether the samples from @p i on, after those of an edge's blur, are green.
  bool green_from(int i, int step) const {
    int green = 0;
    for (int k = 0; k < blur_samples() + params_.min_green_px; ++k, i += step) {
      if (i < 0 || i >= ray_.count) return false;
      green = is_green(i) ? green + 1 : 0;
    }
    return green >= params_.min_green_px;
  }

  const RadialPlan& plan_;
  const RaySamples& samples_;
  const FieldPalette& palette_;
  const RadialScanParams& params_;
  const PlannedRay& ray_;
  double rise_;
};

/// Whether a stripe is as wide on the floor as a line of the field that runs at no more than the
/// greatest slant to the ray.
bool has_line_width(const FloorView& view, const RadialPlan& plan, int ray, const StripeFit& fit,
                    const RadialScanParams& params) {
  constexpr double kSigmas = 3.0;
  constexpr double kTolerance = 0.3;  // of the width
  const double angle = 2.0 * kPi * ray / static_cast<double>(plan.rays.size());
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d middle(view.mirror.u0, view.mirror.v0);
  const auto width = [&](double width_px) -> std::optional<double> {
    const auto inner = floor_point(view, middle + (fit.centre_px - 0.5 * width_px) * along);
    const auto outer = floor_point(view, middle + (fit.centre_px + 0.5 * width_px) * along);
    if (!inner || !outer) return std::nullopt;
    return (*outer - *inner).norm();
  };
  const auto least = width(std::max(0.0, fit.width_px - kSigmas * fit.width_sigma_px));
  const auto most = width(fit.width_px + kSigmas * fit.width_sigma_px);
  if (!least) return false;
  const double widest = params.line_width_m / std::cos(params.max_slant);
  return *least <= widest * (1.0 + kTolerance) &&
         (!most || *most >= params.line_width_m * (1.0 - kTolerance));
}

}  // namespace

LineSearchResult search_lines(const RadialPlan& plan, const RaySamples& samples,
                              const FieldPalette& palette, const RadialScanParams& params,
                              const FloorView* view) {
  LineSearchResult result;
  const auto refuse = [&](RunFault fault) { ++result.refused[static_cast<std::size_t>(fault)]; };
  for (int k = 0; k < static_cast<int>(plan.rays.size()); ++k) {
    const RaySearch search(plan, samples, palette, params, k);
    for (const BrightRun& run : search.bright_runs()) {
      if (!search.on_green(run)) {
        refuse(RunFault::no_green);
        continue;
      }
      if (!search.white_on_green(run)) {
        refuse(RunFault::wrong_colour);
        continue;
      }
      const auto fit = search.fit(run);
      if (!fit || fit->misfit > params.max_misfit) {
        refuse(RunFault::misfit);
        continue;
      }
      if (view != nullptr && !has_line_width(*view, plan, k, *fit, params)) {
        refuse(RunFault::wrong_width);
        continue;
      }
      // What the profile has beside the model, the centre's error has, too.
      const double sigma = fit->centre_sigma_px * std::sqrt(std::max(1.0, fit->misfit));
      result.points.push_back({k, fit->centre_px - 0.5 * fit->width_px,
                               fit->centre_px + 0.5 * fit->width_px, sigma, fit->height});
      result.blurs_px.push_back(fit->blur_px);
    }
  }
  return result;
}

}  // namespace vigia::tracking
