#include "vigia/localization/mcl.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_set>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

constexpr double kClusterRadius_m = 0.5;
constexpr double kClusterTurn = 0.35;
constexpr std::size_t kMostHypotheses = 4;
constexpr double kWidening = 1.5;  // of a suggestion's σ, so that its samples cover it
constexpr double kKldQuantile = 2.326;
const Eigen::Matrix3d kTinyVariance = 1e-10 * Eigen::Matrix3d::Identity();
constexpr double kProposalWidening = 1.5;  // of a suggestion's covariance
constexpr double kMinInformedWeight = 0.01;
constexpr double kWideCluster_m = 0.3;
constexpr double kAgreeingSigmas = 4.0;
constexpr double kDepleted = 15.0;       // effective particles
constexpr double kForgottenTwin = 1e-6;  // weight
constexpr double kTurnedShare = 0.6;     // of a cluster's weight that is half a turn away
constexpr double kUsualFall = 15.0;  // of the log-likelihood below its long-term mean, by chance

double log_gaussian(const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  const Eigen::Vector3d white = llt.matrixL().solve(off);
  const double log_root = llt.matrixLLT().diagonal().array().log().sum();
  return -0.5 * white.squaredNorm() - log_root - 1.5 * std::log(2.0 * kPi);
}

/// (x, y, θ) turned by an angle.
Eigen::Matrix3d in_frame(double theta) {
  return Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// A covariance in the frame of a robot with heading @p theta, in world axes.
Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance_r, double theta) {
  const Eigen::Matrix3d R = in_frame(theta);
  return R * covariance_r * R.transpose();
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

constexpr std::size_t kNoCluster = 1000;

/// Particles about one place, the heaviest cluster first.
struct Clusters {
  std::vector<PoseHypothesis> all;  ///< mean, spread and weight of each
  std::vector<std::size_t> of;      ///< per particle, or kNoCluster
};

/// Mean and spread of the free particles about @p centre, which become the cluster's.
PoseHypothesis gather(const std::vector<Particle>& particles, const Pose2& centre,
                      std::size_t cluster, std::vector<std::size_t>& of) {
  PoseHypothesis hypothesis;
  hypothesis.weight = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (of[i] != kNoCluster || !belongs(centre, particles[i].pose)) continue;
    of[i] = cluster;
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

Clusters clusters_of(const std::vector<Particle>& particles, std::size_t most) {
  Clusters clusters;
  clusters.of.assign(particles.size(), kNoCluster);
  while (clusters.all.size() < most) {
    std::size_t heaviest = particles.size();
    for (std::size_t i = 0; i < particles.size(); ++i)
      if (clusters.of[i] == kNoCluster && particles[i].weight > 0.0 &&
          (heaviest == particles.size() || particles[i].weight > particles[heaviest].weight))
        heaviest = i;
    if (heaviest == particles.size()) break;
    clusters.all.push_back(
        gather(particles, particles[heaviest].pose, clusters.all.size(), clusters.of));
  }
  return clusters;
}

std::vector<PoseHypothesis> by_weight(std::vector<PoseHypothesis> hypotheses) {
  std::sort(hypotheses.begin(), hypotheses.end(),
            [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.weight > b.weight; });
  return hypotheses;
}

/// Weights by the log-likelihoods; their sum becomes one.
void weigh_by(const std::vector<double>& log_likelihoods, std::vector<Particle>& particles) {
  const double highest = *std::max_element(log_likelihoods.begin(), log_likelihoods.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles[i].weight *= std::exp(log_likelihoods[i] - highest);
    sum += particles[i].weight;
  }
  for (Particle& particle : particles) particle.weight /= sum;
}

double effective_number(const std::vector<Particle>& particles) {
  double squares = 0.0;
  for (const Particle& particle : particles) squares += particle.weight * particle.weight;
  return 1.0 / squares;
}

void half_turn(Particle& particle) {
  particle.pose = FieldModel::half_turned(particle.pose);
  particle.twin = 1.0 - particle.twin;
}

/// The suggestions, of two that are half a turn apart the better.
std::vector<FieldMatcher::Suggestion> without_twins(
    const std::vector<FieldMatcher::Suggestion>& suggestions) {
  std::vector<FieldMatcher::Suggestion> kept;
  for (const auto& suggestion : suggestions) {
    const Pose2 twin = FieldModel::half_turned(suggestion.fix.pose);
    const bool known = std::any_of(
        kept.begin(), kept.end(), [&](const auto& other) { return belongs(other.fix.pose, twin); });
    if (!known) kept.push_back(suggestion);
  }
  return kept;
}

/// A pose that an image suggests by itself.
struct SuggestedPose {
  Pose2 pose;
  Eigen::Matrix3d covariance;
};

/// Draws a particle's motion noise with the image in view (Grisetti, Stachniss, Burgard 2007): from
/// the product of the noise about the particle, N(x, Q), and of the pose that the image suggests by
/// itself, N(z, R).
class InformedNoise {
 public:
  InformedNoise(const Eigen::Matrix3d& noise, const SuggestedPose& suggested)
      : suggested_(suggested.pose),
        suggested_covariance_(kProposalWidening * suggested.covariance),
        sum_(noise + suggested_covariance_),
        gain_(noise * sum_.inverse()) {
    const Eigen::Matrix3d left = noise - gain_ * noise;
    root_ = Eigen::Matrix3d(0.5 * (left + left.transpose()) + kTinyVariance).llt().matrixL();
  }

  /// @p log_weight: of the noise's density over the proposal's.
  Pose2 draw(const Pose2& at, RandomStream& random, double& log_weight) const {
    const Eigen::Vector3d innovation = difference(suggested_, at);
    const Pose2 mean = Pose2::from_vector(at.vector() + gain_ * innovation);
    const Pose2 drawn = sample_about(mean, root_, random);
    // N(x'; x, Q) / q(x') = N(z; x, Q + R) / N(x'; z, R).
    log_weight = log_gaussian(innovation, sum_) -
                 log_gaussian(difference(drawn, suggested_), suggested_covariance_);
    return drawn;
  }

 private:
  Pose2 suggested_;
  Eigen::Matrix3d suggested_covariance_;
  Eigen::Matrix3d sum_;
  Eigen::Matrix3d gain_;
  Eigen::Matrix3d root_;
};

/// The fix by the points, moved by the goals and posts in sight.
SuggestedPose with_sightings(const FieldModel& model, const FieldScan& scan, const FieldFix& fix) {
  const FieldLinearisation seen = model.linearise_sightings(scan, fix.pose);
  const Eigen::Matrix3d covariance =
      Eigen::Matrix3d(fix.covariance.inverse() + seen.complete).inverse();
  return {Pose2::from_vector(fix.pose.vector() + covariance * seen.gradient), covariance};
}

/// What the image suggests near a cluster, where it does and the cluster is narrow.
std::optional<SuggestedPose> agreeing_suggestion(const FieldModel& model, const FieldScan& scan,
                                                 const PoseHypothesis& cluster,
                                                 const Eigen::Matrix3d& noise, double clutter) {
  if (cluster.weight < kMinInformedWeight ||
      Eigen::Matrix3d(cluster.covariance + noise).diagonal().head<2>().maxCoeff() >
          kWideCluster_m * kWideCluster_m)
    return std::nullopt;
  FieldRefineParams fixed;
  fixed.clutter = clutter;
  const FieldFix fix = refine_field_pose(model, scan.points, cluster.pose, std::nullopt, fixed);
  if (fix.status != FieldFixStatus::converged) return std::nullopt;
  const SuggestedPose suggested = with_sightings(model, scan, fix);
  const Eigen::Vector3d off = difference(suggested.pose, cluster.pose);
  const Eigen::Matrix3d sum = cluster.covariance + noise + suggested.covariance;
  if (off.dot(sum.inverse() * off) > kAgreeingSigmas * kAgreeingSigmas) return std::nullopt;
  return suggested;
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
  const bool twins = params_.method == MclParams::Method::best && model_->lines_symmetric();
  const double twin = twins ? 0.5 : 0.0;
  for (int i = 0; i < count; ++i) {
    const double x = random_.uniform(-0.5 * map.length_m, 0.5 * map.length_m);
    const double y = random_.uniform(-0.5 * map.width_m, 0.5 * map.width_m);
    particles_.push_back({{x, y, random_.uniform(-kPi, kPi)}, 1.0 / count, twin});
  }
}

void Mcl::reset(Stamp stamp, const std::optional<Prior>& prior) {
  particles_.clear();
  fast_.reset();
  slow_.reset();
  since_check_ = params_.check_every;
  given_prior_ = prior.has_value();
  motion_noise_.setZero();
  const int count = params_.method == MclParams::Method::as_described ? params_.min_particles
                                                                      : params_.max_particles;
  if (prior) {
    particles_.assign(static_cast<std::size_t>(count), {prior->pose, 1.0 / count});
    // As any noise, it is drawn with the first image in view.
    motion_noise_ = turned(prior->covariance, -prior->pose.theta);
  } else {
    sample_uniform(count);
  }
  belief_ = Belief{};
  belief_.stamp = stamp;
  refresh_belief();
}

void Mcl::predict(const OdometryIncrement& increment) {
  // In each particle's own frame the move and its noise are the same for all.
  const Pose2 origin;
  const Eigen::Matrix3d back = in_frame(-move(origin, increment).theta);
  const Eigen::Matrix3d F = back * move_jacobian_pose(origin, increment);
  const Eigen::Matrix3d G = back * move_jacobian_control(origin, increment);
  motion_noise_ = F * motion_noise_ * F.transpose() +
                  G * control_covariance(increment, params_.odometry) * G.transpose();
  for (Particle& particle : particles_) particle.pose = move(particle.pose, increment);
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
  const Eigen::Matrix3d noise = turned(motion_noise_, centre.theta);
  return {Pose2::from_vector(centre.vector() + sum),
          squares - sum * sum.transpose() + noise + 1e-8 * Eigen::Matrix3d::Identity()};
}

double Mcl::log_weight_of_sightings(const FieldScan& scan, Particle& particle) const {
  const double here = model_->log_likelihood_of_sightings(scan, particle.pose);
  if (particle.twin == 0.0) return here;
  const double there =
      model_->log_likelihood_of_sightings(scan, FieldModel::half_turned(particle.pose));
  const double higher = std::max(here, there);
  const double own = (1.0 - particle.twin) * std::exp(here - higher);
  const double twin = particle.twin * std::exp(there - higher);
  particle.twin = twin / (own + twin);
  return higher + std::log(own + twin);
}

double Mcl::log_weight(const FieldScan& scan, Particle& particle) const {
  if (params_.method == MclParams::Method::as_described)
    return log_agreement(model_->map(), scan, particle.pose);
  return model_->line_evidence(scan.points, groups_, particle.pose, clutter_) +
         log_weight_of_sightings(scan, particle);
}

std::vector<double> Mcl::draw_motion_noise(const FieldScan& scan) {
  std::vector<double> log_weights(particles_.size(), 0.0);
  Clusters clusters;
  std::vector<std::optional<InformedNoise>> informed;
  if (params_.method == MclParams::Method::best) {
    clusters = clusters_of(particles_, kMostHypotheses);
    for (const PoseHypothesis& cluster : clusters.all) {
      const Eigen::Matrix3d noise = turned(motion_noise_, cluster.pose.theta) + kTinyVariance;
      const auto suggested = agreeing_suggestion(*model_, scan, cluster, noise, clutter_);
      informed.emplace_back(suggested
                                ? std::optional<InformedNoise>(InformedNoise(noise, *suggested))
                                : std::nullopt);
    }
  }
  const Eigen::Matrix3d root = Eigen::Matrix3d(motion_noise_ + kTinyVariance).llt().matrixL();
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Pose2& pose = particles_[i].pose;
    const std::size_t cluster = clusters.of.empty() ? kNoCluster : clusters.of[i];
    pose = cluster != kNoCluster && informed[cluster]
               ? informed[cluster]->draw(pose, random_, log_weights[i])
               : sample_about(pose, in_frame(pose.theta) * root, random_);
  }
  motion_noise_.setZero();
  return log_weights;
}

std::vector<PoseHypothesis> Mcl::predicted_hypotheses() const {
  std::vector<PoseHypothesis> all = hypotheses();
  for (PoseHypothesis& one : all) one.covariance += turned(motion_noise_, one.pose.theta);
  return all;
}

double Mcl::MixturePrior::density(const Pose2& pose) const {
  double sum = anywhere;
  for (const PoseHypothesis& one : known)
    sum += one.weight * std::exp(log_gaussian(difference(pose, one.pose), one.covariance));
  return sum;
}

void Mcl::inject_about(const FieldFix& fix, int count, const MixturePrior& prior,
                       const FieldScan& scan) {
  const Eigen::Matrix3d wide = kWidening * kWidening * fix.covariance;
  const Eigen::Matrix3d root = wide.llt().matrixL();
  for (int i = 0; i < count; ++i) {
    const Pose2 pose = sample_about(fix.pose, root, random_);
    const double log_proposal = log_gaussian(difference(pose, fix.pose), wide);
    const double here = prior.density(pose);
    const double there =
        model_->lines_symmetric() ? prior.density(FieldModel::half_turned(pose)) : 0.0;
    const double log_prior = std::log(here + there);
    particles_.push_back({pose, std::exp(std::min(600.0, log_prior - log_proposal)) / count,
                          there / (here + there)});
    log_likelihoods_.push_back(log_weight(scan, particles_.back()));
  }
}

/// Samples of what the image suggests, weighed as samples of the mixture prior. Those where the
/// particles are know what the particles do of the half: where these are too few for a narrow
/// likelihood, samples of a uniform prior would outweigh them and forget it.
void Mcl::inject(const FieldScan& scan, std::vector<PoseHypothesis> expected) {
  std::vector<FieldMatcher::Suggestion> suggestions = matcher_.match(scan);
  if (suggestions.empty()) return;
  const FieldMap& map = model_->map();
  const bool nothing_known = !fast_ && !given_prior_;
  const double p = nothing_known ? 0.5 : params_.kidnapped;
  if (nothing_known) expected.clear();
  for (PoseHypothesis& one : expected) one.weight *= 1.0 - p;
  const MixturePrior prior{std::move(expected), p / (map.length_m * map.width_m * 2.0 * kPi)};
  if (model_->lines_symmetric()) suggestions = without_twins(suggestions);
  for (Particle& particle : particles_) particle.weight *= 1.0 - p;
  // What is unlikely here may be all that agrees with the particles.
  constexpr double kOddShare = 0.1;
  double total = 0.0;
  for (const auto& s : suggestions) total += kOddShare + s.weight;
  for (const auto& s : suggestions)
    inject_about(s.fix,
                 std::max(10, static_cast<int>(params_.injected * (kOddShare + s.weight) / total)),
                 prior, scan);
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
    chosen.push_back({particles_[i].pose, step, particles_[i].twin});
  }
  particles_ = std::move(chosen);
  if (!fixed) spread_copies();
}

void Mcl::spread_copies() {
  // Liu, West 2001: shrunk towards the mean and spread by a kernel, so that mean and covariance
  // stay.
  const double h = params_.kernel;
  const double shrink = std::sqrt(1.0 - h * h);
  const Clusters clusters = clusters_of(particles_, kMostHypotheses);
  std::vector<Eigen::Matrix3d> roots;
  for (const PoseHypothesis& cluster : clusters.all)
    roots.push_back(h * Eigen::Matrix3d(cluster.covariance.llt().matrixL()));
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (clusters.of[i] == kNoCluster) continue;
    const Pose2& mean = clusters.all[clusters.of[i]].pose;
    const Eigen::Vector3d off = shrink * difference(particles_[i].pose, mean);
    particles_[i].pose =
        sample_about(Pose2::from_vector(mean.vector() + off), roots[clusters.of[i]], random_);
  }
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
  const bool best = params_.method == MclParams::Method::best;
  if (best) groups_ = model_->groups_of(scan);
  const bool fallen = fast_ && slow_ && *fast_ < *slow_ - kUsualFall;
  ++since_check_;
  const bool check = best && (since_check_ >= params_.check_every || (fallen && since_check_ >= 2));
  const std::vector<PoseHypothesis> expected =
      check ? predicted_hypotheses() : std::vector<PoseHypothesis>{};
  log_likelihoods_ = draw_motion_noise(scan);
  for (std::size_t i = 0; i < particles_.size(); ++i)
    log_likelihoods_[i] += log_weight(scan, particles_[i]);
  const std::size_t own = particles_.size();
  if (check) {
    since_check_ = 0;
    inject(scan, expected);
  }
  weigh_by(log_likelihoods_, particles_);
  if (best && model_->lines_symmetric()) fold_twins();
  const double effective = effective_number(particles_);
  const bool resampled =
      particles_.size() > own || effective < params_.resample_share * static_cast<double>(own);
  if (best && effective < kDepleted) widen_depleted(scan);
  refresh_belief();
  if (best) watch_likelihood(scan);
  if (resampled) resample();
}

void Mcl::widen_depleted(const FieldScan& scan) {
  // So few particles say nothing of the spread: the image's own covariance stands in for it.
  resample();
  const Pose2 pose = clusters_of(particles_, 1).all.front().pose;
  const Eigen::Matrix3d information =
      model_->linearise(scan.points, pose, clutter_).complete + Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d root = Eigen::Matrix3d(information.inverse()).llt().matrixL();
  for (Particle& particle : particles_) particle.pose = sample_about(particle.pose, root, random_);
}

/// Turns particles whose half-turned pose lies in a heavier cluster into it, and clusters that are
/// most likely half a turn away.
void Mcl::fold_twins() {
  std::vector<bool> taken(particles_.size(), false);
  for (std::size_t n = 0; n < kMostHypotheses; ++n) {
    std::optional<std::size_t> heaviest;
    for (std::size_t i = 0; i < particles_.size(); ++i)
      if (!taken[i] && (!heaviest || particles_[i].weight > particles_[*heaviest].weight))
        heaviest = i;
    if (!heaviest) return;
    const Pose2 centre = particles_[*heaviest].pose;
    std::vector<std::size_t> cluster;
    double weight = 0.0;
    double twin = 0.0;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      if (taken[i]) continue;
      Particle& particle = particles_[i];
      const bool here = belongs(centre, particle.pose);
      if (!here && !belongs(centre, FieldModel::half_turned(particle.pose))) continue;
      if (!here) half_turn(particle);
      taken[i] = true;
      cluster.push_back(i);
      weight += particle.weight;
      twin += particle.weight * particle.twin;
    }
    if (twin > kTurnedShare * weight)
      for (const std::size_t i : cluster) half_turn(particles_[i]);
  }
}

/// Clusters of particles and their twins, the heaviest first.
std::vector<PoseHypothesis> Mcl::hypotheses() const {
  const Clusters clusters = clusters_of(particles_, kMostHypotheses);
  std::vector<PoseHypothesis> all = clusters.all;
  std::vector<PoseHypothesis> twins = clusters.all;
  for (PoseHypothesis& twin : twins) {
    twin.pose = FieldModel::half_turned(twin.pose);
    twin.covariance = turned(twin.covariance, kPi);
    twin.weight = 0.0;
  }
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (clusters.of[i] == kNoCluster) continue;
    const double twin = particles_[i].weight * particles_[i].twin;
    all[clusters.of[i]].weight -= twin;
    twins[clusters.of[i]].weight += twin;
  }
  for (const PoseHypothesis& twin : twins)
    if (twin.weight > kForgottenTwin) all.push_back(twin);
  return by_weight(std::move(all));
}

void Mcl::refresh_belief() {
  std::vector<PoseHypothesis> clusters = hypotheses();
  for (PoseHypothesis& cluster : clusters)
    cluster.covariance += turned(motion_noise_, cluster.pose.theta);
  belief_.pose = clusters.front().pose;
  belief_.covariance = clusters.front().covariance;
  belief_.hypotheses.clear();
  belief_.lost_probability = std::clamp(1.0 - clusters.front().weight, 0.0, 1.0);
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
