#include "vigia/report/foxglove.hpp"

#include "base64.hpp"
#include "foxglove_json.hpp"
#include "foxglove_schemas.hpp"
#include "outlines.hpp"
#include "palette.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vigia::report::foxglove {
namespace {

/// PointsAnnotationType.
enum class Annotation { points = 1, line_loop = 2 };

Json orientation_json(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

template <typename Matrix>
Json row_major(const Matrix& matrix) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) list.push_back(matrix(i, j));
  return list;
}

/// Foxglove's pixel coordinates begin at the corner of the first pixel, not in its middle.
Json pixel_json(const Eigen::Vector2d& uv) {
  return point_json(Eigen::Vector2d(uv.x() + 0.5, uv.y() + 0.5));
}

Json annotation(Stamp at, Annotation type, const std::vector<Eigen::Vector2d>& pixels,
                const Colour& colour, double thickness_px) {
  Json points = Json::array();
  for (const auto& uv : pixels)
    if (uv.allFinite()) points.push_back(pixel_json(uv));
  return {{"timestamp", time_json(at)},
          {"type", static_cast<int>(type)},
          {"points", points},
          {"outline_color", colour_json(colour)},
          {"outline_colors", Json::array()},
          {"fill_color", colour_json(colour.with_alpha(0.0))},
          {"thickness", thickness_px}};
}

Json text_annotation(Stamp at, const std::string& text, double row) {
  constexpr double kFont_px = 14.0;
  return {{"timestamp", time_json(at)},
          {"position", pixel_json({6.0, kFont_px * (1.0 + 1.3 * row)})},
          {"text", text},
          {"font_size", kFont_px},
          {"text_color", colour_json(palette::kWhite)},
          {"background_color", colour_json(palette::kBlack.with_alpha(0.5))}};
}

/// x_d = x_u (1 + k₁r² + k₂r⁴ + k₃r⁶) from x_u = x_d (1 + k r²): the series' reversion.
Json plumb_bob(double kdu) {
  return Json::array({-kdu, 3.0 * kdu * kdu, 0.0, 0.0, -12.0 * kdu * kdu * kdu});
}

}  // namespace

// ---- parts --------------------------------------------------------------------------------------

Json number_json(double value) {
  return std::round(value * 1e6) / 1e6;
}

Json time_json(Stamp at) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return {{"sec", at.ns / kSecond}, {"nsec", at.ns % kSecond}};
}

Json point_json(const Eigen::Vector2d& p) {
  return {{"x", number_json(p.x())}, {"y", number_json(p.y())}};
}

Json point_json(const Eigen::Vector3d& p) {
  return {{"x", number_json(p.x())}, {"y", number_json(p.y())}, {"z", number_json(p.z())}};
}

Json pose_json(const Eigen::Isometry3d& aMb) {
  return {{"position", point_json(Eigen::Vector3d(aMb.translation()))},
          {"orientation", orientation_json(aMb.linear())}};
}

Json colour_json(const Colour& colour) {
  return {{"r", number_json(colour.r)},
          {"g", number_json(colour.g)},
          {"b", number_json(colour.b)},
          {"a", colour.alpha}};
}

std::string text_of(const Json& message) {
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const McapSchema& schema(Message message) {
  return kSchemas.at(static_cast<std::size_t>(message));
}

// ---- messages -----------------------------------------------------------------------------------

std::string frame_transforms(Stamp at, const std::vector<Transform>& transforms) {
  Json list = Json::array();
  for (const Transform& each : transforms)
    list.push_back({{"timestamp", time_json(at)},
                    {"parent_frame_id", each.parent},
                    {"child_frame_id", each.child},
                    {"translation", point_json(Eigen::Vector3d(each.parent_M_child.translation()))},
                    {"rotation", orientation_json(each.parent_M_child.linear())}});
  return text_of({{"transforms", list}});
}

std::string pose_in_frame(Stamp at, const Eigen::Isometry3d& wMr) {
  return text_of(
      {{"timestamp", time_json(at)}, {"frame_id", kWorldFrame}, {"pose", pose_json(wMr)}});
}

std::string poses_in_frame(Stamp at, const std::vector<Eigen::Isometry3d>& wMr) {
  Json poses = Json::array();
  for (const auto& each : wMr) poses.push_back(pose_json(each));
  return text_of({{"timestamp", time_json(at)}, {"frame_id", kWorldFrame}, {"poses", poses}});
}

std::string odometry(Stamp at, const std::string& body, const Eigen::Isometry3d& wMr,
                     const Eigen::Matrix<double, 6, 6>& covariance) {
  return text_of({{"timestamp", time_json(at)},
                  {"frame_id", kWorldFrame},
                  {"body_frame_id", body},
                  {"pose", pose_json(wMr)},
                  {"pose_covariance", row_major(covariance)}});
}

std::string compressed_image(Stamp at, const std::string& frame, std::string_view jpeg) {
  return text_of({{"timestamp", time_json(at)},
                  {"frame_id", frame},
                  {"data", base64(jpeg)},
                  {"format", "jpeg"}});
}

std::string image_annotations(Stamp at, const imaging::Overlay& overlay) {
  constexpr int kPoints = 48;
  Json points = Json::array();
  Json texts = Json::array();
  const auto add_ellipse = [&](const std::optional<Ellipse>& ellipse, const Colour& colour) {
    if (ellipse && is_finite(*ellipse))
      points.push_back(
          annotation(at, Annotation::line_loop, outline_points(*ellipse, kPoints), colour, 1.5));
  };
  const auto add_points = [&](const std::vector<Eigen::Vector2d>& pixels, const Colour& colour) {
    if (!pixels.empty()) points.push_back(annotation(at, Annotation::points, pixels, colour, 4.0));
  };
  add_ellipse(overlay.predicted, palette::kOrange);
  add_ellipse(overlay.measured, palette::kSkyBlue);
  add_points(overlay.points, palette::kSkyBlue);
  if (overlay.principal_point) add_points({*overlay.principal_point}, palette::kWhite);
  for (const std::string& line : overlay.lines)
    texts.push_back(text_annotation(at, line, static_cast<double>(texts.size())));
  return text_of({{"circles", Json::array()}, {"points", points}, {"texts", texts}});
}

std::optional<std::string> camera_calibration(Stamp at, const std::string& frame,
                                              const CameraModel& model) {
  const auto* lens = std::get_if<Intrinsics>(&model);
  if (lens == nullptr) return std::nullopt;
  Eigen::Matrix<double, 3, 4> projection = Eigen::Matrix<double, 3, 4>::Identity();
  projection.topRows<2>() << lens->px, 0.0, lens->u0, 0.0, 0.0, lens->py, lens->v0, 0.0;
  const Eigen::Matrix3d in_image = projection.leftCols<3>();
  return text_of({{"timestamp", time_json(at)},
                  {"frame_id", frame},
                  {"width", lens->width},
                  {"height", lens->height},
                  {"distortion_model", "plumb_bob"},
                  {"D", plumb_bob(lens->kdu)},
                  {"K", row_major(in_image)},
                  {"R", row_major(Eigen::Matrix3d(Eigen::Matrix3d::Identity()))},
                  {"P", row_major(projection)}});
}

std::string log(Stamp at, LogLevel level, const std::string& name, const std::string& message) {
  return text_of({{"timestamp", time_json(at)},
                  {"level", static_cast<int>(level)},
                  {"message", message},
                  {"name", name},
                  {"file", ""},
                  {"line", 0}});
}

}  // namespace vigia::report::foxglove
