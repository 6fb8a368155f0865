#include "vigia/evaluation/field_study.hpp"

#include "work_queue.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/evaluation/metrics.hpp"
#include "vigia/localization/field_grid.hpp"
#include "vigia/localization/field_match.hpp"
#include "vigia/localization/field_posterior.hpp"
#include "vigia/localization/murea.hpp"

namespace vigia::evaluation {
namespace {

constexpr double kStart_m = 0.05;
constexpr double kStartTurn = 0.0192;
constexpr double kWrong_m = 0.5;

/// Every method on one field.
struct Methods {
  localization::FieldModel model;
  localization::FieldMatcher matcher;
  localization::FieldGrid grid;
  localization::Murea murea;
  localization::Murea murea_fine;

  static localization::MureaParams fine() {
    localization::MureaParams params;
    params.cell_m = 0.025;
    params.cell_deg = 0.625;
    return params;
  }
  explicit Methods(const FieldMap& map)
      : model(map), matcher(model), grid(map), murea(model), murea_fine(model, fine()) {}
};

FrameOutcome outcome(const FieldFrame& frame, const Pose2& pose) {
  FrameOutcome out;
  out.answered = true;
  out.error = difference(pose, frame.truth);
  return out;
}

FrameOutcome outcome(const FieldFrame& frame, const Pose2& pose,
                     const Eigen::Matrix3d& covariance) {
  FrameOutcome out = outcome(frame, pose);
  out.nees = out.error.dot(covariance.inverse() * out.error);
  return out;
}

FrameOutcome of_grid(const Methods& methods, const FieldFrame& frame,
                     localization::FieldGridMethod method) {
  const auto fix = methods.grid.locate(frame.scan, method);
  return fix.status == localization::FieldGridStatus::found ? outcome(frame, fix.pose)
                                                            : FrameOutcome{};
}

FrameOutcome of_murea(const localization::Murea& murea, const FieldFrame& frame) {
  const auto fix = murea.locate(frame.scan);
  return fix.found ? outcome(frame, fix.pose, fix.covariance) : FrameOutcome{};
}

FrameOutcome of_tracked(const Methods& methods, const FieldFrame& frame, RandomStream& random) {
  Pose2 start = frame.truth;
  start.x += kStart_m * random.normal();
  start.y += kStart_m * random.normal();
  start.theta = wrap_angle(start.theta + kStartTurn * random.normal());
  const auto fix = localization::refine_field_pose(methods.model, frame.scan.points, start);
  if (fix.status == localization::FieldFixStatus::degenerate) return {};
  const auto posterior = localization::posterior_about(methods.model, frame.scan.points,
                                                       methods.model.groups_of(frame.scan), fix);
  return outcome(frame, posterior.mean, posterior.covariance);
}

FrameOutcome of_cold(const Methods& methods, const FieldFrame& frame) {
  const auto suggestions = methods.matcher.match(frame.scan);
  if (suggestions.empty()) return {};
  const auto& best = suggestions.front();
  FrameOutcome out = outcome(frame, best.fix.pose, best.fix.covariance);
  out.weight = best.weight;
  return out;
}

FrameOutcome apply(FrameMethod method, const Methods& methods, const FieldFrame& frame,
                   RandomStream& random) {
  using localization::FieldGridMethod;
  switch (method) {
    case FrameMethod::printed:
      return of_grid(methods, frame, FieldGridMethod::printed);
    case FrameMethod::as_published:
      return of_grid(methods, frame, FieldGridMethod::as_published);
    case FrameMethod::corrected:
      return of_grid(methods, frame, FieldGridMethod::corrected);
    case FrameMethod::tracked:
      return of_tracked(methods, frame, random);
    case FrameMethod::cold:
      return of_cold(methods, frame);
    case FrameMethod::murea:
      return of_murea(methods.murea, frame);
    case FrameMethod::murea_fine:
      return of_murea(methods.murea_fine, frame);
  }
  return {};
}

}  // namespace

FrameStudy study_frames(const FieldMap& map, const FieldFrameParams& params,
                        const std::vector<FrameMethod>& methods, std::uint64_t seed, int count,
                        int threads) {
  const Methods made(map);
  const auto n = static_cast<std::size_t>(count);
  FrameStudy study;
  study.truths.resize(n);
  study.bounds.resize(n);
  for (const FrameMethod method : methods) study.outcomes[method].resize(n);
  work_off(n, threads, [&](std::size_t i) {
    RandomStream random(derive_seed(seed, i), "field frame");
    RandomStream starts(derive_seed(seed, i), "start");
    const Pose2 truth = random_field_pose(map, 0.3, random);
    const FieldFrame frame = draw_field_frame(map, params, truth, random);
    study.truths[i] = truth;
    study.bounds[i] = frame.bound;
    for (const FrameMethod method : methods)
      study.outcomes.at(method)[i] = apply(method, made, frame, starts);
  });
  return study;
}

FrameErrors frame_errors(const FrameStudy& study, FrameMethod method) {
  const std::vector<FrameOutcome>& outcomes = study.outcomes.at(method);
  FrameErrors errors;
  errors.frames = static_cast<int>(outcomes.size());
  std::vector<double> lengths;
  double squares = 0.0;
  double bounds = 0.0;
  double nees_sum = 0.0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const FrameOutcome& out = outcomes[i];
    if (!out.answered) continue;
    const double length = out.position_m();
    lengths.push_back(length);
    errors.mean_m += length;
    errors.rms_m += length * length;
    errors.heading_mean += std::abs(out.error.z());
    if (length > kWrong_m) {
      ++errors.wrong;
      continue;
    }
    squares += length * length;
    bounds += study.bounds[i].topLeftCorner<2, 2>().trace();
    nees_sum += out.nees / 3.0;
  }
  errors.answered = static_cast<int>(lengths.size());
  if (lengths.empty()) return errors;
  std::sort(lengths.begin(), lengths.end());
  const auto n = static_cast<double>(lengths.size());
  errors.mean_m /= n;
  errors.rms_m = std::sqrt(errors.rms_m / n);
  errors.heading_mean /= n;
  errors.p95_m = lengths[static_cast<std::size_t>(0.95 * (n - 1.0))];
  errors.max_m = lengths.back();
  const int right = errors.answered - errors.wrong;
  if (right > 0) {
    errors.bound_ratio = std::sqrt(squares / bounds);
    errors.nees = nees_sum / right;
  }
  return errors;
}

FrameBound frame_bound(const FrameStudy& study) {
  FrameBound bound;
  for (const Eigen::Matrix3d& P : study.bounds) {
    bound.mean_m += mean_length(P.topLeftCorner<2, 2>());
    bound.rms_m += P.topLeftCorner<2, 2>().trace();
    bound.heading_mean += std::sqrt(2.0 / kPi * P(2, 2));
  }
  const auto n = static_cast<double>(study.bounds.size());
  return {bound.mean_m / n, std::sqrt(bound.rms_m / n), bound.heading_mean / n};
}

std::vector<FlagCount> flag_curve(const FrameStudy& study, FrameMethod method,
                                  const std::vector<double>& thresholds) {
  std::vector<FlagCount> curve;
  for (const double threshold : thresholds) {
    FlagCount count{threshold, 0, 0};
    for (const FrameOutcome& out : study.outcomes.at(method)) {
      const bool right = out.answered && out.position_m() <= kWrong_m;
      const bool flagged = !out.answered || out.weight < threshold;
      if (right && flagged) ++count.right_flagged;
      if (!right && !flagged) ++count.wrong_unflagged;
    }
    curve.push_back(count);
  }
  return curve;
}

}  // namespace vigia::evaluation
