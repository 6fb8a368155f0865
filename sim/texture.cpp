#include "texture.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

/// Entry of a square table of @p side entries a row.
std::size_t at_cell(int row, int column, int side) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
         static_cast<std::size_t>(column);
}

/// Value noise on a lattice of @p cells cells that wraps round, smooth to the second derivative.
std::vector<double> value_noise(int size, int cells, std::uint64_t seed) {
  RandomStream random(seed, "lattice");
  std::vector<double> lattice(at_cell(cells, 0, cells));
  for (double& value : lattice) value = random.uniform(-1.0, 1.0);
  const auto at = [&](int i, int j) { return lattice[at_cell(i % cells, j % cells, cells)]; };
  const auto smooth = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
  std::vector<double> noise(at_cell(size, 0, size));
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double y = static_cast<double>(row) * cells / size;
      const double x = static_cast<double>(column) * cells / size;
      const int i = static_cast<int>(y);
      const int j = static_cast<int>(x);
      const double fy = smooth(y - i);
      const double fx = smooth(x - j);
      const double top = at(i, j) + fx * (at(i, j + 1) - at(i, j));
      const double bottom = at(i + 1, j) + fx * (at(i + 1, j + 1) - at(i + 1, j));
      noise[at_cell(row, column, size)] = top + fy * (bottom - top);
    }
  }
  return noise;
}

/// A smooth step from 0 to 1 over @p width metres round @p edge.
double step(double x, double edge, double width) {
  const double t = std::clamp((x - edge) / width + 0.5, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// 1 between low and high.
double band(double x, double low, double high) {
  return step(x, low, 0.012) - step(x, high, 0.012);
}

template <typename Paint>
Profile paint_profile(double length_m, bool repeats, Paint paint) {
  Profile profile;
  profile.per_m = static_cast<float>(Profile::kSize / length_m);
  profile.repeats = repeats;
  for (int i = 0; i < Profile::kSize; ++i)
    profile.grey[static_cast<std::size_t>(i)] =
        static_cast<float>(paint((i + 0.5) * length_m / Profile::kSize));
  return profile;
}

/// Tint with luma 1 (Rec. 709) from its red and blue.
constexpr double kPainted = 200.0;  // an obstacle's grey level from which on it is painted white

std::array<float, 3> tint(double red, double blue) {
  const double green = (1.0 - 0.2126 * red - 0.0722 * blue) / 0.7152;
  return {static_cast<float>(red), static_cast<float>(green), static_cast<float>(blue)};
}

Material material(double grey, double coarse, double fine, std::uint64_t seed) {
  RandomStream random(seed, "material");
  Material result;
  result.base = static_cast<float>(grey);
  result.coarse = static_cast<float>(coarse);
  result.fine = static_cast<float>(fine);
  result.offset_s = static_cast<float>(random.uniform(0.0, 8.0));
  result.offset_t = static_cast<float>(random.uniform(0.0, 8.0));
  return result;
}

}  // namespace

NoiseTile::NoiseTile(std::uint64_t seed) : packed_(kSize * kSize) {
  std::vector<double> sum(packed_.size(), 0.0);
  double weight = 1.0;
  for (int cells = 8; cells <= 32; cells *= 2, weight *= 0.6) {
    const auto octave = value_noise(kSize, cells, derive_seed(seed, static_cast<unsigned>(cells)));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * octave[i];
  }
  double mean = 0.0;
  for (const double value : sum) mean += value / static_cast<double>(sum.size());
  double peak = 0.0;
  for (double& value : sum) peak = std::max(peak, std::abs(value -= mean));
  const auto byte = [&](int row, int column) {
    const double value = sum[at_cell(row % kSize, column % kSize, kSize)];
    return static_cast<std::uint32_t>(std::lround(127.5 + 127.0 * value / peak));
  };
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      packed_[at_cell(row, column, kSize)] = byte(row, column) | byte(row, column + 1) << 8 |
                                             byte(row + 1, column) << 16 |
                                             byte(row + 1, column + 1) << 24;
    }
  }
}

Material wall_material(double grey, double contrast, double height_m, std::uint64_t seed) {
  Material wall = material(grey, 16.0 * contrast, 9.0 * contrast, seed);
  // Skirting board, wainscot with a rail, moulding below the ceiling.
  wall.along_t = paint_profile(height_m + 0.2, false, [&](double h) {
    double paint = -14.0 * band(h, -1.0, 0.92);
    paint += -34.0 * band(h, -1.0, 0.11) + 18.0 * band(h, 0.11, 0.125);
    paint += 26.0 * band(h, 0.90, 0.95) - 22.0 * band(h, 0.95, 0.965);
    paint += 16.0 * band(h, height_m - 0.09, height_m + 1.0);
    paint += -18.0 * band(h, height_m - 0.11, height_m - 0.09);
    return contrast * paint;
  });
  wall.along_s = paint_profile(1.2, true, [&](double s) {
    return contrast * (-15.0 * band(s, 0.60, 0.612) + 7.0 * band(s, 0.612, 0.63));
  });
  RandomStream random(seed, "tint");
  wall.tint = tint(random.uniform(1.06, 1.10), random.uniform(0.80, 0.90));
  return wall;
}

Material obstacle_material(double grey, double contrast, std::uint64_t seed) {
  Material box = material(grey, 10.0 * contrast, 14.0 * contrast, seed);
  box.along_t = paint_profile(0.4, true, [&](double h) {
    return contrast * (-24.0 * band(h, 0.19, 0.21) + 8.0 * band(h, 0.21, 0.225));
  });
  if (grey < kPainted) box.tint = tint(1.25, 0.6);  // wood
  return box;
}

Material carpet_material(double grey, double contrast, std::uint64_t seed) {
  Material carpet = material(grey, 7.0 * contrast, 8.0 * contrast, seed);
  carpet.tint = tint(0.38, 0.55);
  return carpet;
}

Material plain_material(double grey, double fine, std::uint64_t seed) {
  return material(grey, 0.5 * fine, fine, seed);
}

Material floor_material(double grey, double contrast, std::uint64_t seed) {
  Material floor = material(grey, 14.0 * contrast, 16.0 * contrast, seed);
  // Square tiles of 0.5 m, every other row a little lighter.
  floor.along_s = paint_profile(1.0, true, [&](double s) {
    return contrast *
           (-22.0 * (band(s, 0.24, 0.255) + band(s, 0.74, 0.755)) + 6.0 * band(s, 0.255, 0.74));
  });
  floor.along_t = paint_profile(1.0, true, [&](double t) {
    return contrast *
           (-22.0 * (band(t, 0.24, 0.255) + band(t, 0.74, 0.755)) + 6.0 * band(t, 0.255, 0.74));
  });
  floor.tint = tint(1.12, 0.8);
  return floor;
}

Material ceiling_material(double grey, double contrast, std::uint64_t seed) {
  Material ceiling = material(grey, 7.0 * contrast, 5.0 * contrast, seed);
  const auto joint = [&](double s) { return -16.0 * contrast * band(s, 0.30, 0.315); };
  ceiling.along_s = paint_profile(0.6, true, joint);
  ceiling.along_t = paint_profile(0.6, true, joint);
  ceiling.tint = tint(1.0, 1.03);
  return ceiling;
}

}  // namespace vigia::sim
