#include "synthetic_image.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia::tracking::testing {
namespace {

// Distance to an ellipse, first order and then once more from the foot point: exact near it.
double ellipse_distance(const Ellipse& e, const Eigen::Vector2d& p) {
  const double c = std::cos(e.psi);
  const double s = std::sin(e.psi);
  Eigen::Vector2d q(c * (p.x() - e.u) + s * (p.y() - e.v), -s * (p.x() - e.u) + c * (p.y() - e.v));
  double total = 0.0;
  for (int step = 0; step < 2; ++step) {
    const Eigen::Vector2d scaled(q.x() / e.a, q.y() / e.b);
    const double level = std::max(scaled.norm(), 1e-6);
    // Far from the outline only the sign counts.
    if (step == 0 && std::abs(1.0 - level) * e.b > 2.0) return (1.0 - level) * e.b;
    const Eigen::Vector2d gradient(scaled.x() / (e.a * level), scaled.y() / (e.b * level));
    const double d = (1.0 - level) / gradient.norm();
    q += d * gradient.normalized();
    total += d;
  }
  return total;
}

std::vector<float> gaussian(double sigma) {
  const int radius = static_cast<int>(std::ceil(4.5 * sigma));
  std::vector<float> kernel;
  float sum = 0.0F;
  for (int i = -radius; i <= radius; ++i) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
    sum += kernel.back();
  }
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

// Normal numbers, drawn once; each row of an image starts at a random place.
const std::vector<float>& normal_table() {
  static const std::vector<float> table = [] {
    RandomStream random(0, "noise table");
    std::vector<float> out(1U << 20U);
    for (float& value : out) value = static_cast<float>(random.normal());
    return out;
  }();
  return table;
}

}  // namespace

SyntheticImage::SyntheticImage(int width, int height, double ground, double blur, int fine)
    : width_(width),
      height_(height),
      blur_(blur),
      fine_scale_(fine),
      light_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
             static_cast<float>(ground)) {}

void SyntheticImage::add_texture(double amplitude, std::uint64_t seed) {
  RandomStream random(seed, "texture");
  for (const int cell : {7, 31}) {
    const int columns = width_ / cell + 2;
    const int rows = height_ / cell + 2;
    std::vector<float> lattice(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (float& value : lattice) value = static_cast<float>(random.normal() * amplitude);
    for (int v = 0; v < height_; ++v)
      for (int u = 0; u < width_; ++u) {
        const int i = u / cell;
        const int j = v / cell;
        const float x = static_cast<float>(u % cell) / static_cast<float>(cell);
        const float y = static_cast<float>(v % cell) / static_cast<float>(cell);
        const auto at = [&](int column, int row) {
          return lattice[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                         static_cast<std::size_t>(column)];
        };
        light_[pixel(u, v)] += (1 - x) * (1 - y) * at(i, j) + x * (1 - y) * at(i + 1, j) +
                               (1 - x) * y * at(i, j + 1) + x * y * at(i + 1, j + 1);
      }
  }
}

void SyntheticImage::begin_patch(const Ellipse& extent) {
  const int half = static_cast<int>(std::ceil(extent.a + 5.0 * blur_ + 3.0));
  left_ = static_cast<int>(std::floor(extent.u)) - half;
  top_ = static_cast<int>(std::floor(extent.v)) - half;
  fine_width_ = fine_height_ = (2 * half + 2) * fine_scale_;
  fine_.assign(static_cast<std::size_t>(fine_width_) * static_cast<std::size_t>(fine_height_),
               0.0F);
}

void SyntheticImage::end_patch(double level) {
  const std::vector<float> kernel = gaussian(std::max(0.1, blur_) * fine_scale_);
  const int taps = static_cast<int>(kernel.size());
  const int radius = taps / 2;
  across_.assign(fine_.size(), 0.0F);
  for (int y = 0; y < fine_height_; ++y)
    for (int k = 0; k < taps; ++k) {
      const float* in = fine_.data() + y * fine_width_ + k;
      float* out = across_.data() + y * fine_width_ + radius;
      const float weight = kernel[static_cast<std::size_t>(k)];
      for (int x = 0; x < fine_width_ - 2 * radius; ++x) out[x] += weight * in[x];
    }
  std::fill(fine_.begin(), fine_.end(), 0.0F);
  for (int y = radius; y < fine_height_ - radius; ++y)
    for (int k = 0; k < taps; ++k) {
      const float* in = across_.data() + (y - radius + k) * fine_width_;
      float* out = fine_.data() + y * fine_width_;
      const float weight = kernel[static_cast<std::size_t>(k)];
      for (int x = 0; x < fine_width_; ++x) out[x] += weight * in[x];
    }
  for (int y = 0; y < fine_height_ / fine_scale_; ++y)
    for (int x = 0; x < fine_width_ / fine_scale_; ++x) {
      const int u = left_ + x;
      const int v = top_ + y;
      if (u < 0 || v < 0 || u >= width_ || v >= height_) continue;
      float share = 0.0F;
      for (int j = 0; j < fine_scale_; ++j)
        for (int i = 0; i < fine_scale_; ++i)
          share += fine_[fine_pixel(x * fine_scale_ + i, y * fine_scale_ + j)];
      share /= static_cast<float>(fine_scale_ * fine_scale_);
      float& light = light_[pixel(u, v)];
      light += share * (static_cast<float>(level) - light);
    }
}

void SyntheticImage::paint_ellipse(const Ellipse& ellipse, double level) {
  paint(ellipse, level, [&](const Eigen::Vector2d& p) { return ellipse_distance(ellipse, p); });
}

void SyntheticImage::paint_ring(const Ellipse& ellipse, double hole, double level) {
  Ellipse inner = ellipse;
  inner.a *= hole;
  inner.b *= hole;
  paint(ellipse, level, [&](const Eigen::Vector2d& p) {
    return std::min(ellipse_distance(ellipse, p), -ellipse_distance(inner, p));
  });
}

void SyntheticImage::paint_half_disc(const Ellipse& ellipse, double angle, double level) {
  const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d centre(ellipse.u, ellipse.v);
  paint(ellipse, level, [&](const Eigen::Vector2d& p) {
    return std::min(ellipse_distance(ellipse, p), normal.dot(p - centre));
  });
}

void SyntheticImage::paint_rectangle(double u, double v, double width, double height, double angle,
                                     double level) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const Ellipse extent{u, v, 0.5 * std::hypot(width, height), 1.0, 0.0};
  paint(extent, level, [&](const Eigen::Vector2d& p) {
    const double x = c * (p.x() - u) + s * (p.y() - v);
    const double y = -s * (p.x() - u) + c * (p.y() - v);
    return std::min(0.5 * width - std::abs(x), 0.5 * height - std::abs(y));
  });
}

void SyntheticImage::paint_blob(double u, double v, double size, double level,
                                RandomStream& random) {
  // Each disc sticks out of the one before by a good part of its own size.
  std::vector<Eigen::Vector3d> discs{{u, v, 0.5 * size}};
  const std::size_t count = 2 + random.index(3);
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3d& last = discs.back();
    const double angle = random.uniform(0.0, 2.0 * kPi);
    const double radius = size * random.uniform(0.25, 0.5);
    discs.emplace_back(last.x() + last.z() * std::cos(angle), last.y() + last.z() * std::sin(angle),
                       radius);
  }
  paint({u, v, 2.6 * size, 1.0, 0.0}, level, [&](const Eigen::Vector2d& p) {
    double best = -1e9;
    for (const Eigen::Vector3d& disc : discs)
      best = std::max(best, disc.z() - (p - disc.head<2>()).norm());
    return best;
  });
}

void SyntheticImage::paint_clutter(int count, const std::vector<Ellipse>& keep_free,
                                   RandomStream& random) {
  while (count > 0) {
    const double u = random.uniform(0.0, width_);
    const double v = random.uniform(0.0, height_);
    const double size = random.uniform(6.0, 30.0);
    const bool blocked = std::any_of(keep_free.begin(), keep_free.end(), [&](const Ellipse& e) {
      return std::hypot(u - e.u, v - e.v) < e.a + 1.5 * size + 8.0;
    });
    if (blocked) continue;
    const double level = random.uniform(20.0, 110.0);
    const double angle = random.uniform(0.0, kPi);
    switch (random.index(5)) {
      case 0:
        paint_rectangle(u, v, 2.0 * size, size * random.uniform(0.4, 2.0), angle, level);
        break;
      case 1:
        paint_ring({u, v, size, size * random.uniform(0.7, 1.0), angle}, 0.5, level);
        break;
      case 2:
        paint_half_disc({u, v, size, size, 0.0}, angle, level);
        break;
      case 3:
        paint_ellipse({u, v, size, 0.18 * size, angle}, level);
        break;
      default:
        paint_blob(u, v, size, level, random);
        break;
    }
    --count;
  }
}

void SyntheticImage::slope_light(double per_px, double angle) {
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u) {
      const double along =
          std::cos(angle) * (u - 0.5 * width_) + std::sin(angle) * (v - 0.5 * height_);
      light_[pixel(u, v)] *= static_cast<float>(1.0 + per_px * along);
    }
}

void SyntheticImage::expose_longer(double factor) {
  for (float& light : light_) light *= static_cast<float>(factor);
}

vpImage<unsigned char> SyntheticImage::expose(double noise, RandomStream& random) const {
  vpImage<unsigned char> image(static_cast<unsigned>(height_), static_cast<unsigned>(width_));
  const std::vector<float>& normal = normal_table();
  for (int v = 0; v < height_; ++v) {
    const std::size_t start = random.index(normal.size() - static_cast<std::size_t>(width_));
    for (int u = 0; u < width_; ++u) {
      const std::size_t i = pixel(u, v);
      const double value = static_cast<double>(light_[i]) +
                           noise * static_cast<double>(normal[start + static_cast<std::size_t>(u)]);
      image.bitmap[i] = static_cast<unsigned char>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
    }
  }
  return image;
}

}  // namespace vigia::tracking::testing
