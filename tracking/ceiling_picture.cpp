#include "vigia/tracking/ceiling_picture.hpp"

#include "csv_text.hpp"
#include "overlay_pen.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/tracking/feature_status.hpp"

namespace vigia::tracking {
namespace {

std::string patch_fields(const PatchImage& patch) {
  const Eigen::Vector3d sigma = patch.covariance.diagonal().cwiseSqrt();
  const auto correlation = [&](int i, int j) {
    return csv_number(patch.covariance(i, j) / (sigma[i] * sigma[j]), 3);
  };
  return csv_number(patch.uv.x(), 3) + ',' + csv_number(patch.uv.y(), 3) + ',' +
         csv_number(to_deg(patch.angle), 3) + ',' + csv_number(sigma[0], 4) + ',' +
         csv_number(sigma[1], 4) + ',' + csv_number(to_deg(sigma[2]), 4) + ',' + correlation(0, 1) +
         ',' + correlation(0, 2) + ',' + correlation(1, 2) + ',' +
         csv_number(patch.forward_log_odds, 1) + ',' + (patch.cut ? "yes" : "no");
}

}  // namespace

std::string ceiling_csv_header() {
  return "status,u,v,angle_deg,sigma_u,sigma_v,sigma_angle_deg,corr_u_v,corr_u_angle,"
         "corr_v_angle,forward_log_odds,cut";
}

std::string ceiling_csv_lines(const PatchScan& scan, const std::string& start) {
  if (scan.patches.empty())
    return start + std::string(to_string(FeatureStatus::not_found)) + ",,,,,,,,,,,\n";
  std::string lines;
  for (const PatchImage& patch : scan.patches)
    lines +=
        start + std::string(to_string(FeatureStatus::found)) + ',' + patch_fields(patch) + '\n';
  return lines;
}

void draw_overlay(const PatchScan& scan, vpImage<vpRGBa>& picture) {
  constexpr double kArm = 4.0;       // px
  constexpr double kAxis = 10.0;     // px, of a direction whose forward end is not known
  constexpr double kArrow = 24.0;    // px, of one that is sure
  constexpr double kSureOdds = 5.0;  // log-odds
  draw_twice(picture, [&](const OverlayPen& pen) {
    for (const PatchImage& patch : scan.patches) {
      const double sure = std::min(1.0, std::abs(patch.forward_log_odds) / kSureOdds);
      const Eigen::Vector2d forward = unit_vector(patch.angle);
      pen.cross(patch.uv, kArm);
      pen.line(patch.uv - kAxis * (1.0 - sure) * forward,
               patch.uv + (kAxis + (kArrow - kAxis) * sure) * forward);
    }
  });
}

}  // namespace vigia::tracking
