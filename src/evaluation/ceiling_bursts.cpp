#include "vigia/evaluation/ceiling_bursts.hpp"

#include "work_queue.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/evaluation/ceiling_views.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/plane_flow.hpp"

namespace vigia::evaluation {
namespace {

using localization::CeilingFilter;
using localization::CeilingFilterParams;

constexpr double kBeforeOutage_s = 0.75;
constexpr double kAfterOutage_s = 2.0;
constexpr double kGlare_s = 2.0;
constexpr double kGlareRadius_px = 190.0;  // and as much again to fade
constexpr double kGlareGrey = 400.0;
constexpr double kKidnapRate_hz = 25.0;

int steps(double seconds, double rate_hz, int at_least) {
  return std::max(at_least, static_cast<int>(std::lround(seconds * rate_hz)));
}

int outage_frames(const CeilingCondition& condition) {
  switch (condition.outage) {
    case CeilingOutage::ten_frames:
      return 10;
    case CeilingOutage::thirty_frames:
      return 30;
    case CeilingOutage::glare:
      return steps(kGlare_s, condition.rate_hz, 1);
  }
  return 0;
}

CeilingSetting hall_for(const CeilingOutageParams& params, std::uint64_t seed) {
  CeilingSetting setting;
  setting.seed = setting.ceiling.seed = seed;
  setting.ceiling.spurious = params.spurious;
  setting.ceiling.missing = params.missing;
  setting.ceiling.grid.placement_m = params.placement_m;
  setting.ceiling.grid.placement_turn = params.placement_turn;
  return setting;
}

/// A lamp's reflection on the lens about the picture's middle.
void add_glare(vpImage<unsigned char>& image) {
  const double u0 = 0.5 * (image.getWidth() - 1.0);
  const double v0 = 0.5 * (image.getHeight() - 1.0);
  for (unsigned v = 0; v < image.getHeight(); ++v) {
    for (unsigned u = 0; u < image.getWidth(); ++u) {
      const double off = std::max(0.0, std::hypot(u - u0, v - v0) - kGlareRadius_px);
      const double fade = off / (0.5 * kGlareRadius_px);
      const double grey = image[v][u] + kGlareGrey * std::exp(-0.5 * fade * fade);
      image[v][u] = static_cast<unsigned char>(std::min(255.0, grey));
    }
  }
}

/// Where the truth and the odometry's reading of it go, tick by tick.
class CeilingWalk {
 public:
  CeilingWalk(const CeilingCondition& condition, const CeilingOutageParams& params,
              std::uint64_t seed)
      : random_(seed, "ceiling walk"),
        noise_(params.odometry),
        step_m_(condition.speed_mps / condition.rate_hz),
        turn_(random_.uniform(-params.max_turn, params.max_turn) / condition.rate_hz),
        period_s_(1.0 / condition.rate_hz) {
    put_down();
  }

  const Pose2& pose() const { return pose_; }
  Stamp now() const { return now_; }
  RandomStream& random() { return random_; }

  /// Anywhere, turned anyhow.
  void put_down() {
    pose_ = {random_.uniform(-50.0, 50.0), random_.uniform(-50.0, 50.0),
             random_.uniform(-kPi, kPi)};
  }

  /// One tick of driving, as the odometry reads it.
  OdometryIncrement drive() {
    OdometryIncrement u{now_, Stamp::from_seconds(period_s_ * ++ticks_), 0.5 * turn_, step_m_,
                        0.5 * turn_};
    pose_ = move(pose_, u);
    now_ = u.to;
    const Eigen::Matrix3d L = control_covariance(u, noise_).llt().matrixL();
    const Eigen::Vector3d error =
        L * Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
    u.rot1 += error[0];
    u.trans += error[1];
    u.rot2 += error[2];
    return u;
  }

 private:
  RandomStream random_;
  OdometryNoise noise_;
  double step_m_;
  double turn_;  // a tick
  double period_s_;
  int ticks_ = 0;
  Stamp now_;
  Pose2 pose_;
};

/// The robot's side: patches, and odometry or flow where it has them.
class CeilingWatch {
 public:
  CeilingWatch(const CeilingSetting& setting, const CeilingCondition& condition,
               const CeilingOutageParams& params, const Prior& prior)
      : condition_(condition),
        finder_(setting.finder()),
        flow_(setting.known_camera().model, setting.known_camera().rMc.linear()),
        filter_(setting.known_camera(), setting.ceiling.grid, filter_params(condition, params)) {
    filter_.reset({}, prior);
  }

  /// A tick without a picture: without odometry nothing is known until the next.
  void drive_blind(const OdometryIncrement& u) {
    if (condition_.odometry) filter_.predict(u);
    now_ = u.to;
  }

  void see(const vpImage<unsigned char>& image, const OdometryIncrement& u) {
    now_ = u.to;
    const auto step = condition_.flow ? flow_.next(image) : std::nullopt;
    const std::vector<PatchImage> patches = finder_.find(imaging::ImageFrame(image)).patches;
    // Over ticks without pictures the odometry has gone on already.
    const bool bridged = condition_.odometry && filter_.belief().stamp > last_seen_;
    if (step && condition_.odometry && !bridged)
      filter_.predict(u, *step);
    else if (step && !bridged)
      filter_.predict(*step, now_, patches);
    else if (condition_.odometry)
      filter_.predict(u);
    else if (now_ > filter_.belief().stamp)
      filter_.predict_unknown(now_);
    filter_.update(patches);
    last_seen_ = now_;
  }

  /// As of now, whatever was last heard of.
  Belief belief() const {
    if (filter_.belief().stamp == now_) return filter_.belief();
    CeilingFilter now = filter_;
    now.predict_unknown(now_);
    return now.belief();
  }

 private:
  static CeilingFilterParams filter_params(const CeilingCondition& condition,
                                           const CeilingOutageParams& params) {
    CeilingFilterParams own;
    own.odometry = params.odometry;
    own.max_speed_mps = params.max_over_speed * condition.speed_mps;
    return own;
  }

  CeilingCondition condition_;
  tracking::PatchFinder finder_;
  tracking::FrameFlow flow_;
  CeilingFilter filter_;
  Stamp now_;
  Stamp last_seen_;
};

/// Rectangles without patches about a place, as far as a drive from there may get to.
std::vector<CeilingGrid::Extent> gaps_about(const Eigen::Vector2d& place, std::uint64_t seed) {
  constexpr int kGapPitch = 4;     // cells, of the squares that have a gap each
  constexpr int kGapSquares = 4;   // each way
  constexpr double kMargin = 0.3;  // cells
  RandomStream random(seed, "ceiling gaps");
  std::vector<CeilingGrid::Extent> gaps;
  for (int i = -kGapSquares; i <= kGapSquares; ++i) {
    for (int j = -kGapSquares; j <= kGapSquares; ++j) {
      const auto draw = [&](int from, int to) {
        return std::floor(random.uniform(from, to + 1.0));
      };
      const Eigen::Vector2d corner(std::round(place.x()) + kGapPitch * i + draw(0, 1),
                                   std::round(place.y()) + kGapPitch * j + draw(0, 1));
      const Eigen::Vector2d size(draw(0, 2), draw(0, 2));
      gaps.push_back({(corner.array() - kMargin).matrix(),
                      (corner + size + Eigen::Vector2d::Constant(kMargin)).eval()});
    }
  }
  return gaps;
}

bool wrong_cell(const Pose2& truth, const Pose2& estimate, const CeilingGrid& grid) {
  const Eigen::Vector3d error = difference(estimate, truth);
  return error.head<2>().cwiseAbs().maxCoeff() > 0.5 * grid.pitch_m ||
         std::abs(error.z()) > 0.5 * kPi;
}

Prior start_of(CeilingWalk& walk) {
  constexpr double kSigma = 0.02;
  Prior prior{walk.pose(), kSigma * kSigma * Eigen::Matrix3d::Identity()};
  prior.pose.x += kSigma * walk.random().normal();
  prior.pose.y += kSigma * walk.random().normal();
  prior.pose.theta = wrap_angle(prior.pose.theta + kSigma * walk.random().normal());
  return prior;
}

}  // namespace

std::string to_string(CeilingOutage outage) {
  switch (outage) {
    case CeilingOutage::ten_frames:
      return "10 frames lost";
    case CeilingOutage::thirty_frames:
      return "30 frames lost";
    case CeilingOutage::glare:
      return "glare of 2 s";
  }
  return "";
}

std::vector<CeilingCondition> ceiling_conditions() {
  std::vector<CeilingCondition> conditions;
  for (const CeilingOutage outage :
       {CeilingOutage::ten_frames, CeilingOutage::thirty_frames, CeilingOutage::glare})
    for (const double speed_mps : {0.1, 0.3, 1.0})
      for (const double rate_hz : {25.0, 5.0})
        for (const bool odometry : {true, false})
          for (const bool flow : {true, false})
            conditions.push_back({outage, speed_mps, rate_hz, odometry, flow});
  return conditions;
}

CeilingOutageTrial try_outage(const CeilingCondition& condition, const CeilingOutageParams& params,
                              std::uint64_t seed) {
  const CeilingSetting setting = hall_for(params, seed);
  const CeilingHall hall(setting);
  CeilingWalk walk(condition, params, seed);
  CeilingWatch watch(setting, condition, params, start_of(walk));
  const int before = steps(kBeforeOutage_s, condition.rate_hz, 6);
  const int out = outage_frames(condition);
  const int after = steps(kAfterOutage_s, condition.rate_hz, 10);
  CeilingOutageTrial trial;
  for (int i = 0; i < before + out + after; ++i) {
    const OdometryIncrement u = walk.drive();
    const bool outage = i >= before && i < before + out;
    if (outage && condition.outage != CeilingOutage::glare) {
      watch.drive_blind(u);
    } else {
      vpImage<unsigned char> image = imaging::grey_image(*hall.expose(walk.pose(), i));
      if (outage) add_glare(image);
      watch.see(image, u);
    }
    if (outage) trial.blind_m += condition.speed_mps / condition.rate_hz;
    if (i < before) continue;
    const Belief belief = watch.belief();
    const bool wrong = wrong_cell(walk.pose(), belief.pose, setting.ceiling.grid);
    const bool sure = belief.status == BeliefStatus::tracking;
    ++trial.instants;
    trial.wrong_unflagged += wrong && sure ? 1 : 0;
    trial.last_error_m = difference(belief.pose, walk.pose()).head<2>().norm();
    if (outage) continue;
    trial.right_after += wrong ? 0 : 1;
    trial.right_flagged += !wrong && !sure ? 1 : 0;
    if (wrong || !sure || trial.recovered) continue;
    trial.recovered = true;
    trial.recovery_s = (i + 1 - before - out) / condition.rate_hz;
  }
  return trial;
}

CeilingKidnapping try_kidnapping(const CeilingOutageParams& params, std::uint64_t seed) {
  const CeilingCondition condition{CeilingOutage::ten_frames, 0.3, kKidnapRate_hz, true, false};
  const CeilingSetting setting = hall_for(params, seed);
  const CeilingHall hall(setting);
  CeilingWalk walk(condition, params, seed);
  CeilingWatch watch(setting, condition, params, start_of(walk));
  const int before = steps(kBeforeOutage_s, kKidnapRate_hz, 1);
  const int after = steps(kAfterOutage_s, kKidnapRate_hz, 1);
  CeilingKidnapping trial;
  for (int i = 0; i < before + after; ++i) {
    if (i == before) walk.put_down();
    const OdometryIncrement u = walk.drive();
    watch.see(imaging::grey_image(*hall.expose(walk.pose(), i)), u);
    if (i < before) continue;
    const Belief belief = watch.belief();
    trial.flagged = belief.status != BeliefStatus::tracking;
    ++trial.frames;
    trial.wrong_unflagged +=
        !trial.flagged && wrong_cell(walk.pose(), belief.pose, setting.ceiling.grid) ? 1 : 0;
    const Eigen::Vector3d error = difference(belief.pose, walk.pose());
    const double pitch = setting.ceiling.grid.pitch_m;
    trial.in_cell_m =
        Eigen::Vector2d(std::remainder(error.x(), pitch), std::remainder(error.y(), pitch)).norm();
    trial.heading_error = std::abs(error.z());
  }
  return trial;
}

CeilingSettling try_settling(bool gaps, const CeilingOutageParams& params, std::uint64_t seed) {
  constexpr double kWay_m = 6.0;
  const CeilingCondition condition{CeilingOutage::thirty_frames, 0.5, kKidnapRate_hz, false, false};
  CeilingSetting setting = hall_for(params, seed);
  CeilingWalk walk(condition, params, seed);
  if (gaps) setting.ceiling.grid.gaps = gaps_about(walk.pose().position(), seed);
  const CeilingHall hall(setting);
  CeilingWatch watch(setting, condition, params, start_of(walk));
  const int before = steps(kBeforeOutage_s, kKidnapRate_hz, 1);
  const int out = outage_frames(condition);
  const int after = steps(kWay_m / condition.speed_mps, kKidnapRate_hz, 1);
  CeilingSettling trial;
  for (int i = 0; i < before + out + after; ++i) {
    const OdometryIncrement u = walk.drive();
    if (i >= before && i < before + out) {
      watch.drive_blind(u);
      continue;
    }
    watch.see(imaging::grey_image(*hall.expose(walk.pose(), i)), u);
    if (i < before) continue;
    const Belief belief = watch.belief();
    const bool sure = belief.status == BeliefStatus::tracking;
    const bool wrong = wrong_cell(walk.pose(), belief.pose, setting.ceiling.grid);
    trial.ambiguous = trial.ambiguous || !sure;
    trial.wrong_unflagged += sure && wrong ? 1 : 0;
    trial.settled = sure;
    trial.right = sure && !wrong;
    if (!sure) trial.way_m = (i + 1 - before - out) / kKidnapRate_hz * condition.speed_mps;
  }
  return trial;
}

std::vector<CeilingSettling> try_settlings(int count, bool gaps, const CeilingOutageParams& params,
                                           std::uint64_t first, int threads) {
  std::vector<CeilingSettling> trials(static_cast<std::size_t>(count));
  work_off(trials.size(), threads,
           [&](std::size_t i) { trials[i] = try_settling(gaps, params, first + i); });
  return trials;
}

std::vector<CeilingOutageTrial> try_outages(const std::vector<CeilingCondition>& conditions,
                                            int each, const CeilingOutageParams& params,
                                            std::uint64_t first, int threads) {
  const auto trials_each = static_cast<std::size_t>(each);
  std::vector<CeilingOutageTrial> trials(conditions.size() * trials_each);
  work_off(trials.size(), threads, [&](std::size_t i) {
    trials[i] = try_outage(conditions[i / trials_each], params, first + i);
  });
  return trials;
}

std::vector<CeilingKidnapping> try_kidnappings(int count, const CeilingOutageParams& params,
                                               std::uint64_t first, int threads) {
  std::vector<CeilingKidnapping> trials(static_cast<std::size_t>(count));
  work_off(trials.size(), threads,
           [&](std::size_t i) { trials[i] = try_kidnapping(params, first + i); });
  return trials;
}

}  // namespace vigia::evaluation
