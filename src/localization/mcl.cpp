#include "vigia/localization/mcl.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

constexpr double kClusterRadius_m = 0.5;
constexpr double kClusterTurn = 0.35;
constexpr std::size_t kMostHypotheses = 4;
constexpr double kWidening = 1.5;  // of a suggestion's σ, so that its samples cover it
constexpr double kKldQuantile = 2.326;

double log_gaussian(const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  const Eigen::Vector3d white = llt.matrixL().solve(off);
  const double log_root = llt.matrixLLT().diagonal().array().log().sum();
  return -0.5 * white.squaredNorm() - log_root - 1.5 * std::log(2.0 * kPi);
}

Eigen::Vector3d normal_vector(RandomStream& random) {
  const double a = random.normal();
  const double b = random.normal();
  return {a, b, random.normal()};
}

Pose2 sample_about(const Pose2& mean, const Eigen::Matrix3d& root, RandomStream& random) {
  return Pose2::from_vector(mean.vector() + root * normal_vector(random));
}

/// Number of particles that KLD sampling asks for with @p bins occupied (Fox 2003, eq. 7).
int kld_size(std::size_t bins, double error) {
  if (bins < 2) return 0;
  const double k = static_cast<double>(bins - 1);
  const double a = 2.0 / (9.0 * k);
  return static_cast<int>(
      std::ceil(k / (2.0 * error) * std::pow(1.0 - a + std::sqrt(a) * kKldQuantile, 3.0)));
}

std::uint64_t bin_of(const Pose2& pose, const MclParams& params) {
  const auto part = [](double value, double size) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / size)) &
                                      0xFFFFF);
  };
  return part(pose.x, params.bin_m) << 40 | part(pose.y, params.bin_m) << 20 |
         part(pose.theta, params.bin_rad);
}

/// Whether a ray from the pose crosses any line in sight.
bool ray_meets_line(const FieldMap& map, const Pose2& pose, double bearing,
                    std::vector<LineCrossing>& scratch) {
  constexpr double kSight_m = 8.0;
  scratch.clear();
  const Eigen::Vector2d u = unit_vector(pose.theta + bearing);
  for (const FieldLine& line : map.lines) {
    cross_line(line, pose.position(), u, kSight_m, scratch);
    if (!scratch.empty()) return true;
  }
  return false;
}

bool looks_at(const Pose2& pose, double bearing, const Eigen::Vector2d& target, double half_width) {
  constexpr double kAllowed = 0.05;
  const Eigen::Vector2d to = target - pose.position();
  const double off = wrap_angle(std::atan2(to.y(), to.x()) - pose.theta - bearing);
  return std::abs(off) <= kAllowed + std::atan2(half_width, to.norm());
}

/// Minho §II.A: only the kind of a transition and its angle; a sample that agrees gains, another
/// loses.
double log_agreement(const FieldMap& map, const FieldScan& scan, const Pose2& pose) {
  const double gain = std::log(0.8);
  const double loss = std::log(0.2);
  double sum = 0.0;
  std::vector<LineCrossing> scratch;
  for (const FieldPoint& point : scan.points)
    sum +=
        ray_meets_line(map, pose, std::atan2(point.p_r.y(), point.p_r.x()), scratch) ? gain : loss;
  for (const ColourSighting& seen : scan.goals)
    for (const FieldGoal& goal : map.goals)
      if (goal.colour == seen.colour)
        sum += looks_at(pose, seen.bearing, goal.centre(), 0.5 * (goal.to - goal.from).norm())
                   ? gain
                   : loss;
  for (const ColourSighting& seen : scan.posts) {
    const bool met = std::any_of(map.posts.begin(), map.posts.end(), [&](const CornerPost& post) {
      return post.outer == seen.colour && looks_at(pose, seen.bearing, post.at, post.radius_m);
    });
    sum += met ? gain : loss;
  }
  return sum;
}

bool belongs(const Pose2& centre, const Pose2& pose) {
  const Eigen::Vector3d d = difference(pose, centre);
  return d.head<2>().norm() < kClusterRadius_m && std::abs(d.z()) < kClusterTurn;
}

/// Mean and spread of the particles marked for it.
PoseHypothesis hypothesis_of(const std::vector<Particle>& particles, const Pose2& centre,
                             std::vector<bool>& taken) {
  PoseHypothesis hypothesis;
  hypothesis.weight = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (taken[i] || !belongs(centre, particles[i].pose)) continue;
    taken[i] = true;
    const Eigen::Vector3d d = difference(particles[i].pose, centre);
    hypothesis.weight += particles[i].weight;
    sum += particles[i].weight * d;
    squares += particles[i].weight * d * d.transpose();
  }
  const Eigen::Vector3d mean = sum / hypothesis.weight;
  hypothesis.pose = Pose2::from_vector(centre.vector() + mean);
  hypothesis.covariance =
      squares / hypothesis.weight - mean * mean.transpose() + 1e-10 * Eigen::Matrix3d::Identity();
  return hypothesis;
}

std::vector<PoseHypothesis> clusters_of(const std::vector<Particle>& particles) {
  std::vector<bool> taken(particles.size(), false);
  std::vector<PoseHypothesis> clusters;
  while (clusters.size() < kMostHypotheses) {
    std::size_t heaviest = particles.size();
    for (std::size_t i = 0; i < particles.size(); ++i)
      if (!taken[i] && particles[i].weight > 0.0 &&
          (heaviest == particles.size() || particles[i].weight > particles[heaviest].weight))
        heaviest = i;
    if (heaviest == particles.size()) break;
    clusters.push_back(hypothesis_of(particles, particles[heaviest].pose, taken));
  }
  std::sort(clusters.begin(), clusters.end(),
            [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.weight > b.weight; });
  return clusters;
}

bool nearer_as_twin(const Pose2& pose, const Pose2& mean) {
  return (FieldModel::half_turned(pose).position() - mean.position()).norm() <
         (pose.position() - mean.position()).norm();
}

}  // namespace

Mcl::Mcl(const FieldModel& model, const MclParams& params, std::uint64_t seed)
    : model_(&model),
      params_(params),
      matcher_(model),
      random_(seed, "mcl"),
      clutter_(model.params().clutter) {}

void Mcl::sample_uniform(int count) {
  const FieldMap& map = model_->map();
  for (int i = 0; i < count; ++i) {
    const double x = random_.uniform(-0.5 * map.length_m, 0.5 * map.length_m);
    const double y = random_.uniform(-0.5 * map.width_m, 0.5 * map.width_m);
    particles_.push_back({{x, y, random_.uniform(-kPi, kPi)}, 1.0 / count});
  }
}

void Mcl::sample_gaussian(const Prior& prior, int count) {
  const Eigen::Matrix3d root = prior.covariance.llt().matrixL();
  for (int i = 0; i < count; ++i)
    particles_.push_back({sample_about(prior.pose, root, random_), 1.0 / count});
}

void Mcl::reset(Stamp stamp, const std::optional<Prior>& prior) {
  particles_.clear();
  fast_.reset();
  slow_.reset();
  since_check_ = params_.check_every;
  narrow_start_ = prior.has_value();
  twin_weight_ = 0.0;
  const int count = params_.method == MclParams::Method::as_described ? params_.min_particles
                                                                      : params_.max_particles;
  if (prior)
    sample_gaussian(*prior, count);
  else
    sample_uniform(count);
  if (model_->symmetric() && !prior) twin_weight_ = 0.5;
  belief_ = Belief{};
  belief_.stamp = stamp;
  refresh_belief();
}

void Mcl::predict(const OdometryIncrement& increment) {
  const Eigen::Vector3d sigma =
      control_covariance(increment, params_.odometry).diagonal().cwiseSqrt();
  for (Particle& particle : particles_) {
    const Eigen::Vector3d noise = sigma.cwiseProduct(normal_vector(random_));
    OdometryIncrement u = increment;
    u.rot1 += noise.x();
    u.trans += noise.y();
    u.rot2 += noise.z();
    particle.pose = move(particle.pose, u);
  }
  belief_.stamp = increment.to;
  refresh_belief();
}

Mcl::Spread Mcl::spread_of_all() const {
  const Pose2 centre = particles_.front().pose;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Particle& particle : particles_) {
    const Eigen::Vector3d d = difference(particle.pose, centre);
    sum += particle.weight * d;
    squares += particle.weight * d * d.transpose();
  }
  return {Pose2::from_vector(centre.vector() + sum),
          squares - sum * sum.transpose() + 1e-8 * Eigen::Matrix3d::Identity()};
}

double Mcl::log_weight(const FieldScan& scan, const Pose2& pose) const {
  if (params_.method == MclParams::Method::as_described)
    return log_agreement(model_->map(), scan, pose);
  return model_->log_likelihood(scan.points, pose, clutter_) +
         model_->log_likelihood_of_sightings(scan, pose);
}

void Mcl::weigh(const FieldScan& scan) {
  log_likelihoods_.clear();
  for (const Particle& particle : particles_)
    log_likelihoods_.push_back(log_weight(scan, particle.pose));
}

double Mcl::kidnap_prior() const {
  if (!fast_ || !slow_) return narrow_start_ ? 1e-3 : 0.5;
  const double fall = std::max(0.0, *slow_ - *fast_ - 5.0);
  return std::clamp(1.0 - std::exp(-0.1 * fall), params_.kidnapped, 0.5);
}

/// Samples of what the image suggests, weighed as samples of the mixture prior.
void Mcl::inject(const FieldScan& scan, const Spread& before) {
  const auto suggestions = matcher_.match(scan);
  if (suggestions.empty()) return;
  const FieldMap& map = model_->map();
  const double p = kidnap_prior();
  const double log_uniform = std::log(p / (map.length_m * map.width_m * 2.0 * kPi));
  const std::size_t own = particles_.size();
  std::vector<double> shares;
  double total = 0.0;
  for (const auto& s : suggestions) {
    // Of twins that nothing tells apart, the one on the particles' side.
    if (model_->symmetric() && nearer_as_twin(s.fix.pose, before.mean)) {
      shares.push_back(0.0);
      continue;
    }
    // What is unlikely here may be all that agrees with the particles.
    const double share = 0.1 + s.weight;
    shares.push_back(share);
    total += share;
  }
  for (std::size_t k = 0; k < suggestions.size(); ++k) {
    if (shares[k] <= 0.0) continue;
    const FieldFix& fix = suggestions[k].fix;
    const int count = std::max(10, static_cast<int>(params_.injected * shares[k] / total));
    const Eigen::Matrix3d wide = kWidening * kWidening * fix.covariance;
    const Eigen::Matrix3d root = wide.llt().matrixL();
    for (int i = 0; i < count; ++i) {
      const Pose2 pose = sample_about(fix.pose, root, random_);
      double log_prior = log_uniform;
      if (narrow_start_) {
        const double own_prior = log_gaussian(difference(pose, before.mean), before.covariance);
        log_prior = std::max(log_prior, own_prior);
      }
      const double log_proposal = log_gaussian(difference(pose, fix.pose), wide);
      particles_.push_back({pose, std::exp(std::min(600.0, log_prior - log_proposal)) / count});
      log_likelihoods_.push_back(log_weight(scan, pose));
    }
  }
  const double keep = narrow_start_ ? 1e-3 : 1.0 - p;
  for (std::size_t i = 0; i < own; ++i) particles_[i].weight *= keep;
}

void Mcl::resample() {
  // Low variance (Thrun, Burgard, Fox, Table 4.4), as many as KLD asks for.
  std::unordered_set<std::uint64_t> bins;
  for (const Particle& particle : particles_)
    if (particle.weight > 1e-6) bins.insert(bin_of(particle.pose, params_));
  const bool fixed = params_.method == MclParams::Method::as_described;
  const int count = fixed ? params_.min_particles
                          : std::clamp(kld_size(bins.size(), params_.kld_error),
                                       params_.min_particles, params_.max_particles);
  std::vector<Particle> chosen;
  chosen.reserve(static_cast<std::size_t>(count));
  const double step = 1.0 / count;
  double at = random_.uniform(0.0, step);
  double sum = particles_.front().weight;
  std::size_t i = 0;
  for (int n = 0; n < count; ++n, at += step) {
    while (sum < at && i + 1 < particles_.size()) sum += particles_[++i].weight;
    chosen.push_back({particles_[i].pose, step});
  }
  particles_ = std::move(chosen);
}

/// Follows the likelihood of the estimate and the share of clutter.
void Mcl::watch_likelihood(const FieldScan& scan) {
  const FieldLinearisation at = model_->linearise(scan.points, belief_.pose, clutter_);
  const double value = at.log_likelihood;
  fast_ = fast_ ? *fast_ + params_.fast * (value - *fast_) : value;
  slow_ = slow_ ? *slow_ + params_.slow * (value - *slow_) : value;
  const double points = static_cast<double>(scan.points.size());
  const double off = (points - at.on_lines + 1.0) / (points + 5.0);
  clutter_ = std::clamp(clutter_ + 0.1 * (off - clutter_), 0.01, 0.7);
}

void Mcl::update(const FieldScan& scan) {
  if (scan.points.empty() && scan.goals.empty() && scan.posts.empty()) return;
  belief_.stamp = scan.stamp;
  const Spread before = spread_of_all();
  weigh(scan);
  const std::size_t own = particles_.size();
  const bool best = params_.method == MclParams::Method::best;
  const bool from_prior = narrow_start_;
  const bool fallen = fast_ && slow_ && *fast_ < *slow_ - 8.0;
  if (best && (++since_check_ >= params_.check_every || (fallen && since_check_ >= 2))) {
    since_check_ = 0;
    inject(scan, before);
    narrow_start_ = false;
  }
  const double highest = *std::max_element(log_likelihoods_.begin(), log_likelihoods_.end());
  double sum = 0.0;
  double injected = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_[i].weight *= std::exp(log_likelihoods_[i] - highest);
    sum += particles_[i].weight;
    if (i >= own) injected += particles_[i].weight;
  }
  for (Particle& particle : particles_) {
    particle.weight /= sum;
    squares += particle.weight * particle.weight;
  }
  if (model_->symmetric() && !from_prior) twin_weight_ += injected / sum * (0.5 - twin_weight_);
  refresh_belief();
  if (best) watch_likelihood(scan);
  const double effective = 1.0 / squares;
  if (effective < params_.resample_share * static_cast<double>(particles_.size()) ||
      particles_.size() > own)
    resample();
}

void Mcl::refresh_belief() {
  std::vector<PoseHypothesis> clusters = clusters_of(particles_);
  if (model_->symmetric() && twin_weight_ > 1e-6) {
    PoseHypothesis twin = clusters.front();
    twin.pose = FieldModel::half_turned(twin.pose);
    twin.covariance.topRightCorner<2, 1>() *= -1.0;
    twin.covariance.bottomLeftCorner<1, 2>() *= -1.0;
    twin.weight *= twin_weight_;
    for (PoseHypothesis& cluster : clusters) cluster.weight *= 1.0 - twin_weight_;
    clusters.push_back(twin);
    std::sort(clusters.begin(), clusters.end(),
              [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.weight > b.weight; });
  }
  belief_.pose = clusters.front().pose;
  belief_.covariance = clusters.front().covariance;
  belief_.hypotheses.clear();
  belief_.lost_probability = 1.0 - clusters.front().weight;
  belief_.status = BeliefStatus::tracking;
  if (belief_.position_sigma() > params_.lost_sigma_m || clusters.front().weight < 0.3) {
    const Spread all = spread_of_all();
    belief_.covariance = all.covariance;
    belief_.status = BeliefStatus::lost;
  } else if (clusters.front().weight < params_.sure) {
    belief_.status = BeliefStatus::ambiguous;
    belief_.hypotheses = clusters;
  }
}

}  // namespace vigia::localization
