#include "blob_finder.hpp"

#include "dark_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <Eigen/LU>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

constexpr int kLag = 3;             // px over which an edge falls or rises
constexpr int kGroundDistance = 4;  // px outside a chord's end where the ground's level is read
constexpr int kProfiled = 12;       // px; smaller blobs have too few chords to judge by
constexpr int kSameThreshold = 12;  // fills this close in threshold give the same blob

double median_of_five(std::array<double, 5> values) {
  std::nth_element(values.begin(), values.begin() + 2, values.end());
  return values[2];
}

}  // namespace

const std::vector<Blob>& BlobFinder::find(const vpImage<unsigned char>& image,
                                          const imaging::Window& window) {
  image_ = &image;
  window_ = window;
  blobs_.clear();
  thresholds_.clear();
  const std::size_t pixels = image.getSize();
  if (taken_.size() != pixels || first_fill_ + fills_ > 0x7fffffffU) {
    taken_.assign(pixels, 0);
    first_fill_ = 1;
    fills_ = 0;
  }
  first_fill_ += fills_;
  fills_ = 0;
  falling_.assign(static_cast<std::size_t>(window.width) + 8, 0);
  rising_.assign(static_cast<std::size_t>(window.width) + 8, 0);
  for (int v = window.v + parameters_.row_step / 2; v < window.bottom(); v += parameters_.row_step)
    scan_row(v);
  return blobs_;
}

// Pairs falling edges with the next rising edge.
void BlobFinder::scan_row(int v) {
  const unsigned char* row = image_->operator[](static_cast<unsigned>(v)) + window_.u;
  const int count = window_.width - kLag;
  const auto threshold = static_cast<unsigned char>(parameters_.min_contrast);
  unsigned char* falling = falling_.data();
  unsigned char* rising = rising_.data();
  for (int u = 0; u < count; ++u) {
    const unsigned char here = row[u];
    const unsigned char there = row[u + kLag];
    const auto fall = static_cast<unsigned char>(std::max(here, there) - there);
    const auto rise = static_cast<unsigned char>(std::max(here, there) - here);
    falling[u] = fall >= threshold ? 1 : 0;
    rising[u] = rise >= threshold ? 1 : 0;
  }

  // What begins or ends beyond the window's side counts as cut there.
  int first_fall = 0;
  int last_fall = 0;
  for (int u = 0; u < count;) {
    std::uint64_t falls = 0;
    std::uint64_t rises = 0;
    std::memcpy(&falls, falling + u, sizeof falls);
    std::memcpy(&rises, rising + u, sizeof rises);
    if ((falls | rises) == 0) {
      u += static_cast<int>(sizeof falls);
      continue;
    }
    if (falling[u] != 0) {
      const int start = u;
      while (u < count && falling[u] != 0) ++u;
      last_fall = (start + u - 1 + kLag + 1) / 2;
      if (first_fall < 0) first_fall = last_fall;
    } else if (rising[u] != 0) {
      const int start = u;
      while (u < count && rising[u] != 0) ++u;
      const int rise = (start + u - 1 + kLag) / 2;
      if (last_fall >= 0) consider({v, window_.u + last_fall, window_.u + rise});
      // An edge inside the disc may have hidden the outline.
      if (first_fall >= 0 && last_fall - first_fall > 2)
        consider({v, window_.u + first_fall, window_.u + rise});
      first_fall = last_fall = -1;
    } else {
      ++u;
    }
  }
  if (last_fall > 0) consider({v, window_.u + last_fall, window_.right() - 1});
}

void BlobFinder::consider(const Chord& chord) {
  if (chord.last - chord.first < parameters_.min_axis_px) return;
  if (const auto seed = seed_of(chord)) fill(*seed);
}

// How many steps of (du, dv) stay below the threshold; one lighter pixel alone is noise.
int BlobFinder::reach(int u, int v, int du, int dv, int threshold, int limit) const {
  int steps = 0;
  for (int k = 1; k <= limit; ++k) {
    const int uk = u + k * du;
    const int vk = v + k * dv;
    if (uk < window_.u || uk >= window_.right() || vk < window_.v || vk >= window_.bottom()) break;
    if (at(uk, vk) < threshold)
      steps = k;
    else if (k - steps >= 2)
      break;
  }
  return steps;
}

// The levels within and beside the chord, and the threshold half way between. Nothing where there
// is no contrast.
std::optional<BlobFinder::Seed> BlobFinder::seed_levels(const Chord& chord) const {
  const int length = chord.last - chord.first + 1;
  Seed seed;
  seed.u = (chord.first + chord.last) / 2;
  seed.v = chord.v;
  std::array<double, 5> samples{};
  for (int k = 0; k < 5; ++k) {
    const int at_u = seed.u + (k - 2) * std::max(1, length / 8);
    samples[static_cast<std::size_t>(k)] =
        at(std::clamp(at_u, window_.u, window_.right() - 1), seed.v);
  }
  seed.disc = median_of_five(samples);
  const auto level = [&](int at_u) {
    const int inner = std::clamp(at_u, window_.u + 1, window_.right() - 2);
    return (at(inner - 1, seed.v) + at(inner, seed.v) + at(inner + 1, seed.v)) / 3.0;
  };
  const double left = level(chord.first - kGroundDistance);
  const double right = level(chord.last + kGroundDistance);
  if (chord.first == window_.u && chord.last == window_.right() - 1) return std::nullopt;
  if (chord.first == window_.u)
    seed.ground = right;
  else if (chord.last == window_.right() - 1)
    seed.ground = left;
  else
    seed.ground = std::min(left, right);
  if (seed.ground - seed.disc < parameters_.min_contrast) return std::nullopt;
  seed.threshold = static_cast<int>(0.5 * (seed.disc + seed.ground));
  return seed;
}

// Whether a fill of about the same threshold has taken the seed's pixel.
bool BlobFinder::already_filled(const Seed& seed) const {
  const std::uint32_t taker = taken_[static_cast<std::size_t>(seed.v) * image_->getWidth() +
                                     static_cast<std::size_t>(seed.u)];
  return taker >= first_fill_ &&
         std::abs(thresholds_[taker - first_fill_] - seed.threshold) <= kSameThreshold;
}

std::optional<BlobFinder::Seed> BlobFinder::seed_of(const Chord& chord) const {
  auto seed = seed_levels(chord);
  if (!seed || at(seed->u, seed->v) >= seed->threshold || already_filled(*seed))
    return std::nullopt;

  // The crossing chord, then the chord through its middle.
  const int length = chord.last - chord.first + 1;
  const int u = seed->u;
  const int v = seed->v;
  const int tallest = static_cast<int>(length / parameters_.min_axis_ratio) * 2 + 8;
  const int up = reach(u, v, 0, -1, seed->threshold, tallest);
  const int down = reach(u, v, 0, 1, seed->threshold, tallest);
  const int height = up + down + 1;
  if (up == tallest || down == tallest || height < 1.6 * parameters_.min_axis_px)
    return std::nullopt;
  const int middle = v + (down - up) / 2;
  const int widest = static_cast<int>(height / parameters_.min_axis_ratio) * 2 + 8;
  const int before = reach(u, middle, -1, 0, seed->threshold, widest);
  const int behind = reach(u, middle, 1, 0, seed->threshold, widest);
  const int width = before + behind + 1;
  if (before == widest || behind == widest || width < 1.6 * parameters_.min_axis_px)
    return std::nullopt;
  const double flat = 0.7 * parameters_.min_axis_ratio;
  if (width < flat * height || height < flat * width) return std::nullopt;

  const Column column{u, middle, height};
  if (std::min(width, height) >= kProfiled && !chords_like_ellipse(column, width, seed->threshold))
    return std::nullopt;

  // The rectangle round a slanting ellipse is larger than its upright chords by up to this much.
  const double ratio = parameters_.min_axis_ratio;
  const double slant = 0.5 * (1.0 + ratio * ratio) / ratio;
  const int half_width = static_cast<int>(slant * 0.6 * width * 1.15) + 4;
  const int half_height = static_cast<int>(slant * 0.6 * height * 1.15) + 4;
  const int u_middle = u + (behind - before) / 2;
  seed->limit = {u_middle - half_width, middle - half_height, 2 * half_width + 1,
                 2 * half_height + 1};
  return seed;
}

// Along the rows of an ellipse the squared chord is a parabola, whatever its slant; tested on four
// chords through the column and the longest one.
bool BlobFinder::chords_like_ellipse(const Column& column, int width, int threshold) const {
  const auto chord = [&](int offset) {
    const int v = column.v + offset;
    const unsigned char* row = image_->operator[](static_cast<unsigned>(v));
    const int first = dark_run_begin(row, column.u, window_.u, threshold);
    const int last = dark_run_end(row, column.u, window_.right() - 1, threshold);
    return static_cast<double>(last - first + 1);
  };
  const auto mean_square = [&](int offset) {
    return 0.5 * (std::pow(chord(offset), 2) + std::pow(chord(-offset), 2));
  };
  const int near = column.height / 4;
  const int far = 3 * column.height / 8;
  const double middle = static_cast<double>(width) * width;
  const double curvature = (middle - mean_square(far)) / (static_cast<double>(far) * far);
  const double half = 0.5 * column.height;
  // Half the ellipse's height squared; a slanting ellipse is higher than its upright chord.
  constexpr double kLow = 0.75;
  constexpr double kHigh = 2.5;
  if (curvature * half * half * kHigh * kHigh < middle ||
      curvature * half * half * kLow * kLow > middle)
    return false;
  const double expected = middle - curvature * near * near;
  return std::abs(mean_square(near) - expected) < 0.08 * middle + 2.0 * width;
}

// Takes the run of dark pixels through (u, v). False when it leaves the limit.
bool BlobFinder::add_run(int u, int v, const Seed& seed, const Run& from) {
  const unsigned char* row = image_->operator[](static_cast<unsigned>(v));
  const int first = dark_run_begin(row, u, window_.u, seed.threshold);
  const int last = dark_run_end(row, u, window_.right() - 1, seed.threshold);
  const std::uint32_t number = first_fill_ + fills_;
  std::uint32_t* taken = taken_.data() + static_cast<std::size_t>(v) * image_->getWidth();
  std::fill(taken + first, taken + last + 1, number);
  const Run run{v, first, last};
  runs_.push_back(run);
  open_.push_back({run, from});
  return first >= seed.limit.u && last < seed.limit.right() && v >= seed.limit.v &&
         v < seed.limit.bottom();
}

// Takes the runs of row v that touch columns first to last.
bool BlobFinder::add_touching(int first, int last, int v, const Seed& seed, const Run& from) {
  const std::uint32_t number = first_fill_ + fills_;
  const unsigned char* row = image_->operator[](static_cast<unsigned>(v));
  const std::uint32_t* taken = taken_.data() + static_cast<std::size_t>(v) * image_->getWidth();
  for (int u = first; u <= last; ++u) {
    if (row[u] >= seed.threshold || taken[u] == number) continue;
    if (!add_run(u, v, seed, from)) return false;
    u = runs_.back().last + 1;
  }
  return true;
}

// Takes the dark region round the seed into runs_. False when it leaves the limit.
bool BlobFinder::flood(const Seed& seed) {
  open_.clear();
  runs_.clear();
  thresholds_.push_back(seed.threshold);
  const Run nowhere{seed.v - 2, 0, -1};
  bool within = add_run(seed.u, seed.v, seed, nowhere);
  while (within && !open_.empty()) {
    const auto [run, from] = open_.back();
    open_.pop_back();
    for (int v = run.v - 1; within && v <= run.v + 1; v += 2) {
      if (v < window_.v || v >= window_.bottom()) continue;
      // Where it came from, only what sticks out on both sides is new.
      if (v == from.v)
        within = add_touching(run.first, std::min(run.last, from.first - 1), v, seed, run) &&
                 add_touching(std::max(run.first, from.last + 1), run.last, v, seed, run);
      else
        within = add_touching(run.first, run.last, v, seed, run);
    }
  }
  ++fills_;
  return within;
}

void BlobFinder::fill(const Seed& seed) {
  if (!flood(seed)) return;
  if (auto blob = describe(seed)) blobs_.push_back(std::move(*blob));
}

// Moments about the seed; the sum of squares of a run in closed form. Nothing for a line.
std::optional<Blob> BlobFinder::describe(const Seed& seed) const {
  double m00 = 0.0;
  double m10 = 0.0;
  double m01 = 0.0;
  double m20 = 0.0;
  double m11 = 0.0;
  double m02 = 0.0;
  int left = seed.u;
  int right = seed.u;
  int top = seed.v;
  int bottom = seed.v;
  for (const Run& run : runs_) {
    const double n = run.last - run.first + 1;
    const double middle = 0.5 * (run.first + run.last) - seed.u;
    const double v = run.v - seed.v;
    m00 += n;
    m10 += n * middle;
    m01 += n * v;
    m20 += n * (middle * middle + (n * n - 1.0) / 12.0);
    m11 += n * middle * v;
    m02 += n * v * v;
    left = std::min(left, run.first);
    right = std::max(right, run.last);
    top = std::min(top, run.v);
    bottom = std::max(bottom, run.v);
  }
  Blob blob;
  blob.box = {left, top, right - left + 1, bottom - top + 1};
  blob.area = m00;
  blob.disc = seed.disc;
  blob.ground = seed.ground;
  blob.cut = left <= window_.u || top <= window_.v || right >= window_.right() - 1 ||
             bottom >= window_.bottom() - 1;
  const double mean_u = m10 / m00;
  const double mean_v = m01 / m00;
  blob.ellipse.centre << seed.u + mean_u, seed.v + mean_v;
  // A solid ellipse has Σ = 4 × its second moments.
  blob.ellipse.sigma << m20 / m00 - mean_u * mean_u, m11 / m00 - mean_u * mean_v,
      m11 / m00 - mean_u * mean_v, m02 / m00 - mean_v * mean_v;
  blob.ellipse.sigma *= 4.0;
  const double determinant = blob.ellipse.sigma.determinant();
  if (determinant <= 0.0) return std::nullopt;
  blob.fill = blob.area / (kPi * std::sqrt(determinant));
  blob.solidity = solidity_of(blob);
  // Where the area is wrong already, the outline needs no look.
  blob.outline = std::abs(blob.fill - 1.0) < 0.2 ? outline_distance(blob.ellipse) : 1e9;
  if (blob.cut || parameters_.keep_outlines) blob.arc = visible_arc();
  return blob;
}

double BlobFinder::solidity_of(const Blob& blob) const {
  const imaging::Window& box = blob.box;
  std::vector<std::pair<int, int>> span(static_cast<std::size_t>(box.height),
                                        {box.right() - 1, box.u});
  for (const Run& run : runs_) {
    auto& [first, last] = span[static_cast<std::size_t>(run.v - box.v)];
    first = std::min(first, run.first);
    last = std::max(last, run.last);
  }
  double spanned = 0.0;
  for (const auto& [first, last] : span) spanned += last - first + 1;
  return blob.area / spanned;
}

// The runs' ends that are not the window's sides; above and below, the outline is cut anyway.
std::vector<Eigen::Vector2d> BlobFinder::visible_arc() const {
  std::vector<Eigen::Vector2d> arc;
  for (const Run& run : runs_) {
    if (run.v <= window_.v || run.v >= window_.bottom() - 1) continue;
    if (run.first > window_.u) arc.emplace_back(run.first - 0.5, run.v);
    if (run.last < window_.right() - 1) arc.emplace_back(run.last + 0.5, run.v);
  }
  return arc;
}

// First-order distance of the outer pixel edges of the runs to the ellipse, rms.
double BlobFinder::outline_distance(const EllipseShape& ellipse) const {
  const Eigen::Matrix2d inverse = ellipse.sigma.inverse();
  double sum = 0.0;
  for (const Run& run : runs_)
    for (const double u : {run.first - 0.5, run.last + 0.5}) {
      const Eigen::Vector2d p(u - ellipse.centre.x(), run.v - ellipse.centre.y());
      const Eigen::Vector2d gradient = inverse * p;
      const double level = p.dot(gradient);
      const double root = std::sqrt(level);
      const double distance = (1.0 - root) * root / gradient.norm();
      sum += distance * distance;
    }
  return std::sqrt(sum / (2.0 * static_cast<double>(runs_.size())));
}

}  // namespace vigia::tracking
