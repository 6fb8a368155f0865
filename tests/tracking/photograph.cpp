#include "tracking/photograph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpImageConvert.h>

#include "vigia/core/angle.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/imaging/thumbnail.hpp"

namespace vigia::tracking::testing {
namespace {

constexpr float kPaper = 0.85F;

/// The kernel of a disc or a line on the fine grid, smooth at its rim.
cv::Mat1f disc_kernel(double diameter) {
  const int reach = static_cast<int>(std::ceil(0.5 * diameter)) + 1;
  cv::Mat1f kernel(2 * reach + 1, 2 * reach + 1);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      kernel(y + reach, x + reach) =
          static_cast<float>(std::clamp(0.5 * diameter - std::hypot(x, y) + 0.5, 0.0, 1.0));
  return cv::Mat1f(kernel / cv::sum(kernel)[0]);
}

cv::Mat1f line_kernel(double length, double angle) {
  const int reach = static_cast<int>(std::ceil(0.5 * length)) + 1;
  cv::Mat1f kernel(2 * reach + 1, 2 * reach + 1, 0.0F);
  const int steps = 8 * (reach + 1);
  for (int i = 0; i < steps; ++i) {
    const double s = length * ((i + 0.5) / steps - 0.5);
    const double x = s * std::cos(angle) + reach;
    const double y = s * std::sin(angle) + reach;
    const int x0 = static_cast<int>(std::floor(x));
    const int y0 = static_cast<int>(std::floor(y));
    const auto fx = static_cast<float>(x - x0);
    const auto fy = static_cast<float>(y - y0);
    kernel(y0, x0) += (1 - fx) * (1 - fy);
    kernel(y0, x0 + 1) += fx * (1 - fy);
    kernel(y0 + 1, x0) += (1 - fx) * fy;
    kernel(y0 + 1, x0 + 1) += fx * fy;
  }
  return cv::Mat1f(kernel / cv::sum(kernel)[0]);
}

/// Blurs wider than this are done on whole pixels, which sample them finely enough.
constexpr double kFineBlur = 1.2;  // px

void blur_finely(cv::Mat3f& light, const PhotoParams& params) {
  if (params.blur_px > 0.0 && params.blur_px <= kFineBlur)
    cv::GaussianBlur(light, light, cv::Size(), params.blur_px * params.fine, 0.0,
                     cv::BORDER_REPLICATE);
}

void blur_pixels(cv::Mat3f& light, const PhotoParams& params) {
  if (params.blur_px > kFineBlur)
    cv::GaussianBlur(light, light, cv::Size(), params.blur_px, 0.0, cv::BORDER_REPLICATE);
  if (params.defocus_px > 0.5)
    cv::filter2D(light, light, -1, disc_kernel(params.defocus_px), {-1, -1}, 0.0,
                 cv::BORDER_REPLICATE);
  if (params.motion_px > 0.5)
    cv::filter2D(light, light, -1, line_kernel(params.motion_px, params.motion_angle), {-1, -1},
                 0.0, cv::BORDER_REPLICATE);
}

/// Red and blue moved against green.
void shift_channels(cv::Mat3f& light, const PhotoParams& params, double scale) {
  std::vector<cv::Mat> channels;
  cv::split(light, channels);
  const std::array<std::pair<int, cv::Vec2d>, 2> shifts{
      {{0, params.red_shift}, {2, params.blue_shift}}};
  for (const auto& [channel, shift] : shifts) {
    if (shift == cv::Vec2d(0, 0)) continue;
    const cv::Mat1d move = (cv::Mat1d(2, 3) << 1, 0, shift[0] * scale, 0, 1, shift[1] * scale);
    const auto index = static_cast<std::size_t>(channel);
    cv::warpAffine(channels[index], channels[index], move, light.size(), cv::INTER_LINEAR,
                   cv::BORDER_REPLICATE);
  }
  cv::merge(channels, light);
}

void illuminate(cv::Mat3f& light, const PhotoParams& params) {
  const double u0 = 0.5 * (light.cols - 1);
  const double v0 = 0.5 * (light.rows - 1);
  for (int v = 0; v < light.rows; ++v)
    for (int u = 0; u < light.cols; ++u) {
      const double du = u - u0;
      const double dv = v - v0;
      const auto share = static_cast<float>(u / std::max(1.0, light.cols - 1.0));
      const double radius = (du * du + dv * dv) / (u0 * u0 + v0 * v0);
      const double factor =
          params.white * (1.0 - params.vignetting * radius) *
          std::max(0.05, 1.0 + params.light_slope[0] * du + params.light_slope[1] * dv);
      double added = params.haze;
      for (const auto& glare : params.glares)
        added +=
            glare.strength * std::exp(-0.5 * (std::pow(u - glare.u, 2) + std::pow(v - glare.v, 2)) /
                                      (glare.radius * glare.radius));
      cv::Vec3f& pixel = light(v, u);
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<float>(factor * (pixel[c] + added)) *
                   ((1.0F - share) * params.light[c] + share * params.other_light[c]);
    }
}

void add_raw_noise(cv::Mat3f& light, double sigma, RandomStream& random) {
  if (sigma <= 0.0) return;
  cv::RNG rng(random.engine()());
  cv::Mat3f noise(light.size());
  rng.fill(noise, cv::RNG::NORMAL, 0.0, sigma);
  // Read noise, and shot noise that has the same size at full light.
  for (int v = 0; v < light.rows; ++v)
    for (int u = 0; u < light.cols; ++u)
      for (int c = 0; c < 3; ++c) {
        float& value = light(v, u)[c];
        value += noise(v, u)[c] * std::sqrt(0.1F + 0.9F * std::clamp(value, 0.0F, 1.0F));
      }
}

/// Keeps one channel a pixel and interpolates the others.
void mosaic(cv::Mat3f& light) {
  cv::Mat1w raw(light.size());
  for (int v = 0; v < light.rows; ++v)
    for (int u = 0; u < light.cols; ++u) {
      const int channel = v % 2 == 0 ? (u % 2 == 0 ? 0 : 1) : (u % 2 == 0 ? 1 : 2);
      raw(v, u) =
          cv::saturate_cast<std::uint16_t>(65535.0F * std::clamp(light(v, u)[channel], 0.0F, 1.0F));
    }
  cv::Mat colour;
  // OpenCV names the pattern by its second row and column: this is RGGB, to R, G, B.
  cv::demosaicing(raw, colour, cv::COLOR_BayerBG2RGB);
  colour.convertTo(light, CV_32F, 1.0 / 65535.0);
}

float encode(float value, PhotoParams::Response response) {
  value = std::clamp(value, 0.0F, 1.0F);
  if (response == PhotoParams::Response::linear) return value;
  return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1.0F / 2.4F) - 0.055F;
}

cv::Mat3b digitise(const cv::Mat3f& light, const PhotoParams& params, RandomStream& random) {
  std::array<float, 4097> table{};
  for (int i = 0; i <= 4096; ++i)
    table[static_cast<std::size_t>(i)] =
        255.0F * encode(static_cast<float>(i) / 4096.0F, params.response);
  cv::Mat3f noise(light.size(), cv::Vec3f(0, 0, 0));
  if (params.noise > 0.0) {
    cv::RNG rng(random.engine()());
    rng.fill(noise, cv::RNG::NORMAL, 0.0, params.noise);
  }
  cv::Mat3b out(light.size());
  for (int v = 0; v < light.rows; ++v)
    for (int u = 0; u < light.cols; ++u)
      for (int c = 0; c < 3; ++c) {
        const float place = 4096.0F * std::clamp(light(v, u)[c], 0.0F, 1.0F);
        const int index = std::min(static_cast<int>(place), 4095);
        const float low = table[static_cast<std::size_t>(index)];
        const float high = table[static_cast<std::size_t>(index) + 1];
        // R, G, B to the order of OpenCV's codecs.
        out(v, u)[2 - c] = cv::saturate_cast<unsigned char>(
            low + (place - static_cast<float>(index)) * (high - low) + noise(v, u)[c]);
      }
  if (params.jpeg > 0) {
    vpImage<vpRGBa> picture;
    vpImageConvert::convert(out, picture);
    const imaging::ImageFrame decoded =
        imaging::decode_picture(imaging::encode_jpeg(picture, params.jpeg), "a photograph");
    decoded.read_colour({0, 0, decoded.width(), decoded.height()}, picture.bitmap, decoded.width());
    cv::Mat bgr;
    vpImageConvert::convert(picture, bgr);
    out = bgr;
  }
  return out;
}

cv::Mat3b expose(const cv::Mat3f& scene, const PhotoParams& params, RandomStream& random) {
  cv::Mat3f light = scene.clone();
  shift_channels(light, params, params.fine);
  blur_finely(light, params);
  if (params.fine > 1)
    cv::resize(light, light, cv::Size(light.cols / params.fine, light.rows / params.fine), 0.0, 0.0,
               cv::INTER_AREA);
  blur_pixels(light, params);
  illuminate(light, params);
  add_raw_noise(light, params.raw_noise, random);
  if (params.bayer) mosaic(light);
  return digitise(light, params, random);
}

/// A number in [0, 1) for jitter.
class Jitter {
 public:
  explicit Jitter(std::uint64_t seed) : state_(seed | 1U) {}
  double operator()() {
    state_ ^= state_ << 13U;
    state_ ^= state_ >> 7U;
    state_ ^= state_ << 17U;
    return static_cast<double>(state_ >> 11U) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

/// What is seen at a point of the sheet's plane; nothing beside it.
std::optional<cv::Vec3f> ink_of(const Print& print, const std::vector<Sticker>& stickers, double x,
                                double y) {
  auto ink = print(x, y);
  for (const Sticker& sticker : stickers) {
    const double dx = x - sticker.centre_l.x();
    const double dy = y - sticker.centre_l.y();
    const double r = sticker.round ? std::hypot(dx, dy) : std::max(std::abs(dx), std::abs(dy));
    if (r <= sticker.radius_m) ink = sticker.ink;
  }
  return ink;
}

/// Whether one of the eight neighbours differs.
bool on_edge(const cv::Mat3f& light, int x, int y) {
  for (int v = std::max(0, y - 1); v <= std::min(light.rows - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(light.cols - 1, x + 1); ++u)
      if (light(v, u) != light(y, x)) return true;
  return false;
}

}  // namespace

Inks strong_inks() {
  return {cv::Vec3f(0.04F, 0.04F, 0.04F), cv::Vec3f(0.60F, 0.06F, 0.07F),
          cv::Vec3f(0.06F, 0.38F, 0.14F), cv::Vec3f(0.06F, 0.12F, 0.50F)};
}

Inks pale_inks() {
  return {cv::Vec3f(0.12F, 0.12F, 0.12F), cv::Vec3f(0.70F, 0.25F, 0.25F),
          cv::Vec3f(0.25F, 0.58F, 0.32F), cv::Vec3f(0.25F, 0.35F, 0.66F)};
}

Inks varied(Inks inks, float spread, RandomStream& random) {
  const auto change = [&](double low, double high) {
    return static_cast<float>(random.uniform(low, high)) * spread;
  };
  for (cv::Vec3f& ink : inks) {
    const float common = change(-0.5, 1.0);
    for (int c = 0; c < 3; ++c)
      ink[c] = std::clamp(ink[c] + common + change(-0.3, 0.3), 0.01F, 0.75F);
  }
  return inks;
}

Print print_of_pattern(const PatternShape& shape, const Inks& inks) {
  return [=, dots = pattern_dots(shape)](double x, double y) -> std::optional<cv::Vec3f> {
    if (std::max(std::abs(x), std::abs(y)) > shape.sheet_half_width_m) return std::nullopt;
    const double r = std::sqrt(x * x + y * y);
    std::size_t near = 0;
    if (r > 0.5 * shape.inner_radius_m) {
      const double off =
          std::min(std::abs(r - shape.inner_radius_m), std::abs(r - shape.outer_radius_m));
      if (off > shape.dot_radius_m) return cv::Vec3f(kPaper, kPaper, kPaper);
      // Clockwise from the upward axis.
      const double turn = std::atan2(x, y) * kDotsPerRing / (2.0 * kPi);
      const long slot = (std::lround(turn) + kDotsPerRing) % kDotsPerRing;
      const bool outer = r > 0.5 * (shape.inner_radius_m + shape.outer_radius_m);
      near = static_cast<std::size_t>(1 + slot + (outer ? 0 : kDotsPerRing));
    }
    const PatternDot& dot = dots[near];
    if (std::pow(x - dot.centre_l.x(), 2) + std::pow(y - dot.centre_l.y(), 2) >
        dot.radius_m * dot.radius_m)
      return cv::Vec3f(kPaper, kPaper, kPaper);
    return inks[static_cast<std::size_t>(dot.colour)];
  };
}

Print print_of_tag(const std::vector<std::vector<bool>>& black, double side_m, double quiet_zone) {
  const auto fields = static_cast<int>(black.size());
  const double field = side_m / fields;
  return [=](double x, double y) -> std::optional<cv::Vec3f> {
    if (std::max(std::abs(x), std::abs(y)) > 0.5 * side_m + quiet_zone * field) return std::nullopt;
    const int column = static_cast<int>(std::floor((x + 0.5 * side_m) / field));
    const int row = static_cast<int>(std::floor((0.5 * side_m - y) / field));
    const bool inside = row >= 0 && row < fields && column >= 0 && column < fields;
    const bool dark =
        inside && black[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    const float grey = dark ? 0.06F : kPaper;
    return cv::Vec3f(grey, grey, grey);
  };
}

Print print_of_discs(double width_m, std::vector<PrintedDisc> discs) {
  return [width_m, discs = std::move(discs)](double x, double y) -> std::optional<cv::Vec3f> {
    if (std::max(std::abs(x), std::abs(y)) > 0.5 * width_m) return std::nullopt;
    for (const PrintedDisc& disc : discs) {
      const double r = std::hypot(x - disc.x, y - disc.y);
      if (r <= disc.radius && r >= disc.hole) return disc.ink;
    }
    return cv::Vec3f(kPaper, kPaper, kPaper);
  };
}

Eigen::Vector2d SheetView::operator()(const Eigen::Vector2d& p_l) const {
  return (iHl * p_l.homogeneous()).hnormalized();
}

Eigen::Vector2d SheetView::circle_centre(const Eigen::Vector2d& centre_l, double radius) const {
  // The dual conic of the circle, mapped; its pole of the line at infinity is the centre.
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  shift.topRightCorner<2, 1>() = centre_l;
  const Eigen::Matrix3d dual =
      shift * Eigen::Vector3d(radius * radius, radius * radius, -1.0).asDiagonal() *
      shift.transpose();
  const Eigen::Matrix3d image = iHl * dual * iHl.transpose();
  return image.col(2).hnormalized();
}

SheetView view_of_sheet(double width_m, double width_px, double slant, double direction,
                        double roll, double focal, const Eigen::Vector2d& centre, int width,
                        int height) {
  const double distance = focal * width_m / width_px;
  // Columns: the plane's x and y in the camera's axes (x right, y down, z forward).
  const Eigen::Vector3d axis(-std::sin(direction), std::cos(direction), 0.0);
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(slant, axis).toRotationMatrix();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d flip = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const Eigen::Matrix3d rotation = tilt * turn * flip;
  Eigen::Matrix3d pose;
  pose << rotation.col(0), rotation.col(1), Eigen::Vector3d(0.0, 0.0, distance);
  Eigen::Matrix3d K;
  K << focal, 0.0, centre.x(), 0.0, focal, centre.y(), 0.0, 0.0, 1.0;
  return {K * pose, width, height};
}

cv::Mat3f plain_wall(int width, int height, int fine, const cv::Vec3f& grey) {
  return cv::Mat3f(height * fine, width * fine, grey);
}

cv::Mat3f cluttered_wall(int width, int height, int fine, int pieces, RandomStream& random) {
  const auto colour = [&] {
    const double grey = random.uniform(0.03, 0.7);
    const double tint = random.index(2) == 0 ? 0.0 : 0.5;
    return cv::Scalar(grey * (1.0 + random.uniform(-tint, tint)),
                      grey * (1.0 + random.uniform(-tint, tint)),
                      grey * (1.0 + random.uniform(-tint, tint)));
  };
  cv::Mat3f wall(height * fine, width * fine);
  wall.setTo(colour());
  for (int i = 0; i < pieces; ++i) {
    const cv::Point2f at(static_cast<float>(random.uniform(0, wall.cols)),
                         static_cast<float>(random.uniform(0, wall.rows)));
    const auto size = static_cast<float>(fine * random.uniform(3.0, 60.0));
    const auto ratio = static_cast<float>(random.uniform(0.2, 1.0));
    const auto angle = static_cast<float>(random.uniform(0.0, 180.0));
    const cv::RotatedRect box(at, {size, size * ratio}, angle);
    switch (random.index(4)) {
      case 0:
        cv::ellipse(wall, box, colour(), cv::FILLED);
        break;
      case 1:
        cv::ellipse(wall, box, colour(), 1 + static_cast<int>(size / 8));
        break;
      case 2:
        cv::putText(wall, random.index(2) == 0 ? "oO0.:%" : "B8&8a", at, cv::FONT_HERSHEY_SIMPLEX,
                    size / 30, colour(), 1 + fine);
        break;
      default: {
        std::array<cv::Point2f, 4> corners;
        box.points(corners.data());
        std::vector<cv::Point> polygon(corners.begin(), corners.end());
        cv::fillConvexPoly(wall, polygon, colour());
      }
    }
  }
  return wall;
}

void lay_sheet(cv::Mat3f& wall, int fine, const SheetView& view, const Print& print,
               const std::vector<Sticker>& stickers, RandomStream& random) {
  const Eigen::Matrix3d lHi = view.iHl.inverse();
  // Seen from the front only: the third coordinate has one sign before the camera.
  const double sign =
      (lHi * Eigen::Vector3d(view.iHl.col(2).hnormalized().homogeneous())).z() > 0 ? 1.0 : -1.0;
  Jitter jitter(random.engine()());
  const double step = 1.0 / fine;
  const auto ink_at = [&](double x, double y) -> std::optional<cv::Vec3f> {
    const Eigen::Vector3d p = lHi * Eigen::Vector3d(x * step - 0.5, y * step - 0.5, 1.0);
    if (sign * p.z() <= 0.0) return std::nullopt;
    return ink_of(print, stickers, p.x() / p.z(), p.y() / p.z());
  };
  const cv::Mat3f behind = wall.clone();
  for (int y = 0; y < wall.rows; ++y)
    for (int x = 0; x < wall.cols; ++x)
      if (const auto ink = ink_at(x + 0.5, y + 0.5)) wall(y, x) = *ink;
  // One sample a cell would move edges by more than a camera's noise does.
  constexpr int kSamples = 6;
  const cv::Mat3f once = wall.clone();
  for (int y = 0; y < wall.rows; ++y)
    for (int x = 0; x < wall.cols; ++x) {
      if (!on_edge(once, x, y)) continue;
      cv::Vec3f sum(0.0F, 0.0F, 0.0F);
      for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i)
          sum += ink_at(x + (i + jitter()) / kSamples, y + (j + jitter()) / kSamples)
                     .value_or(behind(y, x));
      wall(y, x) = sum * (1.0F / (kSamples * kSamples));
    }
}

vpImage<vpRGBa> photograph(const cv::Mat3f& scene, const PhotoParams& params,
                           RandomStream& random) {
  const cv::Mat3b bgr = expose(scene, params, random);
  vpImage<vpRGBa> out(static_cast<unsigned>(bgr.rows), static_cast<unsigned>(bgr.cols));
  for (int v = 0; v < bgr.rows; ++v)
    for (int u = 0; u < bgr.cols; ++u) {
      const cv::Vec3b& pixel = bgr(v, u);
      out[static_cast<unsigned>(v)][u] = vpRGBa(pixel[2], pixel[1], pixel[0]);
    }
  return out;
}

vpImage<unsigned char> grey_photograph(const cv::Mat3f& scene, const PhotoParams& params,
                                       RandomStream& random) {
  const cv::Mat3b bgr = expose(scene, params, random);
  vpImage<unsigned char> out(static_cast<unsigned>(bgr.rows), static_cast<unsigned>(bgr.cols));
  for (int v = 0; v < bgr.rows; ++v)
    for (int u = 0; u < bgr.cols; ++u) out[static_cast<unsigned>(v)][u] = bgr(v, u)[1];
  return out;
}

}  // namespace vigia::tracking::testing
