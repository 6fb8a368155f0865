#include "vigia/tracking/patch_finder.hpp"

#include "patch_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <Eigen/Eigenvalues>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

using imaging::Window;

/// How much darker than the ceiling beside it a patch of a frame must be.
struct ContrastBound {
  double share = 0.0;  ///< of the ceiling's grey level
  double least = 0.0;  ///< grey levels
  double enough = 0.0;

  double beside(double ground) const { return std::clamp(share * ground, least, enough); }
};

/// A dark stretch of a row between two edges.
struct DarkChord {
  int v = 0;
  double u = 0.0;  ///< middle
  double patch = 0.0;
  double ground = 0.0;
};

/// The connected dark region about a chord.
struct DarkSpot {
  std::vector<std::array<int, 2>> pixels;
  double area = 0.0;
  double darkest = 0.0;  ///< mean level of its darker half
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  bool at_border = false;  ///< reaches the image's border
  bool open = false;       ///< reaches the window's edge elsewhere
};

/// Chords of one row: a falling and the next rising edge, no farther apart than a patch is long.
class ChordFinder {
 public:
  /// @p contrast: of an edge that is looked at.
  ChordFinder(const PatchFinderParams& params, double contrast, int width)
      : params_(params), contrast_(contrast), slope_(static_cast<std::size_t>(width)) {}

  void find(const unsigned char* row, int width, int v, std::vector<DarkChord>& chords) {
    // Three pixels' mean less that four pixels before it, three times over.
    for (int u = 3; u < width - 3; ++u)
      slope_[static_cast<std::size_t>(u)] =
          row[u + 1] + row[u + 2] + row[u + 3] - row[u - 1] - row[u - 2] - row[u - 3];
    const int threshold = static_cast<int>(1.5 * contrast_);
    const int longest = static_cast<int>(1.3 * params_.length_px) + 3;
    int fell = -1;
    for (int u = 4; u < width - 4; ++u) {
      const int d = slope_[static_cast<std::size_t>(u)];
      const int before = slope_[static_cast<std::size_t>(u) - 1];
      const int after = slope_[static_cast<std::size_t>(u) + 1];
      if (d <= -threshold && d <= before && d < after) fell = u;
      const bool rises = d >= threshold && d >= before && d > after;
      if (!rises || fell < 0) continue;
      if (u - fell <= longest && u - fell >= 3) add(row, width, v, fell, u, chords);
      fell = -1;
    }
    add_at_borders(row, width, v, chords);
  }

 private:
  void add(const unsigned char* row, int width, int v, int from, int to,
           std::vector<DarkChord>& chords) const {
    DarkChord chord;
    chord.v = v;
    chord.u = 0.5 * (from + to);
    double sum = 0.0;
    for (int u = from + 1; u < to; ++u) sum += row[u];
    chord.patch = sum / (to - from - 1);
    // The lowest may lie on the patch's tongue, the two of one side on a lamp.
    std::array<unsigned char, 4> beside{row[std::max(0, from - 3)], row[std::max(0, from - 6)],
                                        row[std::min(width - 1, to + 3)],
                                        row[std::min(width - 1, to + 6)]};
    std::sort(beside.begin(), beside.end());
    chord.ground = beside[1];
    if (chord.ground - chord.patch >= 0.7 * contrast_) chords.push_back(chord);
  }
  /// Patches that the image's left or right border cuts have one edge only.
  void add_at_borders(const unsigned char* row, int width, int v,
                      std::vector<DarkChord>& chords) const {
    const int threshold = static_cast<int>(1.5 * contrast_);
    const int longest = static_cast<int>(params_.length_px) + 3;
    for (int u = 4; u < std::min(longest, width - 4); ++u) {
      if (slope_[static_cast<std::size_t>(u)] <= -threshold) break;
      if (slope_[static_cast<std::size_t>(u)] < threshold) continue;
      if (row[0] + contrast_ < row[u + 3])
        chords.push_back({v, 1.0, static_cast<double>(row[0]), static_cast<double>(row[u + 3])});
      break;
    }
    for (int u = width - 5; u > std::max(width - longest, 4); --u) {
      if (slope_[static_cast<std::size_t>(u)] >= threshold) break;
      if (slope_[static_cast<std::size_t>(u)] > -threshold) continue;
      if (row[width - 1] + contrast_ < row[u - 3])
        chords.push_back(
            {v, width - 2.0, static_cast<double>(row[width - 1]), static_cast<double>(row[u - 3])});
      break;
    }
  }

  const PatchFinderParams& params_;
  double contrast_;
  std::vector<int> slope_;
};

PatchWindow read_window(const imaging::Frame& frame, const DarkChord& chord, double reach_px) {
  const int reach = static_cast<int>(std::ceil(reach_px));
  PatchWindow window;
  window.window = intersect(frame.full(), {static_cast<int>(std::lround(chord.u)) - reach,
                                           chord.v - reach, 2 * reach + 1, 2 * reach + 1});
  window.grey.resize(static_cast<std::size_t>(window.window.width) *
                     static_cast<std::size_t>(window.window.height));
  frame.read_grey(window.window, window.grey.data(), window.window.width);
  return window;
}

/// The seed of a fill: the darkest pixel near the chord's middle.
std::array<int, 2> seed_of(const PatchWindow& window, const DarkChord& chord) {
  std::array<int, 2> seed{-1, -1};
  int darkest = 256;
  for (int u = static_cast<int>(chord.u) - 1; u <= static_cast<int>(chord.u) + 2; ++u) {
    if (u < window.window.u || u >= window.window.right()) continue;
    if (window.at(u, chord.v) >= darkest) continue;
    darkest = window.at(u, chord.v);
    seed = {u, chord.v};
  }
  return seed;
}

/// Mean of the darker half.
double dark_level(std::vector<unsigned char>& levels) {
  const auto half = levels.begin() + static_cast<std::ptrdiff_t>((levels.size() + 1) / 2);
  std::nth_element(levels.begin(), half - 1, levels.end());
  double sum = 0.0;
  for (auto at = levels.begin(); at != half; ++at) sum += *at;
  return sum / static_cast<double>(half - levels.begin());
}

DarkSpot fill(const PatchWindow& window, const DarkChord& chord, const Window& frame) {
  DarkSpot spot;
  const std::array<int, 2> seed = seed_of(window, chord);
  const double level = 0.5 * (chord.patch + chord.ground);
  const Window& w = window.window;
  std::vector<char> taken(window.grey.size(), 0);
  const auto take = [&](int u, int v) {
    const int at = (v - w.v) * w.width + (u - w.u);
    const auto index = static_cast<std::size_t>(at);
    if (taken[index] != 0 || window.grey[index] >= level) return;
    taken[index] = 1;
    spot.pixels.push_back({u, v});
  };
  if (seed[0] >= 0) take(seed[0], seed[1]);
  std::vector<unsigned char> levels;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < spot.pixels.size(); ++i) {
    const auto [u, v] = spot.pixels[i];
    const Eigen::Vector2d p(u, v);
    levels.push_back(window.at(u, v));
    sum += p;
    squares += p * p.transpose();
    const bool rim = u == w.u || v == w.v || u == w.right() - 1 || v == w.bottom() - 1;
    const bool border =
        u == frame.u || v == frame.v || u == frame.right() - 1 || v == frame.bottom() - 1;
    spot.at_border = spot.at_border || border;
    spot.open = spot.open || (rim && !border);
    if (u > w.u) take(u - 1, v);
    if (u < w.right() - 1) take(u + 1, v);
    if (v > w.v) take(u, v - 1);
    if (v < w.bottom() - 1) take(u, v + 1);
  }
  spot.area = static_cast<double>(spot.pixels.size());
  if (spot.area < 1.0) return spot;
  spot.darkest = dark_level(levels);
  spot.mean = sum / spot.area;
  spot.covariance = squares / spot.area - spot.mean * spot.mean.transpose();
  return spot;
}

/// The spot at half its own contrast: the chord may have met no more than a corner of it.
DarkSpot dark_spot(const PatchWindow& window, DarkChord& chord, const Window& frame) {
  DarkSpot first = fill(window, chord, frame);
  if (first.area < 1.0) return first;
  chord.patch = first.darkest;
  return fill(window, chord, frame);
}

/// A patch's area by its length times its width.
double filled_share(const PatchFinderParams& params) {
  return params.polarity ? 1.0 - kTongueLength * (1.0 - kTongueWidth) : 1.0;
}

/// Of the pixels along @p axis; positive where they thin out forward, as at a tongue.
double skewness(const DarkSpot& spot, const Eigen::Vector2d& axis) {
  double sum = 0.0;
  for (const auto& [u, v] : spot.pixels) {
    const double along = axis.dot(Eigen::Vector2d(u, v) - spot.mean);
    sum += along * along * along;
  }
  return sum;
}

/// The longer axis of a spot that is one, and forward.
std::optional<Eigen::Vector2d> forward_axis(const DarkSpot& spot, const Eigen::Matrix2d& covariance,
                                            double min_ratio) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  if (axes.eigenvalues()[1] < min_ratio * min_ratio * std::max(axes.eigenvalues()[0], 0.1))
    return std::nullopt;
  const Eigen::Vector2d along = axes.eigenvectors().col(1);
  return skewness(spot, along) < 0.0 ? Eigen::Vector2d(-along) : along;
}

PatchShape lying_along(const Eigen::Vector2d& along, const DarkSpot& spot, const DarkChord& chord,
                       const PatchFinderParams& params) {
  PatchShape shape;
  shape.uv = spot.mean;
  shape.angle = std::atan2(along.y(), along.x());
  shape.patch = chord.patch;
  shape.ground = chord.ground;
  shape.blur = params.blur_px;
  return shape;
}

/// Where a fit may begin: long enough to have a direction.
std::optional<PatchShape> start_of(const DarkSpot& spot, const DarkChord& chord,
                                   const PatchFinderParams& params, const Window& frame) {
  const double whole = params.length_px * params.width_px * filled_share(params);
  if (spot.open || spot.area > 1.4 * whole) return std::nullopt;
  if (spot.area < (spot.at_border ? 0.35 : 0.4) * whole) return std::nullopt;
  const auto along = forward_axis(spot, spot.covariance, spot.at_border ? 1.3 : 1.8);
  if (!along) return std::nullopt;
  PatchShape shape = lying_along(*along, spot, chord, params);
  if (spot.at_border) {
    // What is missing lies towards the border.
    const double seen = std::sqrt(12.0 * along->dot(spot.covariance * *along));
    const double missing = std::max(0.0, params.length_px - seen);
    const Eigen::Vector2d middle(0.5 * (frame.width - 1), 0.5 * (frame.height - 1));
    const double out = along->dot(spot.mean - middle) > 0.0 ? 0.5 : -0.5;
    shape.uv += out * missing * *along;
  }
  return shape;
}

/// … of a patch that moved.
std::optional<PatchShape> moved_start_of(const DarkSpot& spot, const DarkChord& chord,
                                         const Eigen::Vector2d& motion,
                                         const PatchFinderParams& params) {
  const double whole = params.length_px * params.width_px * filled_share(params);
  const double smeared = whole + motion.norm() * params.length_px;
  if (spot.open || spot.at_border || spot.area < 0.4 * whole || spot.area > 1.4 * smeared)
    return std::nullopt;
  const auto along = forward_axis(spot, spot.covariance - motion * motion.transpose() / 12.0, 1.1);
  if (!along) return std::nullopt;
  PatchShape shape = lying_along(*along, spot, chord, params);
  shape.motion = motion;
  return shape;
}

/// What a spot that is too wide for a patch moved across its length, if that is why.
std::optional<Eigen::Vector2d> motion_across(const DarkSpot& spot,
                                             const PatchFinderParams& params) {
  if (spot.open || spot.at_border) return std::nullopt;
  const double width = spot.area / params.length_px;
  const auto along = forward_axis(spot, spot.covariance, 1.1);
  if (!along || width < 1.2 * params.width_px || width > 0.9 * params.length_px)
    return std::nullopt;
  return width * Eigen::Vector2d(-along->y(), along->x());
}

constexpr double kMaxLogOdds = 1e3;
constexpr double kMaxAside_px = 50.0;
constexpr double kMinMark = 0.08;  // of the squares of a sharp tongue; it fades as the blur grows
constexpr double kMarkFades = 2.5;
constexpr double kMovedMarkFades = 1.5;
constexpr double kOneSidedLogOdds = 30.0;  // the other direction does not come to rest
constexpr double kMaxTrace_px2 = 0.1;      // of a whole patch's position
constexpr double kMaxCutTrace_px2 = 4.0;

constexpr double kMotionSpread_px = 1.0;  // of what patches of a frame moved
constexpr double kMotionSpread = 0.1;     // … and of its length
constexpr int kMaxFailures = 4;

/// The better of the two directions, by how much, and where the other one has the middle beside it.
struct DirectedFit {
  PatchFit fit;
  double forward_log_odds = 0.0;
  Eigen::Vector2d other = Eigen::Vector2d::Zero();
  double worse = std::numeric_limits<double>::infinity();  ///< Σ of squares of the other one, more
};
std::optional<DirectedFit> better_of(const std::optional<PatchFit>& one,
                                     const std::optional<PatchFit>& other) {
  if (!one && !other) return std::nullopt;
  if (!one || !other) return DirectedFit{one ? *one : *other, kOneSidedLogOdds};
  const PatchFit& best = one->square <= other->square ? *one : *other;
  const double less = std::abs(one->square - other->square);
  const PatchFit& worse = one->square <= other->square ? *other : *one;
  Eigen::Vector2d aside = worse.shape.uv - best.shape.uv;
  if (!(aside.norm() < kMaxAside_px)) aside.setZero();  // it was given up
  return DirectedFit{best, std::min(0.5 * less / (best.noise * best.noise), kMaxLogOdds), aside,
                     less};
}

/// What a tongue is to the squares: the grey levels of what it lacks of a body, at either end.
double tongue_square(const PatchFit& fit, const PatchFinderParams& params) {
  const double contrast = fit.shape.ground - fit.shape.patch;
  const double lacking = (1.0 - kTongueWidth) * kTongueLength * params.length_px * params.width_px;
  return 2.0 * lacking * contrast * contrast;
}

/// Whether one end of a whole patch is a tongue and the other is none; a slot, a spot or a strip
/// without a mark is the same either way round.
bool has_mark(const DirectedFit& directed, const PatchFinderParams& params) {
  const PatchShape& shape = directed.fit.shape;
  const double blur = std::sqrt(shape.blur * shape.blur + shape.motion.squaredNorm() / 12.0);
  const double sharp = std::min(1.0, params.blur_px / blur);
  const double fades = shape.motion.norm() > 0.0 ? kMovedMarkFades : kMarkFades;
  return directed.worse >= kMinMark * std::pow(sharp, fades) * tongue_square(directed.fit, params);
}

/// With the chance that the patch lies the other way round, which moves the middle of one whose end
/// the border cuts. Its residuals go together: their odds count half.
Eigen::Matrix3d covariance_of(const DirectedFit& directed, const PatchFinderParams& params) {
  Eigen::Matrix3d P = directed.fit.covariance;
  if (!params.polarity) return P;
  const double turned = 1.0 / (1.0 + std::exp(0.5 * directed.forward_log_odds));
  P.topLeftCorner<2, 2>() += turned * (1.0 - turned) * directed.other * directed.other.transpose();
  return P;
}

std::optional<DirectedFit> fit_directed(const PatchWindow& window, PatchShape start,
                                        const PatchFinderParams& params) {
  constexpr double kNever = 1e30;
  const auto one = fit_patch(window, start, params, kNever);
  if (!params.polarity) return one ? std::optional<DirectedFit>({*one, 0.0}) : std::nullopt;
  start.angle = wrap_angle(start.angle + kPi);
  // So much worse after two steps is no direction.
  const double give_up = one ? one->square + 2.0 * kMaxLogOdds * one->noise * one->noise : kNever;
  const auto other = fit_patch(window, start, params, give_up);
  return better_of(one, other);
}

/// The better of the two directions of a shape that moved while it was exposed.
std::optional<DirectedFit> fit_moved_directed(const PatchWindow& window, PatchShape start,
                                              const PatchFinderParams& params) {
  const auto one = fit_moved(window, params, start);
  if (!params.polarity) return one ? std::optional<DirectedFit>({*one, 0.0}) : std::nullopt;
  start.angle = wrap_angle(start.angle + kPi);
  return better_of(one, fit_moved(window, params, start));
}

/// A dark spot of a textured ceiling passes for a patch out of focus, with residuals that go
/// together; those of a patch are noise, or its edges are sharp.
double max_misfit(const PatchFit& fit, const PatchFinderParams& params) {
  const double contrast = fit.shape.ground - fit.shape.patch;
  return params.max_misfit * contrast * std::min(1.0, params.blur_px / fit.shape.blur);
}

bool is_patch(const PatchFit& fit, const PatchFinderParams& params, const ContrastBound& bound,
              bool whole) {
  const double contrast = fit.shape.ground - fit.shape.patch;
  const double max_noise = params.max_noise * std::min(1.0, contrast / params.enough_contrast);
  return contrast >= bound.beside(fit.shape.ground) &&
         std::abs(fit.shape.log_scale) <= params.max_scale_error &&
         fit.noise <= std::max(params.max_misfit * contrast, max_noise) &&
         fit.misfit <= max_misfit(fit, params) && fit.covariance.allFinite() &&
         fit.covariance.topLeftCorner<2, 2>().trace() < (whole ? kMaxTrace_px2 : kMaxCutTrace_px2);
}

/// Whether the patch reaches beyond what the camera shows.
bool is_cut(const PatchShape& shape, const PatchFinderParams& params, const Window& frame) {
  const Eigen::Vector2d along =
      0.5 * params.length_px * Eigen::Vector2d(std::cos(shape.angle), std::sin(shape.angle));
  const Eigen::Vector2d across =
      0.5 * params.width_px * Eigen::Vector2d(-std::sin(shape.angle), std::cos(shape.angle));
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-1.0, 1.0}) {
      const Eigen::Vector2d corner = shape.uv + a * along + b * across;
      if (corner.x() < -0.5 || corner.y() < -0.5 || corner.x() > frame.width - 0.5 ||
          corner.y() > frame.height - 0.5)
        return true;
    }
  }
  return false;
}

/// Whether a chord belongs to a spot that was looked at already.
bool looked_at(const std::vector<Eigen::Vector3d>& spots, const DarkChord& chord) {
  return std::any_of(spots.begin(), spots.end(), [&](const Eigen::Vector3d& spot) {
    return (Eigen::Vector2d(chord.u, chord.v) - spot.head<2>()).norm() < spot.z();
  });
}

/// Rows of a frame so close together that no patch lies between them.
struct ScannedRows {
  std::vector<imaging::Run> runs;
  std::vector<unsigned char> grey;
};

ScannedRows read_rows(const imaging::Frame& frame, const PatchFinderParams& params) {
  const int step = std::max(1, static_cast<int>(0.7 * params.width_px));
  ScannedRows rows;
  for (int v = step / 2; v < frame.height(); v += step) rows.runs.push_back({v, 0, frame.width()});
  rows.grey.resize(imaging::pixels_in(rows.runs));
  frame.read_grey_runs(rows.runs, rows.grey.data());
  return rows;
}

/// The value below which the share @p p of a histogram lies.
double quantile(const std::vector<int>& counts, double p) {
  const int all = std::accumulate(counts.begin(), counts.end(), 0);
  int below = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    below += counts[i];
    if (below > p * all) return static_cast<double>(i);
  }
  return 0.0;
}

/// What edges a frame's rows are searched for, and what its patches must show: by the light in its
/// darker parts, and by the noise, which the second differences of neighbours give.
struct FrameContrast {
  double search = 0.0;  ///< grey levels
  ContrastBound bound;
};

FrameContrast contrast_of(const ScannedRows& rows, int width, const PatchFinderParams& params) {
  constexpr int kStride = 5;
  constexpr double kDarkerParts = 0.25;
  constexpr double kNormalMedian = 0.6745;  // of |x|, by σ
  std::vector<int> levels(256, 0);
  std::vector<int> roughness(1024, 0);
  for (std::size_t row = 0; row < rows.runs.size(); ++row) {
    const unsigned char* grey = rows.grey.data() + row * static_cast<std::size_t>(width);
    for (int u = 1; u < width - 1; u += kStride) {
      ++levels[grey[u]];
      ++roughness[static_cast<std::size_t>(std::abs(grey[u - 1] - 2 * grey[u] + grey[u + 1]))];
    }
  }
  const double noise = quantile(roughness, 0.5) / (kNormalMedian * std::sqrt(6.0));
  const double least = std::max(params.least_contrast,
                                std::min(params.contrast_to_noise * noise, params.enough_contrast));
  FrameContrast contrast;
  contrast.bound = {params.min_contrast, least, params.enough_contrast};
  contrast.search = contrast.bound.beside(quantile(levels, kDarkerParts));
  return contrast;
}

std::vector<DarkChord> find_chords(const ScannedRows& rows, double contrast,
                                   const PatchFinderParams& params, int width) {
  ChordFinder finder(params, contrast, width);
  std::vector<DarkChord> chords;
  const unsigned char* row = rows.grey.data();
  for (const imaging::Run& run : rows.runs) {
    finder.find(row, width, run.v, chords);
    row += width;
  }
  return chords;
}

/// A dark spot, what was fitted to it, and whether that is a patch.
struct Candidate {
  PatchWindow window;
  DarkSpot spot;
  DarkChord chord;
  std::optional<DirectedFit> fit;    ///< of a patch
  std::optional<DirectedFit> moved;  ///< of one if others of the frame moved as much
};

bool alike(const Eigen::Vector2d& one, const Eigen::Vector2d& other) {
  const double off = std::min((one - other).norm(), (one + other).norm());
  return off < kMotionSpread_px + kMotionSpread * one.norm();
}

class CandidateJudge {
 public:
  CandidateJudge(const PatchFinderParams& params, const ContrastBound& bound, const Window& frame)
      : params_(params), bound_(bound), frame_(frame) {}

  void judge(Candidate& candidate) {
    const auto start = start_of(candidate.spot, candidate.chord, params_, frame_);
    if (!start) {
      if (const auto motion = motion_across(candidate.spot, params_))
        try_moved(candidate, moved_start_of(candidate.spot, candidate.chord, *motion, params_));
      return;
    }
    auto directed = fit_directed(candidate.window, *start, params_);
    if (!directed) return;
    const bool whole = !is_cut(directed->fit.shape, params_, frame_);
    PatchShape moved = directed->fit.shape;
    const auto fit = refine_patch(candidate.window, params_, whole, directed->fit);
    if (!fit) return;
    directed->fit = *fit;
    const bool marked = !whole || !params_.polarity || has_mark(*directed, params_);
    if (marked && is_patch(*fit, params_, bound_, whole)) candidate.fit = directed;
    if (fit->suspected_motion.norm() == 0.0) return;
    moved.motion = fit->suspected_motion;
    moved.blur = std::sqrt(std::max(params_.blur_px * params_.blur_px,
                                    moved.blur * moved.blur - moved.motion.squaredNorm() / 24.0));
    try_moved(candidate, moved);
  }

  /// Of spots that are no patches, with the motion of those that may be.
  void judge_moved(Candidate& candidate, const Eigen::Vector2d& motion) {
    try_moved(candidate, moved_start_of(candidate.spot, candidate.chord, motion, params_));
  }

 private:
  bool is_moved_patch(const DirectedFit& moved) const {
    return is_patch(moved.fit, params_, bound_, true) &&
           !is_cut(moved.fit.shape, params_, frame_) &&
           (!params_.polarity || has_mark(moved, params_));
  }

  void try_moved(Candidate& candidate, const std::optional<PatchShape>& start) {
    if (!start || failures_ >= kMaxFailures) return;
    const auto moved = fit_moved_directed(candidate.window, *start, params_);
    const bool is_one = moved && is_moved_patch(*moved);
    failures_ = is_one ? 0 : failures_ + 1;
    if (!is_one) return;
    if (candidate.fit) candidate.fit = moved;
    candidate.moved = moved;
  }

  PatchFinderParams params_;
  ContrastBound bound_;
  Window frame_;
  int failures_ = 0;  ///< one after the other, of motions that were suspected
};

int votes_for(const Eigen::Vector2d& motion, const std::vector<Candidate>& candidates) {
  return static_cast<int>(
      std::count_if(candidates.begin(), candidates.end(), [&](const Candidate& one) {
        return one.moved && alike(motion, one.moved->fit.shape.motion);
      }));
}

/// The motion that most spots had.
std::optional<Eigen::Vector2d> common_motion(const std::vector<Candidate>& candidates) {
  std::optional<Eigen::Vector2d> common;
  int most = 0;
  for (const Candidate& one : candidates) {
    if (!one.moved) continue;
    const int votes = votes_for(one.moved->fit.shape.motion, candidates);
    if (votes <= most) continue;
    most = votes;
    common = one.moved->fit.shape.motion;
  }
  return common;
}

/// Camera and ceiling move as one: what is a patch only if it moved must have moved as another did.
void settle_motion(std::vector<Candidate>& candidates, CandidateJudge& judge) {
  const auto motion = common_motion(candidates);
  if (!motion) return;
  for (Candidate& candidate : candidates)
    if (!candidate.fit && !candidate.moved) judge.judge_moved(candidate, *motion);
  if (votes_for(*motion, candidates) < 2) return;
  for (Candidate& candidate : candidates)
    if (!candidate.fit && candidate.moved && alike(*motion, candidate.moved->fit.shape.motion))
      candidate.fit = candidate.moved;
}

}  // namespace

PatchScan PatchFinder::find(const imaging::Frame& frame) const {
  std::vector<Eigen::Vector3d> spots;  // middle, radius
  std::vector<Candidate> candidates;
  const ScannedRows rows = read_rows(frame, params_);
  const FrameContrast contrast = contrast_of(rows, frame.width(), params_);
  CandidateJudge judge(params_, contrast.bound, frame.full());
  std::vector<DarkChord> chords = find_chords(rows, contrast.search, params_, frame.width());
  for (DarkChord& chord : chords) {
    if (looked_at(spots, chord)) continue;
    PatchWindow window = read_window(frame, chord, 1.15 * params_.length_px + 4.0);
    DarkSpot spot = dark_spot(window, chord, frame.full());
    if (spot.area < 0.25 * params_.length_px * params_.width_px) continue;
    spots.emplace_back(spot.mean.x(), spot.mean.y(), 0.6 * params_.length_px);
    candidates.push_back({std::move(window), std::move(spot), chord, {}, {}});
    judge.judge(candidates.back());
  }
  settle_motion(candidates, judge);
  PatchScan scan;
  double square = 0.0;
  for (const Candidate& candidate : candidates) {
    if (!candidate.fit) {
      ++scan.rejected;
      continue;
    }
    const PatchFit& fit = candidate.fit->fit;
    scan.patches.push_back({fit.shape.uv, fit.shape.angle, covariance_of(*candidate.fit, params_),
                            candidate.fit->forward_log_odds,
                            is_cut(fit.shape, params_, frame.full())});
    square += fit.noise * fit.noise;
  }
  if (!scan.patches.empty())
    scan.noise = std::sqrt(square / static_cast<double>(scan.patches.size()));
  return scan;
}

}  // namespace vigia::tracking
