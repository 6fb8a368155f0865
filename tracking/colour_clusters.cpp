#include "vigia/tracking/colour_clusters.hpp"

#include "hue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vigia::tracking {
namespace {

struct ClusterPixel {
  Eigen::Vector3d rgb;
  HueColour colour;
};

/// Every few pixels of the mirror.
std::vector<ClusterPixel> mirror_pixels(const imaging::Frame& frame, const MirrorImage& mirror) {
  constexpr double kAbout = 40000.0;  // pixels
  const vpImage<vpRGBa> image = imaging::colour_image(frame);
  const double area = kPi * mirror.outer_px * mirror.outer_px;
  const int stride = std::max(1, static_cast<int>(std::sqrt(area / kAbout)));
  std::vector<ClusterPixel> pixels;
  for (int v = 0; v < frame.height(); v += stride)
    for (int u = 0; u < frame.width(); u += stride) {
      const double r = (Eigen::Vector2d(u, v) - mirror.centre).norm();
      if (r < mirror.inner_px || (mirror.outer_px > 0.0 && r > mirror.outer_px)) continue;
      const vpRGBa& pixel = image[static_cast<unsigned>(v)][u];
      const Eigen::Vector3d rgb(pixel.R, pixel.G, pixel.B);
      pixels.push_back({rgb, hue_colour(rgb)});
    }
  return pixels;
}

/// The hue with most of the saturation near it, among those of the range.
double strongest_hue(const std::vector<ClusterPixel>& pixels, const HueRange& range) {
  constexpr int kBins = 120;  // of 3°
  constexpr int kNear = 2;
  std::array<double, kBins> weight{};
  for (const ClusterPixel& pixel : pixels) {
    const HueColour& c = pixel.colour;
    if (c.saturation < range.min_saturation || c.value < range.min_value) continue;
    if (std::abs(wrap_angle(c.hue - range.hue)) > range.half_width) continue;
    const int bin = static_cast<int>(c.hue / (2.0 * kPi) * kBins) % kBins;
    weight[static_cast<std::size_t>(bin)] += c.saturation;
  }
  double best = -1.0;
  int best_bin = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    double sum = 0.0;
    for (int k = -kNear; k <= kNear; ++k)
      sum += weight[static_cast<std::size_t>((bin + k + kBins) % kBins)];
    if (sum > best) {
      best = sum;
      best_bin = bin;
    }
  }
  return 2.0 * kPi * (best_bin + 0.5) / kBins;
}

double cluster_quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The part of the pixels that @p chosen takes: how many, their mean and some quantiles.
struct Cluster {
  std::vector<double> saturations;
  std::vector<double> values;
  std::vector<double> hues;  ///< from the cluster's middle
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();

  void add(const ClusterPixel& pixel, double hue) {
    saturations.push_back(pixel.colour.saturation);
    values.push_back(pixel.colour.value);
    hues.push_back(std::abs(wrap_angle(pixel.colour.hue - hue)));
    mean += (pixel.rgb - mean) / static_cast<double>(values.size());
  }
};

bool take_green(const std::vector<ClusterPixel>& pixels, FieldColours& colours) {
  constexpr double kNearHue = from_deg(15.0);
  constexpr double kLeastShare = 0.05;
  const double hue = strongest_hue(pixels, colours.green);
  Cluster green;
  for (const ClusterPixel& pixel : pixels)
    if (pixel.colour.saturation >= colours.green.min_saturation &&
        pixel.colour.value >= colours.green.min_value &&
        std::abs(wrap_angle(pixel.colour.hue - hue)) <= kNearHue)
      green.add(pixel, hue);
  if (static_cast<double>(green.values.size()) < kLeastShare * static_cast<double>(pixels.size()))
    return false;
  colours.green.hue = hue;
  colours.green.half_width =
      std::clamp(3.0 * cluster_quantile(green.hues, 0.8), from_deg(15.0), from_deg(35.0));
  colours.green.min_saturation =
      std::max(colours.green.min_saturation, 0.5 * cluster_quantile(green.saturations, 0.5));
  colours.green.min_value = 0.35 * cluster_quantile(green.values, 0.5);
  colours.black_max_value = colours.green.min_value;
  colours.green_mean = green.mean;
  return true;
}

void take_white(const std::vector<ClusterPixel>& pixels, FieldColours& colours) {
  constexpr double kBrighter = 1.1;
  constexpr std::size_t kEnoughWhite = 30;
  // Paint under the light of the carpet: paler than it by half, and brighter.
  colours.white_max_saturation =
      std::max(colours.white_max_saturation, 0.4 * colours.green.min_saturation / 0.5);
  const double green = colours.green_mean.maxCoeff();
  Cluster white;
  for (const ClusterPixel& pixel : pixels)
    if (pixel.colour.saturation <= colours.white_max_saturation &&
        pixel.colour.value >= kBrighter * green)
      white.add(pixel, 0.0);
  colours.white_min_value = 0.8 * green;
  colours.white_mean = white.values.size() >= kEnoughWhite
                           ? white.mean
                           : Eigen::Vector3d::Constant(std::min(255.0, 1.3 * green));
}

/// Yellow where a greenish light has taken it towards green: the strongest hue from the range that
/// it has by itself to the rim of the carpet's, if it is that of enough pixels and not of mixtures
/// of the two.
void take_yellow(const std::vector<ClusterPixel>& pixels, FieldColours& colours) {
  constexpr double kNearHue = from_deg(6.0);
  constexpr double kLeastShare = 0.002;
  constexpr double kLeastCore = 0.5;  // of the pixels of the range
  const double low = colours.yellow.hue - colours.yellow.half_width;
  const double high = colours.green.hue - colours.green.half_width;
  if (high <= colours.yellow.hue + colours.yellow.half_width) return;
  HueRange wide = colours.yellow;
  wide.hue = 0.5 * (low + high);
  wide.half_width = 0.5 * (high - low);
  const double hue = strongest_hue(pixels, wide);
  std::size_t core = 0;
  std::size_t all = 0;
  for (const ClusterPixel& pixel : pixels) {
    const HueColour& c = pixel.colour;
    if (c.saturation < wide.min_saturation || c.value < wide.min_value) continue;
    if (std::abs(wrap_angle(c.hue - wide.hue)) > wide.half_width) continue;
    ++all;
    core += std::abs(wrap_angle(c.hue - hue)) <= kNearHue ? 1 : 0;
  }
  if (static_cast<double>(core) < kLeastShare * static_cast<double>(pixels.size()) ||
      static_cast<double>(core) < kLeastCore * static_cast<double>(all))
    return;
  colours.yellow.hue = hue;
  colours.yellow.half_width = std::min(colours.yellow.half_width, high - hue);
}

}  // namespace

FieldColours cluster_field_colours(const imaging::Frame& frame, const MirrorImage& mirror,
                                   const FieldColours& start) {
  const std::vector<ClusterPixel> pixels = mirror_pixels(frame, mirror);
  FieldColours colours = start;
  if (!take_green(pixels, colours)) return colours;
  take_white(pixels, colours);
  take_yellow(pixels, colours);
  return colours;
}

}  // namespace vigia::tracking
