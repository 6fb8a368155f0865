#include "mirror_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "vigia/core/error.hpp"
#include "vigia/imaging/picture_source.hpp"
#include "vigia/tracking/colour_clusters.hpp"
#include "vigia/tracking/mirror_finder.hpp"

namespace vigia::app {
namespace {

MirrorView view_of(const imaging::Picture& picture,
                   const std::optional<tracking::MirrorImage>& given) {
  imaging::ImageFrame frame(imaging::colour_image(*picture.frame));
  const auto mirror = given ? given : tracking::find_mirror(frame, tracking::FieldPalette{});
  if (!mirror)
    throw InputError(
        picture.name +
        ": no mirror with a field is found; --mirror U,V,INNER,OUTER says where it is");
  const tracking::FieldPalette palette(tracking::cluster_field_colours(frame, *mirror));
  MirrorView view{picture.name, std::move(frame), *mirror, palette};
  if (!given) view.mirror.inner_px = tracking::robot_radius(view.frame, *mirror, palette);
  return view;
}

cv::Point in_sixteenths(const Eigen::Vector2d& uv) {
  return {static_cast<int>(std::lround(16.0 * uv.x())),
          static_cast<int>(std::lround(16.0 * uv.y()))};
}

void draw_piece(cv::Mat& canvas, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                const cv::Scalar& colour) {
  constexpr int kSixteenths = 4;
  cv::line(canvas, in_sixteenths(from), in_sixteenths(to), colour, 1, cv::LINE_AA, kSixteenths);
}

/// One edge of a line, @p aside of its middle.
void draw_edge(cv::Mat& canvas, const FieldLine& line, double aside, const CameraModel& model,
               const Eigen::Isometry3d& cMw) {
  constexpr int kPieces = 160;
  const cv::Scalar magenta(255, 0, 255, 255);
  std::optional<Eigen::Vector2d> before;
  for (int k = 0; k <= kPieces; ++k) {
    const Eigen::Vector2d on = line.at(line.length_m() * k / kPieces);
    const Eigen::Vector2d p = on + aside * line_offset(line, on).normal;
    const auto uv = project(model, cMw * Eigen::Vector3d(p.x(), p.y(), 0.0));
    if (uv && before && in_image(model, *uv) && in_image(model, *before))
      draw_piece(canvas, *before, *uv, magenta);
    before = uv;
  }
}

}  // namespace

std::vector<MirrorView> read_mirror_views(const std::vector<std::string>& inputs,
                                          const std::optional<tracking::MirrorImage>& mirror) {
  std::vector<MirrorView> views;
  for (const std::string& input : inputs) {
    const auto source = imaging::open_pictures(input);
    while (const auto picture = source->next()) {
      views.push_back(view_of(*picture, mirror));
      const auto& first = views.front().frame;
      const auto& frame = views.back().frame;
      if (frame.width() != first.width() || frame.height() != first.height())
        throw InputError(fmt::format("{}: {}×{} pixels, but the pictures before have {}×{}",
                                     picture->name, frame.width(), frame.height(), first.width(),
                                     first.height()));
    }
  }
  return views;
}

std::vector<localization::MirrorPoint> line_points(const MirrorView& view, double ray_step,
                                                   const localization::MirrorMount* floor,
                                                   double width_m) {
  tracking::RadialScanParams params;
  params.ray_step = ray_step;
  params.line_width_m = width_m;
  auto scanner = floor == nullptr
                     ? tracking::RadialScanner(view.mirror, view.palette, params)
                     : tracking::RadialScanner(
                           tracking::FloorView{floor->mirror, floor->rMc, view.mirror.inner_px},
                           view.palette, params);
  const tracking::RadialScan scan = scanner.scan(view.frame);
  std::vector<localization::MirrorPoint> points;
  for (const tracking::LinePoint& point : scan.points)
    points.push_back({scan.pixel(point.ray, point.inner_px), scan.pixel(point.ray, point.outer_px),
                      point.sigma_px});
  return points;
}

vpImage<vpRGBa> mirror_overlay(const MirrorView& view, const FieldMap& field,
                               const localization::MirrorMount& mount, const Pose2& pose,
                               const std::vector<localization::MirrorPoint>& points,
                               const std::vector<bool>& on) {
  constexpr double kArm = 3.0;  // px
  const cv::Scalar orange(255, 160, 0, 255);
  vpImage<vpRGBa> picture = imaging::colour_image(view.frame);
  cv::Mat canvas(static_cast<int>(picture.getHeight()), static_cast<int>(picture.getWidth()),
                 CV_8UC4, picture.bitmap);
  const Eigen::Isometry3d cMw = (to_isometry(pose) * mount.rMc).inverse();
  for (const FieldLine& line : field.lines)
    for (const double side : {-0.5, 0.5})
      draw_edge(canvas, line, side * line.width_m, mount.mirror, cMw);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!on[i]) continue;
    const Eigen::Vector2d at = 0.5 * (points[i].inner_uv + points[i].outer_uv);
    for (const Eigen::Vector2d& arm : {Eigen::Vector2d(kArm, 0.0), Eigen::Vector2d(0.0, kArm)})
      draw_piece(canvas, at - arm, at + arm, orange);
  }
  return picture;
}

}  // namespace vigia::app
