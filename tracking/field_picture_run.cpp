#include "vigia/tracking/field_picture_run.hpp"

#include "csv_text.hpp"
#include "overlay_pen.hpp"

#include <string_view>
#include <utility>

#include "vigia/core/angle.hpp"
#include "vigia/tracking/colour_clusters.hpp"
#include "vigia/tracking/field_palette.hpp"
#include "vigia/tracking/mirror_finder.hpp"

namespace vigia::tracking {
namespace {

/// One line of the table of what rays meet.
std::string ray_line_text(const std::string& start, std::string_view kind, std::string_view colour,
                          const RadialScan& scan, int ray, double radius_px, double sigma_px) {
  const Eigen::Vector2d uv = scan.pixel(ray, radius_px);
  return start + "found," + std::string(kind) + ',' + std::string(colour) + ',' +
         std::to_string(ray) + ',' + csv_number(to_deg(scan.angle(ray)), 2) + ',' +
         csv_number(uv.x(), 3) + ',' + csv_number(uv.y(), 3) + ',' + csv_number(sigma_px, 4);
}

std::string span_lines(const std::string& start, std::string_view kind, const RadialScan& scan,
                       const std::vector<ColourSpan>& spans) {
  std::string lines;
  for (const ColourSpan& span : spans)
    for (const ColourFoot& foot : span.feet)
      lines += ray_line_text(start, kind, to_string(span.colour), scan, foot.ray, foot.foot_px,
                             foot.sigma_px) +
               ",,,\n";
  return lines;
}

}  // namespace

FieldPicture scan_field_picture(const imaging::Frame& picture, const FieldPictureParams& params) {
  FieldPicture found;
  const auto mirror = params.mirror ? params.mirror : find_mirror(picture, FieldPalette{});
  if (!mirror) return found;
  found.mirror = *mirror;
  const FieldPalette palette(cluster_field_colours(picture, *mirror));
  if (!params.mirror) found.mirror.inner_px = robot_radius(picture, *mirror, palette);
  RadialScan scan = RadialScanner(found.mirror, palette, params.scan).scan(picture);
  if (scan.light != LightStatus::in_range) {
    found.status = FeatureStatus::low_contrast;
    return found;
  }
  found.scan = std::move(scan);
  found.status = features_in(found) > 0 ? FeatureStatus::found : FeatureStatus::not_found;
  return found;
}

std::string field_csv_header() {
  return "status,kind,colour,ray,angle_deg,u,v,sigma_px,inner_px,outer_px,contrast";
}

std::string field_csv_lines(const FieldPicture& picture, const std::string& start) {
  std::string lines = start + std::string(to_string(picture.status)) + ",mirror,,,";
  if (picture.mirror.outer_px > 0.0)
    lines += ',' + csv_number(picture.mirror.centre.x(), 3) + ',' +
             csv_number(picture.mirror.centre.y(), 3) + ",," +
             csv_number(picture.mirror.inner_px, 3) + ',' + csv_number(picture.mirror.outer_px, 3) +
             ",\n";
  else
    lines += ",,,,,,\n";
  const RadialScan& scan = picture.scan;
  for (const LinePoint& point : scan.points)
    lines +=
        ray_line_text(start, "line", "white", scan, point.ray, point.centre_px(), point.sigma_px) +
        ',' + csv_number(point.inner_px, 3) + ',' + csv_number(point.outer_px, 3) + ',' +
        csv_number(point.contrast, 3) + '\n';
  return lines + span_lines(start, "goal", scan, scan.goals) +
         span_lines(start, "post", scan, scan.posts);
}

int features_in(const FieldPicture& picture) {
  return static_cast<int>(picture.scan.points.size() + picture.scan.goals.size() +
                          picture.scan.posts.size());
}

void draw_overlay(const FieldPicture& found, vpImage<vpRGBa>& picture) {
  constexpr double kArm = 4.0;  // px
  const MirrorImage& mirror = found.mirror;
  const RadialScan& scan = found.scan;
  if (mirror.outer_px <= 0.0) return;
  draw_twice(picture, [&](const OverlayPen& pen) {
    for (const double radius : {mirror.inner_px, mirror.outer_px})
      pen.ellipse({mirror.centre.x(), mirror.centre.y(), radius, radius, 0.0});
    for (const LinePoint& point : scan.points)
      pen.cross(scan.pixel(point.ray, point.centre_px()), kArm);
    for (const auto* spans : {&scan.goals, &scan.posts})
      for (const ColourSpan& span : *spans)
        for (const ColourFoot& foot : span.feet)
          pen.line(scan.pixel(foot.ray, foot.foot_px - kArm),
                   scan.pixel(foot.ray, mirror.outer_px));
  });
}

}  // namespace vigia::tracking
