#include "disc_coverage.hpp"

#include "simd.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vigia::sim {
namespace {

constexpr int kStrips = 16;

/// q(du, dv) = a du² + b du dv + c dv² + d du + e dv + f near one pixel, scaled to slope 1.
struct LocalConic {
  double a, b, c, d, e, f;
};

/// A pixel's ray and how it moves with the pixel.
struct MovingRay {
  Eigen::Vector3d r, r_u, r_v;
};

MovingRay moving_ray(const Intrinsics& k, int u, int v) {
  const double x = (u - k.u0) / k.px;
  const double y = (v - k.v0) / k.py;
  const double scale = 1.0 + k.kdu * (x * x + y * y);
  return {{scale * x, scale * y, 1.0},
          {(scale + 2.0 * k.kdu * x * x) / k.px, 2.0 * k.kdu * x * y / k.px, 0.0},
          {2.0 * k.kdu * x * y / k.py, (scale + 2.0 * k.kdu * y * y) / k.py, 0.0}};
}

LocalConic localise(const Eigen::Matrix3d& Q, const MovingRay& at) {
  const auto& [r, r_u, r_v] = at;
  const Eigen::Vector3d Qr = Q * r;
  const Eigen::Vector3d Qu = Q * r_u;
  LocalConic q{r_u.dot(Qu),       2.0 * r_v.dot(Qu), r_v.dot(Q * r_v),
               2.0 * r_u.dot(Qr), 2.0 * r_v.dot(Qr), r.dot(Qr)};
  const double per_slope = 1.0 / std::sqrt(q.d * q.d + q.e * q.e + 1e-24);
  for (double* term : {&q.a, &q.b, &q.c, &q.d, &q.e, &q.f}) *term *= per_slope;
  return q;
}

/// Share of the pixel where q ≥ 0: strips along the axis that the outline crosses.
VIGIA_PIXEL_LOOP
float covered_share(double a, double b, double c, double d, double e, double f) {
  std::array<double, kStrips> share{};
  const double curve = a < -1e-12 ? a : -1e-12;
  for (int i = 0; i < kStrips; ++i) {
    const double w = (i + 0.5) / kStrips - 0.5;
    const double slope = b * w + d;
    const double value = (c * w + e) * w + f;
    const double discriminant = slope * slope - 4.0 * curve * value;
    const double root = std::sqrt(discriminant > 0.0 ? discriminant : 0.0);
    // The root that does not cancel first, the other from their product.
    const double sum = -0.5 * (slope + (slope >= 0.0 ? root : -root));
    const double far = sum / curve;
    const double near = value / (sum != 0.0 ? sum : 1e-300);
    double low = far < near ? far : near;
    double high = far < near ? near : far;
    low = low > -0.5 ? low : -0.5;
    high = high < 0.5 ? high : 0.5;
    share[static_cast<std::size_t>(i)] = discriminant > 0.0 && high > low ? high - low : 0.0;
  }
  double sum = 0.0;
  for (const double s : share) sum += s;
  return static_cast<float>(sum / kStrips);
}

/// Signed distance of pixels to the outline, first order, px; positive inside.
struct Row {
  std::array<float, 6> q;  // Q00 Q01 Q02 Q11 Q12 Q22
  float x0, dx, y, dy, kdu;
};

VIGIA_PIXEL_LOOP
void signed_distance(const Row& row, int count, float* __restrict out) {
  const Row k = row;
  for (int i = 0; i < count; ++i) {
    const float xd = k.x0 + static_cast<float>(i) * k.dx;
    const float scale = 1.0F + k.kdu * (xd * xd + k.y * k.y);
    const float x = xd * scale;
    const float y = k.y * scale;
    const float gx = k.q[0] * x + k.q[1] * y + k.q[2];
    const float gy = k.q[1] * x + k.q[3] * y + k.q[4];
    const float gz = k.q[2] * x + k.q[4] * y + k.q[5];
    const float value = x * gx + y * gy + gz;
    const float cross = 2.0F * k.kdu * xd * k.y;
    const float gu = 2.0F * k.dx * (gx * (scale + 2.0F * k.kdu * xd * xd) + gy * cross);
    const float gv = 2.0F * k.dy * (gx * cross + gy * (scale + 2.0F * k.kdu * k.y * k.y));
    out[i] = value / std::sqrt(gu * gu + gv * gv + 1e-30F);
  }
}

/// out[i] = Σ weight[j] · in[i + j · step].
VIGIA_PIXEL_LOOP
void convolve(const float* __restrict in, std::ptrdiff_t step, const float* __restrict weight,
              int taps, int count, float* __restrict out) {
  for (int i = 0; i < count; ++i) out[i] = weight[0] * in[i];
  for (int j = 1; j < taps; ++j) {
    const float* const shifted = in + j * step;
    const float w = weight[j];
    for (int i = 0; i < count; ++i) out[i] += w * shifted[i];
  }
}

std::vector<float> gaussian_kernel(double sigma) {
  const int radius = blur_margin(sigma);
  std::vector<double> weights;
  weights.reserve(static_cast<std::size_t>(2) * static_cast<std::size_t>(radius) + 1);
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += weights.back();
  }
  std::vector<float> kernel;
  kernel.reserve(weights.size());
  for (const double weight : weights) kernel.push_back(static_cast<float>(weight / sum));
  return kernel;
}

float covered_share(const LocalConic& q) {
  return std::abs(q.d) >= std::abs(q.e) ? covered_share(q.a, q.b, q.c, q.d, q.e, q.f)
                                        : covered_share(q.c, q.b, q.a, q.e, q.d, q.f);
}

std::vector<float> coverage_through(const Intrinsics& intrinsics, const Eigen::Matrix3d& Q,
                                    const Eigen::Vector3d& /*front*/, const imaging::Window& window,
                                    float band) {
  const auto entry = [&](int i, int j) { return static_cast<float>(Q(i, j)); };
  Row row{{entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)},
          static_cast<float>((window.u - intrinsics.u0) / intrinsics.px),
          static_cast<float>(1.0 / intrinsics.px),
          0.0F,
          static_cast<float>(1.0 / intrinsics.py),
          static_cast<float>(intrinsics.kdu)};
  std::vector<float> coverage(static_cast<std::size_t>(window.width) *
                              static_cast<std::size_t>(window.height));
  float* out = coverage.data();
  for (int v = window.v; v < window.bottom(); ++v, out += window.width) {
    row.y = static_cast<float>((v - intrinsics.v0) / intrinsics.py);
    signed_distance(row, window.width, out);
    for (int i = 0; i < window.width; ++i)
      out[i] = std::abs(out[i]) > band
                   ? (out[i] > 0.0F ? 1.0F : 0.0F)
                   : covered_share(localise(Q, moving_ray(intrinsics, window.u + i, v)));
  }
  return coverage;
}

std::vector<float> coverage_through(const UnifiedOmni& omni, const Eigen::Matrix3d& Q,
                                    const Eigen::Vector3d& front, const imaging::Window& window,
                                    float band) {
  const CameraModel model = omni;
  std::vector<float> coverage(static_cast<std::size_t>(window.width) *
                              static_cast<std::size_t>(window.height));
  float* out = coverage.data();
  for (int v = window.v; v < window.bottom(); ++v) {
    for (int u = window.u; u < window.right(); ++u, ++out) {
      const Eigen::Vector2d uv(u, v);
      const auto r = ray(model, uv);
      if (!r || front.dot(*r) <= 0.0) continue;
      const auto dr_duv = *ray_jacobian(model, uv);
      const LocalConic q = localise(Q, {*r, dr_duv.col(0), dr_duv.col(1)});
      *out = std::abs(q.f) > band ? (q.f > 0.0 ? 1.0F : 0.0F) : covered_share(q);
    }
  }
  return coverage;
}

}  // namespace

std::vector<float> conic_coverage(const Eigen::Matrix3d& Q, const Eigen::Vector3d& front,
                                  const CameraModel& model, const imaging::Window& window,
                                  double min_curvature_px) {
  // Half a pixel's diagonal is 0.71. The first-order distance is up to 1.09 times the true one
  // where the radius of curvature exceeds 5 px; below that every pixel is cut.
  const float band = min_curvature_px > 5.0 ? 0.85F : 1e30F;
  return std::visit([&](const auto& m) { return coverage_through(m, Q, front, window, band); },
                    model);
}

int blur_margin(double sigma) {
  return static_cast<int>(std::ceil(4.0 * sigma));
}

void blur(std::vector<float>& image, const imaging::Window& window, double sigma) {
  if (sigma <= 0.0) return;
  const std::vector<float> kernel = gaussian_kernel(sigma);
  const int taps = static_cast<int>(kernel.size());
  const int margin = taps / 2;
  const std::ptrdiff_t stride = window.width;
  const int inner = window.width - 2 * margin;
  if (inner <= 0 || window.height <= 2 * margin) return;

  std::vector<float> across(image.size());
  for (int row = 0; row < window.height; ++row)
    convolve(image.data() + row * stride, 1, kernel.data(), taps, inner,
             across.data() + row * stride + margin);
  for (int row = margin; row < window.height - margin; ++row)
    convolve(across.data() + (row - margin) * stride + margin, stride, kernel.data(), taps, inner,
             image.data() + row * stride + margin);
}

}  // namespace vigia::sim
