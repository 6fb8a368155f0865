#include "line_search.hpp"

#include "stripe_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

namespace vigia::tracking {
namespace {

/// Samples [begin, end) of a ray that are brighter than its ground.
struct BrightRun {
  int begin = 0;
  int end = 0;
};

constexpr double kModelError = 0.010;  // of a stripe's height, a sample

/// By how much a stripe's edges move along the ray in one pixel along its minor axis, px.
struct EdgeSlopes {
  double inner = 0.0;
  double outer = 0.0;
  double sigma = 0.1;  ///< of either
  double mean() const { return 0.5 * (inner + outer); }
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
        rise_(std::max(params.min_contrast, params.min_significance * samples.noise)) {
    const Eigen::Vector3d white = palette.colours().white_mean - palette.colours().green_mean;
    axis_ = white / white.squaredNorm();
  }

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

  /// The carpet's colour beside a run.
  Eigen::Vector3f ground_beside(const BrightRun& run) const {
    const int beside = 1 + blur_samples();
    return 0.5F * (rgb(run.begin - beside) + rgb(run.end - 1 + beside));
  }

  /// Whether what a run has more than the green beside it has the colour of white.
  bool white_on_green(const BrightRun& run) const {
    const Eigen::Vector3f ground = ground_beside(run);
    Eigen::Vector3f excess = Eigen::Vector3f::Zero();
    for (int i = run.begin; i < run.end; ++i) excess += rgb(i) - ground;
    const Eigen::Vector3f white =
        (palette_.colours().white_mean - palette_.colours().green_mean).cast<float>();
    return static_cast<double>(excess.dot(white)) >=
           params_.min_whiteness * static_cast<double>(excess.norm() * white.norm());
  }

  /// The stripe of a run, of whose neighbours on the ray it keeps clear: @p after is where the one
  /// before it ends, @p until where the next begins.
  std::optional<StripeFit> fit(const BrightRun& run, int after, int until) const {
    // A neighbour's blur reaches two samples before its own begin.
    constexpr int kReach = 2;
    const int begin = std::max(run.begin - carpet_beside(run.begin - 1, -1),
                               std::min(run.begin - 1, after + kReach));
    const int end =
        std::min(run.end + carpet_beside(run.end, 1), std::max(run.end + 1, until - kReach));
    if (begin < 0 || end > ray_.count) return std::nullopt;
    if (end - begin > StripeProfile::kMost) return std::nullopt;
    float top = 0.0F;
    for (int i = run.begin; i < run.end; ++i) top = std::max(top, whiteness(i));
    // What no model of a stripe describes: mixtures of pixels, a ground that is not even.
    const double model = kModelError * static_cast<double>(top - whiteness(begin));
    StripeProfile profile;
    profile.count = end - begin;
    profile.start_px = ray_.radius(begin);
    profile.step_px = ray_.step_px;
    for (int i = begin; i < end; ++i) {
      const auto at = static_cast<std::size_t>(i - begin);
      profile.values[at] = static_cast<double>(whiteness(i));
      profile.variances[at] =
          samples_.noise * samples_.noise * static_cast<double>(sample(i).variance()) +
          model * model;
    }
    return fit_stripe(profile, run.begin - begin, run.end - begin, {1.0, params_.blur_px});
  }

  /// From the differences of the two pixels of each sample: over an edge they add up to its height
  /// times its slope.
  EdgeSlopes slopes(const StripeFit& fit) const {
    const double reach = 3.0 * fit.blur_px;
    const auto sample_at = [&](double radius) {
      const double i = (radius - ray_.start_px) / ray_.step_px;
      return static_cast<int>(std::lround(std::clamp(i, 0.0, ray_.count - 1.0)));
    };
    const auto difference = [&](double from, double to) {
      double sum = 0.0;
      for (int i = sample_at(from); i < sample_at(to); ++i) sum += across(i);
      return sum * ray_.step_px / fit.height;
    };
    const double inner = fit.centre_px - 0.5 * fit.width_px;
    const double outer = fit.centre_px + 0.5 * fit.width_px;
    // A narrow stripe does not rise to its height before it falls.
    const double peak =
        std::max(0.1, std::erf(fit.width_px / (2.0 * std::sqrt(2.0) * fit.blur_px)));
    EdgeSlopes slopes;
    slopes.inner = -difference(inner - reach, std::min(inner + reach, fit.centre_px)) / peak;
    slopes.outer = difference(std::max(outer - reach, fit.centre_px), outer + reach) / peak;
    const double samples = (reach + std::min(reach, 0.5 * fit.width_px)) / ray_.step_px;
    slopes.sigma = samples_.noise * std::sqrt(2.0 * samples) * ray_.step_px / (fit.height * peak);
    return slopes;
  }

 private:
  /// How much whiter the farther of a sample's pixels is.
  double across(int i) const {
    const PlannedSample& at = sample(i);
    const auto white = [&](std::int32_t pixel) {
      const vpRGBa& p = samples_.pixels[static_cast<std::size_t>(pixel)];
      return axis_.dot(Eigen::Vector3d(p.R, p.G, p.B));
    };
    return white(at.far) - white(at.near);
  }
  std::size_t index(int i) const {
    return static_cast<std::size_t>(ray_.first) + static_cast<std::size_t>(i);
  }
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

  /// How many samples from @p i on show the blur of an edge and then the carpet, up to where
  /// something else begins to brighten it.
  int carpet_beside(int i, int step) const {
    int count = 0;
    float ground = 0.0F;
    for (; count < 3 + blur_samples(); ++count, i += step) {
      if (i < 0 || i >= ray_.count) break;
      if (count < blur_samples()) continue;
      if (count == blur_samples()) ground = whiteness(i);
      if (!is_green(i) || whiteness(i) > ground + 0.5F * static_cast<float>(rise_)) break;
    }
    return count;
  }

  const RadialPlan& plan_;
  const RaySamples& samples_;
  const FieldPalette& palette_;
  const RadialScanParams& params_;
  const PlannedRay& ray_;
  double rise_;
  Eigen::Vector3d axis_;  ///< whiteness a level
};

/// Where a ray lies in the image: the pixel at t px from the middle, and the axis across it along
/// which a sample's two pixels are neighbours.
struct RayLine {
  int number = 0;
  Eigen::Vector2d middle;
  Eigen::Vector2d along;
  Eigen::Vector2d minor;
  Eigen::Vector2d at(double t) const { return middle + t * along; }
};

RayLine ray_line(const Eigen::Vector2d& middle, int ray, std::size_t rays) {
  const double angle = 2.0 * kPi * ray / static_cast<double>(rays);
  RayLine line{ray, middle, {std::cos(angle), std::sin(angle)}, Eigen::Vector2d::UnitX()};
  if (std::abs(line.along.x()) >= std::abs(line.along.y())) line.minor = Eigen::Vector2d::UnitY();
  return line;
}

/// Whether a stripe is as wide on the floor, across itself, as a line of the field.
bool has_line_width(const FloorView& view, const RayLine& ray, const StripeFit& fit,
                    const EdgeSlopes& slopes, const RadialScanParams& params) {
  constexpr double kSigmas = 3.0;
  constexpr double kTolerance = 0.3;  // of the width
  constexpr double kSteepest = 4.0;   // slopes beyond are those of a line along the ray
  const double slope = std::clamp(slopes.mean(), -kSteepest, kSteepest);
  const Eigen::Vector2d sideways = slope * ray.along + ray.minor;
  const auto middle = floor_point(view, ray.at(fit.centre_px));
  const auto beside = floor_point(view, ray.at(fit.centre_px) + sideways);
  if (!middle || !beside) return false;
  const Eigen::Vector2d line = (*beside - *middle).normalized();
  const auto width = [&](double width_px) -> std::optional<double> {
    const auto inner = floor_point(view, ray.at(fit.centre_px - 0.5 * width_px));
    const auto outer = floor_point(view, ray.at(fit.centre_px + 0.5 * width_px));
    if (!inner || !outer) return std::nullopt;
    const Eigen::Vector2d across = *outer - *inner;
    return std::abs(line.x() * across.y() - line.y() * across.x());
  };
  // A slope in doubt leaves the width in doubt.
  const double doubt = kTolerance + kSigmas * slopes.sigma;
  const auto least = width(std::max(0.0, fit.width_px - kSigmas * fit.width_sigma_px));
  const auto most = width(fit.width_px + kSigmas * fit.width_sigma_px);
  return least && *least <= params.line_width_m * (1.0 + doubt) &&
         (!most || *most >= params.line_width_m * std::max(0.0, 1.0 - doubt));
}

/// A stripe that may be a line, and how bright the carpet beside it is.
struct Candidate {
  int ray = 0;
  StripeFit fit;
  double light = 1.0;  ///< sum of the carpet's channels, levels
};

/// Two lines so near each other that the blur joins them make a stripe that is wide and yet not as
/// white as the others under the same light.
void drop_joined_lines(std::vector<Candidate>& candidates, LineSearchResult& result) {
  constexpr double kResolved = 2.5;  // blurs: a stripe so wide shows the paint's full white
  constexpr double kLeastWhite = 0.65;
  constexpr std::size_t kEnough = 8;
  const auto resolved = [&](const Candidate& c) {
    return c.fit.width_px > kResolved * c.fit.blur_px;
  };
  const auto white = [&](const Candidate& c) { return c.fit.height / c.light; };
  std::vector<double> whites;
  for (const Candidate& candidate : candidates)
    if (resolved(candidate)) whites.push_back(white(candidate));
  if (whites.size() < kEnough) return;
  const auto upper = whites.begin() + static_cast<std::ptrdiff_t>(whites.size() * 3 / 4);
  std::nth_element(whites.begin(), upper, whites.end());
  const auto joined = [&](const Candidate& c) {
    return resolved(c) && white(c) < kLeastWhite * *upper;
  };
  const auto kept = std::remove_if(candidates.begin(), candidates.end(), joined);
  result.refused[static_cast<std::size_t>(RunFault::misfit)] +=
      static_cast<int>(candidates.end() - kept);
  candidates.erase(kept, candidates.end());
}

/// Whether both edges of a stripe run alike; those of crossing lines or of a rim do not.
bool parallel_edges(const EdgeSlopes& slopes) {
  constexpr double kSigmas = 4.0;
  constexpr double kAlike = 0.35;
  return std::abs(slopes.inner - slopes.outer) <= kAlike + kSigmas * slopes.sigma;
}

/// What a bright run is: a stripe that may be a line, or why it is none. @p view: where the floor
/// is known.
std::variant<Candidate, RunFault> judge(const RaySearch& search, const RayLine& line,
                                        const std::vector<BrightRun>& runs, std::size_t i,
                                        const RadialScanParams& params, const FloorView* view) {
  const BrightRun& run = runs[i];
  if (!search.on_green(run)) return RunFault::no_green;
  if (!search.white_on_green(run)) return RunFault::wrong_colour;
  const int after = i > 0 ? runs[i - 1].end : 0;
  const int until = i + 1 < runs.size() ? runs[i + 1].begin : std::numeric_limits<int>::max() / 2;
  const auto fit = search.fit(run, after, until);
  if (!fit || fit->misfit > params.max_misfit) return RunFault::misfit;
  const EdgeSlopes slopes = search.slopes(*fit);
  if (!parallel_edges(slopes)) return RunFault::misfit;
  if (view != nullptr && !has_line_width(*view, line, *fit, slopes, params))
    return RunFault::wrong_width;
  return Candidate{line.number, *fit, static_cast<double>(search.ground_beside(run).sum())};
}

LinePoint line_point(const Candidate& candidate) {
  // Pixels sample a stripe that is hardly wider than they are too coarsely: where its middle lies
  // between them shows in the fit, by 0.03 px at one pixel of width, whatever the noise.
  constexpr double kSampling_px = 0.038;
  const StripeFit& fit = candidate.fit;
  // What the profile has beside the model, the centre's error has, too.
  const double sigma = std::hypot(fit.centre_sigma_px * std::sqrt(std::max(1.0, fit.misfit)),
                                  kSampling_px / (fit.width_px * fit.width_px));
  return {candidate.ray, fit.centre_px - 0.5 * fit.width_px, fit.centre_px + 0.5 * fit.width_px,
          sigma, fit.height};
}

}  // namespace

LineSearchResult search_lines(const RadialPlan& plan, const RaySamples& samples,
                              const FieldPalette& palette, const RadialScanParams& params,
                              const FloorView* view) {
  LineSearchResult result;
  std::vector<Candidate> candidates;
  for (int k = 0; k < static_cast<int>(plan.rays.size()); ++k) {
    const RaySearch search(plan, samples, palette, params, k);
    const RayLine line = ray_line(plan.middle, k, plan.rays.size());
    const std::vector<BrightRun> runs = search.bright_runs();
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const auto judged = judge(search, line, runs, i, params, view);
      if (const auto* fault = std::get_if<RunFault>(&judged))
        ++result.refused[static_cast<std::size_t>(*fault)];
      else
        candidates.push_back(std::get<Candidate>(judged));
    }
  }
  drop_joined_lines(candidates, result);
  for (const Candidate& candidate : candidates) {
    result.points.push_back(line_point(candidate));
    result.blurs_px.push_back(candidate.fit.blur_px);
  }
  return result;
}

}  // namespace vigia::tracking
