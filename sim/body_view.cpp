#include "body_view.hpp"

#include "simd.hpp"
#include "single.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::sim {
namespace {

using imaging::Window;

/// The corners of the box that holds a limb, in frame c.
std::array<Eigen::Vector3d, 8> box_corners(const BodyPart& part, const Eigen::Isometry3d& cMw) {
  const Eigen::Matrix3d to_world = part.A.inverse();
  const double across = part.round ? 1.0 : 1.0 + std::max(0.0, part.taper);
  std::array<Eigen::Vector3d, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d q((i & 1U) != 0 ? across : -across, (i & 2U) != 0 ? across : -across,
                            (i & 4U) != 0 ? 1.0 : (part.round ? -1.0 : 0.0));
    corners[i] = cMw * (part.c + to_world * q);
  }
  return corners;
}

/// Pixels round the image of the box that holds a limb; the whole frame when part of it is behind
/// the camera, or the camera's picture is not perspective: there the box bulges.
Window image_box(const BodyPart& part, const Eigen::Isometry3d& cMw, const CameraModel& model) {
  const Window frame{0, 0, image_width(model), image_height(model)};
  if (!is_perspective(model)) return frame;
  constexpr double kNearest_m = 0.05;
  double u0 = 1e9;
  double v0 = 1e9;
  double u1 = -1e9;
  double v1 = -1e9;
  int behind = 0;
  for (const Eigen::Vector3d& p_c : box_corners(part, cMw)) {
    if (p_c.z() < kNearest_m) ++behind;
    const auto uv = project(model, p_c);
    if (!uv) continue;
    u0 = std::min(u0, uv->x());
    v0 = std::min(v0, uv->y());
    u1 = std::max(u1, uv->x());
    v1 = std::max(v1, uv->y());
  }
  if (behind == 8) return {};
  if (behind > 0 || u1 < u0) return frame;
  const auto bounded = [](double pixel) { return std::clamp(pixel, -1e6, 1e6); };
  const double margin = 3.0 + 0.02 * std::max(u1 - u0, v1 - v0);  // the lens bends the edges
  const int left = static_cast<int>(std::floor(bounded(u0 - margin)));
  const int top = static_cast<int>(std::floor(bounded(v0 - margin)));
  const int right = static_cast<int>(std::ceil(bounded(u1 + margin)));
  const int bottom = static_cast<int>(std::ceil(bounded(v1 + margin)));
  return intersect({left, top, right - left, bottom - top}, frame);
}

/// −1…1, of period 1.
inline float triangle(float x) {
  const float away = x + 4096.0F;  // rounding towards 0 is rounding down
  const float part = away - static_cast<float>(static_cast<std::int32_t>(away));
  const float half = part > 0.5F ? 1.0F - part : part;
  return 4.0F * half - 1.0F;
}

}  // namespace

template <bool kPerspective>
VIGIA_PIXEL_BODY void BodyPartView::paint_row(const Constants& constants, const Rays& rays,
                                              int count, float* __restrict nearest,
                                              float* __restrict grey,
                                              unsigned char* __restrict hit) {
  const Constants k = constants;
  const float* __restrict x = rays.x;
  const float* __restrict y = rays.y;
  const float* __restrict rz = rays.z;
  // Sphere: |o + t d|² = 1. Frustum: qx² + qy² − (1 + taper·qz)² = 0.
  const float w0 = k.round > 0.5F ? k.origin[2] : 1.0F + k.taper * k.origin[2];
  const float sign = k.round > 0.5F ? 1.0F : -1.0F;
  const float offset = k.round > 0.5F ? 1.0F : 0.0F;
  const float scale = k.round > 0.5F ? 1.0F : k.taper;
  const float low = k.round > 0.5F ? -2.0F : 0.0F;
  const float high = k.round > 0.5F ? 2.0F : 1.0F;
  const float c = k.origin[0] * k.origin[0] + k.origin[1] * k.origin[1] + sign * w0 * w0 - offset;
  for (int i = 0; i < count; ++i) {
    const float z = kPerspective ? 1.0F : rz[i];
    const float dx = k.ray[0] * x[i] + k.ray[1] * y[i] + k.ray[2] * z;
    const float dy = k.ray[3] * x[i] + k.ray[4] * y[i] + k.ray[5] * z;
    const float dz = k.ray[6] * x[i] + k.ray[7] * y[i] + k.ray[8] * z;
    const float dw = scale * dz;
    const float a = dx * dx + dy * dy + sign * dw * dw;
    const float b = k.origin[0] * dx + k.origin[1] * dy + sign * w0 * dw;
    const float discriminant = b * b - a * c;
    const float root = std::sqrt(discriminant > 0.0F ? discriminant : 0.0F);
    // The nearer root c / (−b + root), which does not cancel in front of the limb.
    const float inverse = (root - b) / (c > 1e-6F ? c : 1e-6F);
    const float depth = 1.0F / (inverse > 1e-6F ? inverse : 1e-6F);
    const float qx = k.origin[0] + depth * dx;
    const float qy = k.origin[1] + depth * dy;
    const float qz = k.origin[2] + depth * dz;
    const float gw = sign * scale * (w0 + depth * dw);
    const float nx = k.normal[0] * qx + k.normal[1] * qy + k.normal[2] * gw;
    const float ny = k.normal[3] * qx + k.normal[4] * qy + k.normal[5] * gw;
    const float nz = k.normal[6] * qx + k.normal[7] * qy + k.normal[8] * gw;
    const float per_length = 1.0F / std::sqrt(nx * nx + ny * ny + nz * nz + 1e-20F);
    const float facing = -(nx * x[i] + ny * y[i] + nz * z) * per_length /
                         std::sqrt(x[i] * x[i] + y[i] * y[i] + z * z);
    const float upward = (k.up[0] * nx + k.up[1] * ny + k.up[2] * nz) * per_length;
    const float cloth = triangle(7.0F * qz + 0.6F * qx) * triangle(3.0F * (qx - qy));
    const float shade = 0.55F + 0.30F * (facing > 0.0F ? facing : 0.0F) + 0.18F * upward;
    const bool meets =
        (c > 0.0F) & (discriminant > 0.0F) & (inverse > nearest[i]) & (qz >= low) & (qz <= high);
    nearest[i] = meets ? inverse : nearest[i];
    grey[i] = meets ? (k.grey + k.pattern * cloth) * shade : grey[i];
    hit[i] = meets ? static_cast<unsigned char>(1) : hit[i];
  }
}

VIGIA_PIXEL_LOOP
void BodyPartView::paint_perspective(const Constants& constants, const Rays& rays, int count,
                                     float* nearest, float* grey, unsigned char* hit) {
  paint_row<true>(constants, rays, count, nearest, grey, hit);
}

VIGIA_PIXEL_LOOP
void BodyPartView::paint_any(const Constants& constants, const Rays& rays, int count,
                             float* nearest, float* grey, unsigned char* hit) {
  paint_row<false>(constants, rays, count, nearest, grey, hit);
}

BodyPartView::BodyPartView(const BodyPart& part, const Eigen::Isometry3d& wMc,
                           const CameraModel& model)
    : constants_{single(Eigen::Matrix3d(part.A * wMc.linear())),
                 single(Eigen::Vector3d(part.A * (wMc.translation() - part.c))),
                 single(Eigen::Matrix3d((part.A * wMc.linear()).transpose())),
                 single(Eigen::Vector3d(wMc.linear().row(2).transpose())),
                 static_cast<float>(part.taper),
                 part.round ? 1.0F : 0.0F,
                 part.grey,
                 part.pattern},
      tint_(part.tint),
      box_(image_box(part, wMc.inverse(Eigen::Isometry), model)) {
  if (!is_perspective(model)) enclose(part, wMc.inverse(Eigen::Isometry));
}

void BodyPartView::enclose(const BodyPart& part, const Eigen::Isometry3d& cMw) {
  constexpr double kSlack = 1e-4;  // of single precision
  const std::array<Eigen::Vector3d, 8> corners = box_corners(part, cMw);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners) middle += corner / 8.0;
  double radius = 0.0;
  for (const Eigen::Vector3d& corner : corners) radius = std::max(radius, (corner - middle).norm());
  const double sine = radius / middle.norm();
  if (!(sine < 1.0)) return;
  const Eigen::Vector3f axis = middle.normalized().cast<float>();
  middle_ = {axis.x(), axis.y(), axis.z()};
  cos_radius_ = static_cast<float>(std::sqrt(1.0 - sine * sine) - kSlack);
}

void BodyPartView::paint(const Rays& rays, int count, float* nearest, float* grey,
                         unsigned char* hit) const {
  if (rays.z == nullptr)
    paint_perspective(constants_, rays, count, nearest, grey, hit);
  else
    paint_any(constants_, rays, count, nearest, grey, hit);
}

}  // namespace vigia::sim
