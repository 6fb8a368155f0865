#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/feature_status.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia::tracking {

struct FieldPictureParams {
  std::optional<MirrorImage> mirror;  ///< nothing: looked for in every picture
  RadialScanParams scan;
};

/// What one picture of a mirror camera shows. Without a mirror (not_found) or with a light in which
/// its field cannot be told (low_contrast) the scan is empty.
struct FieldPicture {
  FeatureStatus status = FeatureStatus::not_found;
  MirrorImage mirror;
  RadialScan scan;
};

/// Scans pictures of a mirror camera that is not calibrated: finds the mirror, then the colours of
/// its field without any mark, then what the rays meet.
FieldPicture scan_field_picture(const imaging::Frame& picture, const FieldPictureParams& params);

/// The columns of what a ray meets and their names, and the lines of a picture, each after @p
/// start: its mirror, points on lines, the feet of goals and of posts.
std::string field_csv_header();
std::string field_csv_lines(const FieldPicture& picture, const std::string& start);

/// Points on lines, and goals and posts with a foot on a ray.
int features_in(const FieldPicture& picture);

/// Draws the mirror's circles, crosses at points on lines, and lines from foot to foot of goals and
/// posts.
void draw_overlay(const FieldPicture& found, vpImage<vpRGBa>& picture);

}  // namespace vigia::tracking
