#include "vigia/evaluation/field_drive.hpp"

#include "work_queue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/localization/field_tracker.hpp"
#include "vigia/localization/mcl.hpp"
#include "vigia/localization/murea.hpp"
#include "vigia/localization/odometry_localizer.hpp"

namespace vigia::evaluation {
namespace {

constexpr double kPriorSigma_m = 0.1;
constexpr double kPriorTurn = 0.0524;

/// A localizer that takes part.
struct Rider {
  std::function<void(Stamp, const std::optional<Prior>&)> reset;
  std::function<void(const OdometryIncrement&)> predict;
  std::function<void(const FieldScan&)> update;
  std::function<const Belief&()> belief;
};

template <typename Localizer>
Rider rider_of(std::shared_ptr<Localizer> localizer) {
  return {[localizer](Stamp stamp, const std::optional<Prior>& prior) {
            localizer->reset(stamp, prior);
          },
          [localizer](const OdometryIncrement& u) { localizer->predict(u); },
          [localizer](const FieldScan& scan) { localizer->update(scan); },
          [localizer]() -> const Belief& { return localizer->belief(); }};
}

Rider odometry_rider(const OdometryNoise& noise) {
  auto localizer = std::make_shared<localization::OdometryLocalizer>(noise);
  return {[localizer](Stamp stamp, const std::optional<Prior>& prior) {
            localizer->reset(stamp, prior);
          },
          [localizer](const OdometryIncrement& u) { localizer->predict(u); },
          [](const FieldScan&) {}, [localizer]() -> const Belief& { return localizer->belief(); }};
}

Rider make_rider(FieldLocalizer localizer, const localization::FieldModel& model,
                 const OdometryNoise& noise, std::uint64_t seed) {
  switch (localizer) {
    case FieldLocalizer::odometry:
      break;
    case FieldLocalizer::field_grid: {
      localization::FieldTrackerParams params;
      params.odometry = noise;
      return rider_of(std::make_shared<localization::FieldTracker>(model, params));
    }
    case FieldLocalizer::mcl:
    case FieldLocalizer::mcl_described: {
      localization::MclParams params;
      params.odometry = noise;
      if (localizer == FieldLocalizer::mcl_described)
        params.method = localization::MclParams::Method::as_described;
      return rider_of(std::make_shared<localization::Mcl>(model, params, seed));
    }
    case FieldLocalizer::murea: {
      localization::MureaLocalizerParams params;
      params.odometry = noise;
      return rider_of(std::make_shared<localization::MureaLocalizer>(model, params));
    }
  }
  return odometry_rider(noise);
}

/// Whether goals take part in its pose and not only in which of several poses it is.
bool measures_by_goals(FieldLocalizer localizer) {
  return localizer != FieldLocalizer::field_grid;
}

/// The true robot: it makes for one way point after another.
class Driver {
 public:
  Driver(const FieldMap& map, const FieldDriveParams& params, std::uint64_t seed)
      : map_(&map), params_(&params), random_(seed, "field drive") {
    truth_ = random_field_pose(map, 1.0, random_);
    goal_ = random_field_pose(map, 1.0, random_).position();
  }

  const Pose2& truth() const { return truth_; }

  Prior prior() {
    Prior prior;
    prior.covariance = Eigen::Vector3d(kPriorSigma_m * kPriorSigma_m, kPriorSigma_m * kPriorSigma_m,
                                       kPriorTurn * kPriorTurn)
                           .asDiagonal();
    prior.pose = truth_;
    prior.pose.x += kPriorSigma_m * random_.normal();
    prior.pose.y += kPriorSigma_m * random_.normal();
    prior.pose.theta = wrap_angle(prior.pose.theta + kPriorTurn * random_.normal());
    return prior;
  }

  /// Drives on and returns what the wheels say of it; @p true_motion is what was driven.
  OdometryIncrement drive(Stamp from, Stamp to, OdometryIncrement& true_motion) {
    while ((goal_ - truth_.position()).norm() < 0.5)
      goal_ = random_field_pose(*map_, 1.0, random_).position();
    const Eigen::Vector2d to_goal = goal_ - truth_.position();
    const double off = wrap_angle(std::atan2(to_goal.y(), to_goal.x()) - truth_.theta);
    const double most = params_->turn_rad_s * params_->period_s;
    const double turn = std::clamp(0.2 * off, -most, most);
    const double speed = params_->speed_m_s * std::max(0.2, std::cos(0.5 * off));
    OdometryIncrement u{from, to, 0.5 * turn, speed * params_->period_s, 0.5 * turn};
    const Eigen::Vector3d sigma = control_covariance(u, params_->odometry).diagonal().cwiseSqrt();
    true_motion = u;
    true_motion.rot1 += sigma.x() * random_.normal();
    true_motion.trans += sigma.y() * random_.normal();
    true_motion.rot2 += sigma.z() * random_.normal();
    truth_ = move(truth_, true_motion);
    return u;
  }

  void kidnap() {
    const Pose2 before = truth_;
    while ((truth_.position() - before.position()).norm() < 0.5)
      truth_ = random_field_pose(*map_, 0.5, random_);
  }

 private:
  const FieldMap* map_;
  const FieldDriveParams* params_;
  RandomStream random_;
  Pose2 truth_;
  Eigen::Vector2d goal_;
};

Eigen::Matrix3d predicted_bound(const Eigen::Matrix3d& bound, const Pose2& truth,
                                const OdometryIncrement& u, const OdometryNoise& noise) {
  const Eigen::Matrix3d F = move_jacobian_pose(truth, u);
  const Eigen::Matrix3d G = move_jacobian_control(truth, u);
  return F * bound * F.transpose() + G * control_covariance(u, noise) * G.transpose();
}

}  // namespace

FieldDrive drive_field(const FieldMap& map, const FieldDriveParams& params,
                       const std::vector<FieldLocalizer>& localizers, std::uint64_t seed) {
  const localization::FieldModel model(map);
  RandomStream random(seed, "field frames");
  Driver driver(map, params, seed);
  const Prior prior = driver.prior();
  std::vector<Rider> riders;
  for (const FieldLocalizer localizer : localizers) {
    riders.push_back(make_rider(localizer, model, params.odometry, seed));
    riders.back().reset(Stamp{}, params.prior ? std::optional<Prior>(prior) : std::nullopt);
  }
  RandomStream teleports(seed, "teleports");
  std::vector<FalseLine> false_lines;
  if (params.lasting_false_lines)
    false_lines = random_false_lines(map, params.frames.false_lines, random);
  const Eigen::Vector3d no_prior(map.length_m * map.length_m / 12.0,
                                 map.width_m * map.width_m / 12.0, kPi * kPi / 3.0);
  // By the points alone, and with the goals.
  std::array<Eigen::Matrix3d, 2> bounds;
  bounds.fill(params.prior ? prior.covariance : Eigen::Matrix3d(no_prior.asDiagonal()));
  FieldDrive drive;
  for (int k = 0; k < params.count; ++k) {
    const Pose2 before = driver.truth();
    OdometryIncrement truly;
    const OdometryIncrement u = driver.drive(Stamp::from_seconds(k * params.period_s),
                                             Stamp::from_seconds((k + 1) * params.period_s), truly);
    for (Eigen::Matrix3d& bound : bounds)
      bound = predicted_bound(bound, before, truly, params.odometry);
    const bool teleported = teleports.uniform(0.0, 1.0) < params.teleports_per_m * truly.trans;
    if (teleported || (params.kidnap_at && *params.kidnap_at == k)) {
      driver.kidnap();
      bounds.fill(no_prior.asDiagonal());
    }
    FieldFrame frame = draw_field_frame(map, params.frames, driver.truth(), random, false_lines);
    frame.scan.stamp = u.to;
    bounds[0] = (bounds[0].inverse() + frame.information).inverse();
    bounds[1] = (bounds[1].inverse() + frame.information + frame.goal_information).inverse();
    for (std::size_t i = 0; i < riders.size(); ++i) {
      riders[i].predict(u);
      riders[i].update(frame.scan);
      drive[localizers[i]].push_back({driver.truth(), riders[i].belief(),
                                      bounds[measures_by_goals(localizers[i]) ? 1 : 0],
                                      teleported});
    }
  }
  return drive;
}

std::vector<FieldDrive> drive_field_seeds(const FieldMap& map, const FieldDriveParams& params,
                                          const std::vector<FieldLocalizer>& localizers,
                                          std::uint64_t first, int count, int threads) {
  std::vector<FieldDrive> drives(static_cast<std::size_t>(count));
  work_off(drives.size(), threads,
           [&](std::size_t i) { drives[i] = drive_field(map, params, localizers, first + i); });
  return drives;
}

FieldDriveErrors drive_errors(const std::vector<FieldDrive>& drives, FieldLocalizer localizer) {
  FieldDriveErrors errors;
  std::vector<double> lengths;
  std::vector<double> squares;
  std::vector<double> bounds;
  for (const FieldDrive& drive : drives) {
    double square = 0.0;
    double bound = 0.0;
    for (const FieldDriveSample& sample : drive.at(localizer)) {
      const Eigen::Vector3d e = difference(sample.belief.pose, sample.truth);
      lengths.push_back(sample.error_m());
      errors.heading_mean += std::abs(e.z());
      if (sample.wrong()) {
        if (!sample.flagged()) ++errors.wrong_unflagged;
        continue;
      }
      ++errors.right;
      if (sample.flagged()) ++errors.right_flagged;
      square += e.head<2>().squaredNorm();
      bound += sample.bound.topLeftCorner<2, 2>().trace();
      errors.nees += nees({sample.truth, sample.belief.pose, sample.belief.covariance}) / 3.0;
    }
    squares.push_back(square);
    bounds.push_back(bound);
  }
  errors.frames = static_cast<int>(lengths.size());
  if (lengths.empty()) return errors;
  std::sort(lengths.begin(), lengths.end());
  const auto n = static_cast<double>(lengths.size());
  for (const double length : lengths) errors.mean_m += length / n;
  errors.heading_mean /= n;
  errors.p95_m = lengths[static_cast<std::size_t>(0.95 * (n - 1.0))];
  errors.max_m = lengths.back();
  if (errors.right == 0) return errors;
  errors.nees /= errors.right;
  errors.pcrlb_ratio = pcrlb_ratio(squares, bounds, 1);
  return errors;
}

namespace {

/// Frames from a teleport to the beginning of the first @p hold frames in a row below @p near_m,
/// before @p end.
std::optional<std::size_t> recovery_after(const std::vector<FieldDriveSample>& samples,
                                          std::size_t begin, std::size_t end, std::size_t hold,
                                          double near_m) {
  std::size_t in_a_row = 0;
  for (std::size_t k = begin; k < end; ++k) {
    in_a_row = samples[k].error_m() < near_m ? in_a_row + 1 : 0;
    if (in_a_row == hold) return k + 1 - hold - begin;
  }
  return std::nullopt;
}

}  // namespace

TeleportCount count_teleports(const std::vector<FieldDrive>& drives, FieldLocalizer localizer,
                              double period_s, const TeleportRule& rule) {
  TeleportCount count;
  const auto frames_of = [&](double seconds) {
    return static_cast<std::size_t>(std::lround(seconds / period_s));
  };
  for (const FieldDrive& drive : drives) {
    const std::vector<FieldDriveSample>& samples = drive.at(localizer);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      ++count.frames;
      if (samples[k].error_m() > rule.near_m) {
        ++count.far;
        if (!samples[k].flagged()) ++count.far_unflagged;
      }
      if (!samples[k].teleported) continue;
      ++count.teleports;
      std::size_t end = k + 1;
      while (end < samples.size() && !samples[end].teleported) ++end;
      if (end - k < frames_of(rule.judged_s)) continue;
      ++count.judged;
      const auto after = recovery_after(samples, k, end, frames_of(rule.hold_s), rule.near_m);
      if (!after) continue;
      ++count.recovered;
      const double seconds = static_cast<double>(*after) * period_s;
      count.mean_s += seconds;
      count.greatest_s = std::max(count.greatest_s, seconds);
    }
  }
  if (count.recovered > 0) count.mean_s /= count.recovered;
  return count;
}

KidnapCount count_kidnapped(const std::vector<FieldDrive>& drives, FieldLocalizer localizer,
                            int kidnapped_at, int within) {
  KidnapCount count;
  const int judged_at = kidnapped_at + within;
  for (const FieldDrive& drive : drives) {
    const std::vector<FieldDriveSample>& samples = drive.at(localizer);
    ++count.trials;
    const FieldDriveSample& last = samples.at(static_cast<std::size_t>(judged_at));
    if (!last.wrong() && !last.flagged()) ++count.recovered;
    if (last.wrong() && !last.flagged()) ++count.confident_wrong;
    if (last.flagged() &&
        std::any_of(last.belief.hypotheses.begin(), last.belief.hypotheses.end(),
                    [&](const PoseHypothesis& hypothesis) {
                      return (hypothesis.pose.position() - last.truth.position()).norm() < 0.5;
                    }))
      ++count.both;
    int k = kidnapped_at;
    while (k < judged_at && samples[static_cast<std::size_t>(k)].wrong() &&
           !samples[static_cast<std::size_t>(k)].flagged())
      ++k;
    count.mean_unflagged += k - kidnapped_at;
  }
  if (count.trials > 0) count.mean_unflagged /= count.trials;
  return count;
}

}  // namespace vigia::evaluation
