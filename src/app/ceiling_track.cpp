#include "ceiling_track.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "vigia/core/angle.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::app {

CeilingTrack::CeilingTrack(const tracking::PatchFinderParams& params) : finder_(params) {}

CeilingTrack::CeilingTrack(const perception::CeilingView& view, double rate_hz)
    : finder_(perception::finder_of(view)), rate_hz_(rate_hz), view_(view), follower_(view) {}

CeilingTrack::Row CeilingTrack::next(const imaging::Picture& picture, int number) {
  if (!follower_) return {finder_.find(*picture.frame), ""};
  const double time_s = picture.time_s.value_or(number / rate_hz_);
  auto step = follower_->next(imaging::grey_image(*picture.frame), Stamp::from_seconds(time_s));
  std::string pose = pose_fields(step);
  return {std::move(step.scan), std::move(pose)};
}

std::string CeilingTrack::pose_header() {
  return "status,x_m,y_m,heading_deg,sigma_x_m,sigma_y_m,sigma_heading_deg,corr_x_y,"
         "corr_x_heading,corr_y_heading,cell_probability,patches,flow";
}

std::string CeilingTrack::pose_fields(const perception::CeilingFollower::Step& step) const {
  const std::string counts =
      fmt::format("{},{}", step.scan.patches.size(), step.flow ? "yes" : "no");
  const auto belief = follower_->belief();
  if (!belief) return "lost,,,,,,,,,,," + counts;
  const Eigen::Matrix3d& P = belief->covariance;
  const Eigen::Vector3d sigma = P.diagonal().cwiseSqrt();
  const auto correlation = [&](int i, int j) { return P(i, j) / (sigma[i] * sigma[j]); };
  return fmt::format("{},{:.5f},{:.5f},{:.4f},{:.6f},{:.6f},{:.5f},{:.4f},{:.4f},{:.4f},{:.4f},{}",
                     to_string(belief->status), belief->pose.x, belief->pose.y,
                     to_deg(belief->pose.theta), sigma[0], sigma[1], to_deg(sigma[2]),
                     correlation(0, 1), correlation(0, 2), correlation(1, 2),
                     1.0 - belief->lost_probability, counts);
}

}  // namespace vigia::app
