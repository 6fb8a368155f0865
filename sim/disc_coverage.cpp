#include "disc_coverage.hpp"

#include "simd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

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

/// 1 inside and 0 outside, and whether a pixel is so near to the outline that it may be cut.
VIGIA_PIXEL_LOOP
void classify(float band, int count, float* __restrict distance, unsigned char* __restrict near) {
  for (int i = 0; i < count; ++i) {
    const float d = distance[i];
    near[i] = static_cast<unsigned char>((d < 0.0F ? -d : d) <= band);
    distance[i] = d > 0.0F ? 1.0F : 0.0F;
  }
}

/// Local conics of pixels of a row, a column a coefficient.
struct LocalConics {
  explicit LocalConics(std::size_t most) : near(most), u(most) {
    for (auto& column : q) column.resize(most);
  }
  /// Takes the pixels that are marked as near, of a row of @p width from @p first on.
  int take(int first, int width) {
    int count = 0;
    const unsigned char* const end = near.data() + width;
    for (const unsigned char* it = near.data();
         (it = static_cast<const unsigned char*>(
              std::memchr(it, 1, static_cast<std::size_t>(end - it)))) != nullptr;
         ++it)
      u[static_cast<std::size_t>(count++)] = first + static_cast<int>(it - near.data());
    return count;
  }
  LocalConic at(std::size_t i) const {
    return {q[0][i], q[1][i], q[2][i], q[3][i], q[4][i], q[5][i]};
  }

  std::vector<unsigned char> near;
  std::vector<std::int32_t> u;
  std::array<std::vector<double>, 6> q;  ///< as LocalConic
};

/// The quadratic form of a conic, and the lens through which it is seen.
struct ConicInLens {
  double q00, q01, q02, q11, q12, q22;
  double u0, px, v0, py, kdu;
};

ConicInLens conic_in_lens(const Eigen::Matrix3d& Q, const Intrinsics& k) {
  return {Q(0, 0), Q(0, 1), Q(0, 2), Q(1, 1), Q(1, 2), Q(2, 2), k.u0, k.px, k.v0, k.py, k.kdu};
}

/// localise() for pixels u[0 … count) of row @p v of a perspective picture.
VIGIA_PIXEL_LOOP
void localise_row(const ConicInLens& conic, const std::int32_t* __restrict u, int v, int count,
                  double* __restrict a, double* __restrict b, double* __restrict c,
                  double* __restrict d, double* __restrict e, double* __restrict f) {
  const ConicInLens k = conic;
  const double y = (v - k.v0) / k.py;
  for (int i = 0; i < count; ++i) {
    const double x = (u[i] - k.u0) / k.px;
    const double scale = 1.0 + k.kdu * (x * x + y * y);
    const double cross = 2.0 * k.kdu * x * y;
    const double r_x = scale * x;
    const double r_y = scale * y;
    const double u_x = (scale + 2.0 * k.kdu * x * x) / k.px;
    const double u_y = cross / k.px;
    const double v_x = cross / k.py;
    const double v_y = (scale + 2.0 * k.kdu * y * y) / k.py;
    const double Qr_x = k.q00 * r_x + k.q01 * r_y + k.q02;
    const double Qr_y = k.q01 * r_x + k.q11 * r_y + k.q12;
    const double Qr_z = k.q02 * r_x + k.q12 * r_y + k.q22;
    const double Qu_x = k.q00 * u_x + k.q01 * u_y;
    const double Qu_y = k.q01 * u_x + k.q11 * u_y;
    const double Qv_x = k.q00 * v_x + k.q01 * v_y;
    const double Qv_y = k.q01 * v_x + k.q11 * v_y;
    const double slope_u = 2.0 * (u_x * Qr_x + u_y * Qr_y);
    const double slope_v = 2.0 * (v_x * Qr_x + v_y * Qr_y);
    const double per_slope = 1.0 / std::sqrt(slope_u * slope_u + slope_v * slope_v + 1e-24);
    a[i] = per_slope * (u_x * Qu_x + u_y * Qu_y);
    b[i] = per_slope * (2.0 * (v_x * Qu_x + v_y * Qu_y));
    c[i] = per_slope * (v_x * Qv_x + v_y * Qv_y);
    d[i] = per_slope * slope_u;
    e[i] = per_slope * slope_v;
    f[i] = per_slope * (r_x * Qr_x + r_y * Qr_y + Qr_z);
  }
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
void signed_distance(const Row& row, int u, int count, float* __restrict out) {
  const Row k = row;
  for (int i = 0; i < count; ++i) {
    const float xd = k.x0 + static_cast<float>(u + i) * k.dx;
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

template <int kTaps>
VIGIA_PIXEL_BODY void add_taps(bool first, const float* __restrict in, std::ptrdiff_t step,
                               const float* __restrict weight, int count, float* __restrict out) {
  for (int i = 0; i < count; ++i) {
    float sum = first ? weight[0] * in[i] : out[i] + weight[0] * in[i];
    for (int j = 1; j < kTaps; ++j) sum += weight[j] * in[i + j * step];
    out[i] = sum;
  }
}

/// out[i] = Σ weight[j] · in[i + j · step], four taps at a time.
VIGIA_PIXEL_LOOP
void convolve(const float* __restrict in, std::ptrdiff_t step, const float* __restrict weight,
              int taps, int count, float* __restrict out) {
  int j = 0;
  for (; j + 4 <= taps; j += 4) add_taps<4>(j == 0, in + j * step, step, weight + j, count, out);
  const float* const rest = in + j * step;
  if (taps - j == 3) add_taps<3>(j == 0, rest, step, weight + j, count, out);
  if (taps - j == 2) add_taps<2>(j == 0, rest, step, weight + j, count, out);
  if (taps - j == 1) add_taps<1>(j == 0, rest, step, weight + j, count, out);
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
  // Farther from the outline than a corner of the pixel, with what the conic bends until there.
  const double reach = 0.5 * (std::abs(q.d) + std::abs(q.e)) +
                       0.25 * (std::abs(q.a) + std::abs(q.b) + std::abs(q.c)) + 1e-9;
  if (std::abs(q.f) > reach) return q.f > 0.0 ? 1.0F : 0.0F;
  return std::abs(q.d) >= std::abs(q.e) ? covered_share(q.a, q.b, q.c, q.d, q.e, q.f)
                                        : covered_share(q.c, q.b, q.a, q.e, q.d, q.f);
}

std::vector<float> coverage_through(const Intrinsics& intrinsics, const Eigen::Matrix3d& Q,
                                    const Eigen::Vector3d& /*front*/, const imaging::Window& window,
                                    float band) {
  const auto entry = [&](int i, int j) { return static_cast<float>(Q(i, j)); };
  Row row{{entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)},
          static_cast<float>(-intrinsics.u0 / intrinsics.px),
          static_cast<float>(1.0 / intrinsics.px),
          0.0F,
          static_cast<float>(1.0 / intrinsics.py),
          static_cast<float>(intrinsics.kdu)};
  std::vector<float> coverage(static_cast<std::size_t>(window.width) *
                              static_cast<std::size_t>(window.height));
  const ConicInLens conic = conic_in_lens(Q, intrinsics);
  LocalConics edge(static_cast<std::size_t>(window.width));
  float* out = coverage.data();
  for (int v = window.v; v < window.bottom(); ++v, out += window.width) {
    row.y = static_cast<float>((v - intrinsics.v0) / intrinsics.py);
    signed_distance(row, window.u, window.width, out);
    classify(band, window.width, out, edge.near.data());
    const int cut = edge.take(window.u, window.width);
    localise_row(conic, edge.u.data(), v, cut, edge.q[0].data(), edge.q[1].data(), edge.q[2].data(),
                 edge.q[3].data(), edge.q[4].data(), edge.q[5].data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(cut); ++i)
      out[edge.u[i] - window.u] = covered_share(edge.at(i));
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

float blurred_one(double sigma) {
  const int side = 2 * blur_margin(sigma) + 1;
  std::vector<float> ones(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 1.0F);
  blur(ones, {0, 0, side, side}, sigma);
  return ones[ones.size() / 2];
}

}  // namespace vigia::sim
