#include "vigia/evaluation/ceiling_study.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"
#include "vigia/evaluation/metrics.hpp"
#include "vigia/localization/ceiling_published.hpp"

namespace vigia::evaluation {
namespace {

using localization::CeilingCamera;
using localization::CeilingFilter;
using localization::CeilingFilterParams;

constexpr double kMisread_m = 0.2;
constexpr double kCellPrior_m = 0.15;
constexpr double kCellPriorTurn = from_deg(5.0);

Prior about(const Pose2& pose) {
  return {pose, Eigen::Vector3d(kCellPrior_m * kCellPrior_m, kCellPrior_m * kCellPrior_m,
                                kCellPriorTurn * kCellPriorTurn)
                    .asDiagonal()};
}

double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// True placement errors of the cells that may be in view.
std::map<CeilingCell, Eigen::Vector3d> placement_about(const CeilingSetting& setting,
                                                       const Pose2& pose) {
  std::map<CeilingCell, Eigen::Vector3d> placement;
  const CeilingCell middle = nearest_cell(setting.ceiling.grid, pose.position());
  for (std::int64_t i = middle.i - 2; i <= middle.i + 2; ++i) {
    for (std::int64_t j = middle.j - 2; j <= middle.j + 2; ++j) {
      const auto patch = sim::true_patch(setting.ceiling, {i, j});
      if (!patch) continue;
      const Eigen::Vector2d off =
          patch->position() - cell_centre(setting.ceiling.grid, CeilingCell{i, j});
      placement[{i, j}] = {off.x(), off.y(), patch->theta};
    }
  }
  return placement;
}

void predict_motion(CeilingFilter& filter, const CeilingSetting& setting, const CeilingFrame& frame,
                    CeilingMotion motion, Stamp now) {
  if (motion == CeilingMotion::key_frame_flow && frame.flow)
    filter.predict(*frame.flow, now, frame.scan.patches);
  else if (motion == CeilingMotion::published_flow && frame.edges)
    filter.predict(image_shift(setting.known_camera(), *frame.edges), now, frame.scan.patches);
  else
    filter.predict_unknown(now);
}

CeilingEstimate estimate_of(const CeilingFrame& frame, const Belief& belief) {
  return {frame.truth, belief.pose, belief.covariance, std::nullopt, belief.status};
}

}  // namespace

CeilingErrorSummary summarise_errors(const std::vector<CeilingEstimate>& estimates) {
  CeilingErrorSummary summary;
  std::vector<double> positions;
  std::vector<double> headings;
  double trace = 0.0;
  const auto n = static_cast<double>(estimates.size());
  for (const CeilingEstimate& one : estimates) {
    const Eigen::Vector3d error = difference(one.estimate, one.truth);
    positions.push_back(error.head<2>().norm());
    headings.push_back(std::abs(error.z()));
    summary.mean_m += positions.back() / n;
    summary.rms_m += error.head<2>().squaredNorm() / n;
    summary.heading_mean += headings.back() / n;
    if (one.covariance) summary.nees += error.dot(one.covariance->ldlt().solve(error)) / (3.0 * n);
    if (!one.bound) continue;
    trace += one.bound->topLeftCorner<2, 2>().trace() / n;
    summary.bound_mean_m += mean_length(one.bound->topLeftCorner<2, 2>()) / n;
    summary.bound_heading += std::sqrt(2.0 / kPi * (*one.bound)(2, 2)) / n;
  }
  summary.frames = static_cast<int>(estimates.size());
  if (estimates.empty()) return summary;
  summary.rms_m = std::sqrt(summary.rms_m);
  summary.bound_m = std::sqrt(trace);
  summary.p95_m = quantile(positions, 0.95);
  summary.max_m = quantile(positions, 1.0);
  summary.heading_p95 = quantile(headings, 0.95);
  summary.heading_max = quantile(headings, 1.0);
  return summary;
}

std::vector<CeilingFrame> with_bursts(const CeilingSetting& setting,
                                      std::vector<CeilingFrame> frames, CeilingFault fault,
                                      const std::vector<CeilingBurst>& bursts, std::uint64_t seed) {
  RandomStream random(seed, "bursts");
  const double px_per_m = setting.camera.px / setting.known_camera().rise_m();
  for (const CeilingBurst& burst : bursts) {
    for (int i = burst.first; i < burst.first + burst.frames; ++i) {
      std::vector<PatchImage>& patches = frames.at(static_cast<std::size_t>(i)).scan.patches;
      if (fault == CeilingFault::unseen) {
        patches.clear();
        continue;
      }
      const double off = kMisread_m * px_per_m * random.uniform(0.0, 1.0);
      const Eigen::Vector2d shift = off * unit_vector(random.uniform(-kPi, kPi));
      for (PatchImage& patch : patches) patch.uv += shift;
    }
  }
  return frames;
}

std::vector<CeilingEstimate> follow_published(const CeilingSetting& setting,
                                              const CeilingCamera& camera,
                                              const std::vector<CeilingFrame>& frames,
                                              std::optional<double> threshold_m) {
  localization::CeilingPublished published(camera, setting.ceiling.grid, threshold_m);
  published.reset(frames.front().truth);
  std::vector<CeilingEstimate> estimates;
  for (const CeilingFrame& frame : frames) {
    std::optional<Pose2> flow;
    if (frame.edges) flow = published_motion(camera, *frame.edges);
    published.update(frame.scan.patches, flow);
    estimates.push_back({frame.truth, published.pose(), {}, {}, BeliefStatus::tracking});
  }
  return estimates;
}

std::vector<CeilingEstimate> fix_jointly(const CeilingSetting& setting,
                                         const CeilingFilterParams& params,
                                         const std::vector<CeilingFrame>& frames) {
  std::vector<CeilingEstimate> estimates;
  RandomStream random(setting.seed, "cell prior");
  for (const CeilingFrame& frame : frames) {
    CeilingFilter filter(setting.known_camera(), setting.ceiling.grid, params);
    Prior prior = about(frame.truth);
    prior.pose.x += 0.3 * kCellPrior_m * random.normal();
    prior.pose.y += 0.3 * kCellPrior_m * random.normal();
    prior.pose.theta += 0.3 * kCellPriorTurn * random.normal();
    filter.reset({}, prior);
    filter.update(frame.scan.patches);
    CeilingEstimate estimate = estimate_of(frame, filter.belief());
    filter.reset({}, about(frame.truth));
    filter.inform({frame.truth, setting.true_errors(), {}}, frame.scan.patches);
    estimate.bound = filter.belief().covariance;
    estimates.push_back(estimate);
  }
  return estimates;
}

std::vector<CeilingEstimate> follow_jointly(const CeilingSetting& setting,
                                            const CeilingFilterParams& params,
                                            const std::vector<CeilingFrame>& frames,
                                            CeilingMotion motion, double period_s) {
  CeilingFilter filter(setting.known_camera(), setting.ceiling.grid, params);
  CeilingFilter bound(setting.known_camera(), setting.ceiling.grid, params);
  RandomStream random(setting.seed, "start");
  Prior prior;
  prior.pose = frames.front().truth;
  prior.covariance = Eigen::Vector3d(4e-4, 4e-4, 4e-4).asDiagonal();
  bound.reset({}, prior);
  prior.pose.x += 0.02 * random.normal();
  prior.pose.y += 0.02 * random.normal();
  prior.pose.theta += 0.02 * random.normal();
  filter.reset({}, prior);
  std::vector<CeilingEstimate> estimates;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CeilingFrame& frame = frames[i];
    const Stamp now = Stamp::from_seconds(static_cast<double>(i) * period_s);
    if (i > 0) {
      predict_motion(filter, setting, frame, motion, now);
      predict_motion(bound, setting, frame, motion, now);
    }
    filter.update(frame.scan.patches);
    bound.inform({frame.truth, setting.true_errors(), placement_about(setting, frame.truth)},
                 frame.scan.patches);
    estimates.push_back(estimate_of(frame, filter.belief()));
    estimates.back().bound = bound.belief().covariance;
  }
  return estimates;
}

CeilingCalibration calibrate_ceiling(const CeilingSetting& setting,
                                     const std::vector<CeilingFrame>& frames, double period_s) {
  CeilingFilterParams params;
  params.tilt_sigma = from_deg(2.0);
  params.height_sigma = 0.04;
  CeilingFilter filter(setting.known_camera(), setting.ceiling.grid, params);
  filter.reset({}, about(frames.front().truth));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i > 0) filter.predict_unknown(Stamp::from_seconds(static_cast<double>(i) * period_s));
    filter.update(frames[i].scan.patches);
  }
  return {filter.camera_errors(), filter.camera_errors_covariance()};
}

std::vector<CeilingEstimate> follow_flow(const CeilingSetting& setting,
                                         const std::vector<CeilingFrame>& frames,
                                         CeilingMotion motion) {
  const CeilingCamera camera = corrected(setting.known_camera(), setting.true_errors());
  Pose2 pose = frames.front().truth;
  std::vector<CeilingEstimate> estimates;
  for (const CeilingFrame& frame : frames) {
    if (motion == CeilingMotion::key_frame_flow && frame.flow)
      pose = compose(pose, localization::robot_motion(camera, *frame.flow));
    if (motion == CeilingMotion::published_flow && frame.edges)
      pose = compose(pose, published_motion(camera, *frame.edges));
    estimates.push_back({frame.truth, pose, {}, {}, BeliefStatus::tracking});
  }
  return estimates;
}

}  // namespace vigia::evaluation
