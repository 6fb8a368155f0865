#include "vigia/evaluation/corner_trials.hpp"

#include "work_queue.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::evaluation {
namespace {

using localization::PublishedFixStatus;
using localization::RunningFixStatus;
using localization::StationChain;
using localization::StationFix;
using localization::StationFixStatus;

constexpr double kRoughSigma_m = 0.2;
constexpr double kRoughSigma_rad = 0.3490658503988659;  // 20°

std::optional<localization::StereoPoint> triangulated(const StationChain& chain, std::size_t i) {
  return triangulate(chain.pair, chain.sightings[i].columns, chain.sightings[i].sigma_px);
}

/// Eqs. 4–8; in this field's axes the blue goal's corners have the x = 0 that eq. 8 takes.
void locate_as_published(const CornerRun& run, CornerTrial& trial) {
  const auto first = triangulated(run.measured, 0);
  const auto second = triangulated(run.measured, 1);
  if (!first || !second) return;
  const std::size_t corner = run.measured.sightings[1].landmark;
  const Eigen::Vector2d& landmark = run.measured.landmarks[corner].p_w;
  const auto fix = localization::published_running_fix(
      landmark, first->p_r.norm(), second->p_r.norm(), run.measured.motions[0].displacement_m);
  trial.published_status = fix.status;
  if (fix.status != PublishedFixStatus::found) return;
  const Eigen::Vector2d truth = run.truths[1].position();
  const auto& p = *std::min_element(fix.positions.begin(), fix.positions.end(),
                                    [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                                      return (a - truth).norm() < (b - truth).norm();
                                    });
  const bool blue = corner < 2;
  const double heading = blue ? localization::published_heading_blue(landmark, p, second->p_r)
                              : localization::published_heading_yellow(landmark, p, second->p_r);
  trial.published = difference({p.x(), p.y(), heading}, run.truths[1]);
}

void resolve_by_prior(const CornerRun& run, CornerTrial& trial, RandomStream& random) {
  const Eigen::Vector3d sigma(kRoughSigma_m, kRoughSigma_m, kRoughSigma_rad);
  const Eigen::Vector3d white(random.normal(), random.normal(), random.normal());
  const Pose2& truth = run.truths[1];
  const Prior rough{Pose2::from_vector(truth.vector() + sigma.cwiseProduct(white)),
                    sigma.cwiseAbs2().asDiagonal()};
  const auto first = triangulated(run.measured, 0);
  const auto second = triangulated(run.measured, 1);
  if (!first || !second) return;
  const auto& landmark = run.measured.landmarks[run.measured.sightings[1].landmark];
  const auto fix = localization::running_fix(
      {landmark, polar(*first), polar(*second), run.measured.motions[0], {}}, rough);
  trial.resolved_status = fix.status;
  const auto off = [&](std::size_t i) {
    return (fix.candidates[i].pose.position() - truth.position()).norm();
  };
  trial.resolved_wrongly = fix.status == RunningFixStatus::found && off(0) > off(1);
}

void locate_likeliest(const CornerRun& run, CornerTrial& trial) {
  const Eigen::Vector2d& landmark = run.exact.landmarks[run.exact.sightings[1].landmark].p_w;
  const Pose2& truth = run.truths[1];
  const StationFix fix = localization::station_fix(run.measured);
  trial.likeliest_status = fix.status;
  if (!fix.hypotheses.empty()) {
    const PoseHypothesis& best = fix.hypotheses.front();
    trial.likeliest = difference(best.pose, truth);
    trial.likeliest_covariance = best.covariance;
    trial.likeliest_range_error_m =
        (run.measured.landmarks[run.measured.sightings[1].landmark].p_w - best.pose.position())
            .norm() -
        (landmark - truth.position()).norm();
  }
  trial.bound = localization::station_bound(run.exact, truth);
  if (!trial.bound) return;
  const Eigen::Vector2d u = (landmark - truth.position()).normalized();
  trial.range_bound_m = std::sqrt(u.dot(trial.bound->topLeftCorner<2, 2>() * u));
}

CornerTrial judge_trial(const CornerSetting& setting, RandomStream& random) {
  const CornerRun run = draw_corner_run(setting, 2, true, random);
  CornerTrial trial;
  std::vector<Eigen::Vector2d> sights;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t corner = run.exact.sightings[i].landmark;
    sights.emplace_back(run.exact.landmarks[corner].p_w - run.truths[i].position());
    const auto seen = triangulated(run.measured, i);
    if (!seen) continue;
    trial.ranges_m.push_back(sights.back().norm());
    trial.range_errors_m.push_back(seen->p_r.norm() - sights.back().norm());
  }
  trial.sin_gamma = std::abs(cross(sights[0].normalized(), sights[1].normalized()));
  locate_as_published(run, trial);
  resolve_by_prior(run, trial, random);
  locate_likeliest(run, trial);
  return trial;
}

CornerDrive judge_drive(const CornerSetting& setting, int points, RandomStream& random) {
  CornerRun run = draw_corner_run(setting, points, points == 2, random);
  const Pose2& truth = run.truths.back();
  CornerDrive drive;
  const StationFix blind = localization::station_fix(run.measured);
  if (!blind.hypotheses.empty())
    drive.uncorrected = difference(blind.hypotheses.front().pose, truth);
  run.measured.calibration_sigma = run.exact.calibration_sigma = setting.calibration_sigma;
  const StationFix aware = localization::station_fix(run.measured);
  drive.bound = localization::station_bound(run.exact, truth, run.errors);
  if (aware.hypotheses.empty()) return drive;
  const PoseHypothesis& best = aware.hypotheses.front();
  drive.status = aware.status;
  drive.corrected = difference(best.pose, truth);
  drive.nees = drive.corrected->dot(best.covariance.inverse() * *drive.corrected);
  return drive;
}

/// Runs @p judge for each number on a stream of its own.
template <typename Result, typename Judge>
std::vector<Result> run_numbers(std::uint64_t seed, int count, int threads, const Judge& judge) {
  std::vector<Result> results(static_cast<std::size_t>(count));
  work_off(results.size(), threads, [&](std::size_t i) {
    RandomStream random(derive_seed(seed, static_cast<std::uint64_t>(i)), "goal corners");
    results[i] = judge(random);
  });
  return results;
}

/// Sums over poses and bounds.
class RatioSums {
 public:
  void add(const PoseError& error, double nees, const Eigen::Matrix3d& bound) {
    const double off = error.head<2>().norm();
    sum_.mean_m += off;
    sum_.greatest_m = std::max(sum_.greatest_m, off);
    sum_.bound_mean_m += mean_length(bound.topLeftCorner<2, 2>());
    sum_.nees += nees / 3.0;
    squares_.push_back(off * off);
    bounds_.push_back(bound.topLeftCorner<2, 2>().trace());
  }
  BoundRatio ratio() const {
    BoundRatio mean = sum_;
    mean.n = static_cast<int>(squares_.size());
    if (mean.n == 0) return mean;
    mean.mean_m /= mean.n;
    mean.bound_mean_m /= mean.n;
    mean.nees /= mean.n;
    mean.ratio = pcrlb_ratio(squares_, bounds_, 1);
    return mean;
  }

 private:
  BoundRatio sum_;
  std::vector<double> squares_;
  std::vector<double> bounds_;
};

}  // namespace

std::vector<CornerTrial> study_corner_trials(const CornerSetting& setting, std::uint64_t seed,
                                             int count, int threads) {
  return run_numbers<CornerTrial>(
      seed, count, threads, [&](RandomStream& random) { return judge_trial(setting, random); });
}

std::vector<CornerDrive> study_corner_drives(const CornerSetting& setting, int points,
                                             std::uint64_t seed, int count, int threads) {
  return run_numbers<CornerDrive>(seed, count, threads, [&](RandomStream& random) {
    return judge_drive(setting, points, random);
  });
}

ErrorSpread spread_of(const std::vector<double>& errors) {
  ErrorSpread spread;
  spread.n = static_cast<int>(errors.size());
  if (errors.empty()) return spread;
  double square = 0.0;
  spread.least = INFINITY;
  for (const double e : errors) {
    spread.mean += std::abs(e) / spread.n;
    square += e * e / spread.n;
    spread.least = std::min(spread.least, std::abs(e));
    spread.greatest = std::max(spread.greatest, std::abs(e));
  }
  spread.deviation = std::sqrt(std::max(0.0, square - spread.mean * spread.mean));
  return spread;
}

BoundRatio likeliest_ratio(const std::vector<CornerTrial>& trials, bool all) {
  RatioSums sums;
  for (const CornerTrial& trial : trials) {
    if (!trial.likeliest || !trial.bound) continue;
    if (!all && trial.likeliest_status != StationFixStatus::found) continue;
    const double nees =
        trial.likeliest->dot(trial.likeliest_covariance.inverse() * *trial.likeliest);
    sums.add(*trial.likeliest, nees, *trial.bound);
  }
  return sums.ratio();
}

BoundRatio drive_ratio(const std::vector<CornerDrive>& drives) {
  RatioSums sums;
  for (const CornerDrive& drive : drives)
    if (drive.status == StationFixStatus::found && drive.bound)
      sums.add(*drive.corrected, drive.nees, *drive.bound);
  return sums.ratio();
}

}  // namespace vigia::evaluation
