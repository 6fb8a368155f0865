#include "vigia/localization/relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {
namespace {

constexpr int kMaxSteps = 20;
/// A fit less likely than this is none. Far out: the right pose must not drop out by bad luck and
/// leave the field to a wrong one, and two discs in one look share an error that counts twice here.
constexpr double kImpossible = 1e-6;
/// How far off place() may put a disc: so much, and a share of the range. Sizes off the optical
/// axis overstate the range by up to a tenth.
constexpr double kPlaceTolerance_m = 0.1;
constexpr double kPlaceToleranceShare = 0.12;
/// Pairs are made of so many sightings, the largest in the image, whose ranges are the best.
constexpr std::size_t kPairedSightings = 10;
/// So many seeds are all tried in full; of more, as many as kChosenSeeds that the sightings support
/// best and that stand apart.
constexpr std::size_t kMaxSeeds = 600;
constexpr std::size_t kChosenSeeds = 60;
/// A start covariance wide enough to take in every landmark that a closed-form pose may mean.
const Eigen::Vector3d kSeedSigma(0.3, 0.3, from_deg(4.0));

/// Two frames of one look that show the same disc count once: they share their biases.
bool same_disc(const EllipseObservation& a, const EllipseObservation& b) {
  if (a.shot.look != b.shot.look) return false;
  const auto direction = [](const EllipseObservation& seen) {
    const Eigen::Vector2d xy = unproject(pinhole(seen.shot), {seen.ellipse.u, seen.ellipse.v});
    return Eigen::Vector3d(camera_in_base(HeadGeometry{}, seen.shot.head).linear() *
                           xy.homogeneous().normalized());
  };
  return direction(a).dot(direction(b)) > std::cos(from_deg(2.0));
}

std::vector<EllipseObservation> distinct(const std::vector<EllipseObservation>& sightings) {
  std::vector<EllipseObservation> kept;
  for (const EllipseObservation& seen : sightings) {
    const bool repeated =
        std::any_of(kept.begin(), kept.end(),
                    [&seen](const EllipseObservation& other) { return same_disc(seen, other); });
    if (is_usable(seen) && !repeated) kept.push_back(seen);
  }
  return kept;
}

/// Where a disc of the given radius stands in the base frame, its range from the longer axis.
Eigen::Vector2d place(const EllipseObservation& seen, double radius, const RigOnGround& on_ground) {
  const Intrinsics& intrinsics = pinhole(seen.shot);
  const Eigen::Vector2d xy = unproject(intrinsics, {seen.ellipse.u, seen.ellipse.v});
  const double depth = radius * std::sqrt(intrinsics.px * intrinsics.py) / seen.ellipse.a;
  const Eigen::Vector3d p_r = on_ground.rig.at(seen.shot.camera).rMc(seen.shot.head) *
                              Eigen::Vector3d(depth * xy.homogeneous());
  return p_r.head<2>();
}

double direction_of(const Eigen::Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

/// The planar pose that takes q_a, q_b (base frame) to p_a, p_b (world): direction from the
/// difference, position from the means.
Pose2 align(const Eigen::Vector2d& q_a, const Eigen::Vector2d& q_b, const Eigen::Vector2d& p_a,
            const Eigen::Vector2d& p_b) {
  const double theta = wrap_angle(direction_of(p_b - p_a) - direction_of(q_b - q_a));
  const Eigen::Vector2d mid_q = 0.5 * (q_a + q_b);
  const Eigen::Vector2d mid_p = 0.5 * (p_a + p_b);
  return {mid_p.x() - std::cos(theta) * mid_q.x() + std::sin(theta) * mid_q.y(),
          mid_p.y() - std::sin(theta) * mid_q.x() - std::cos(theta) * mid_q.y(), theta};
}

MeasurementParams measurement_params(const RelocalizerParams& params) {
  MeasurementParams measurement;
  measurement.sensor = params.sensor;
  measurement.gate_probability = params.gate_probability;
  measurement.centre_floor_px = params.centre_floor_px;
  measurement.size_floor = params.size_floor;
  return measurement;
}

std::vector<EllipseObservation> largest(std::vector<EllipseObservation> sightings) {
  if (sightings.size() <= kPairedSightings) return sightings;
  std::stable_sort(sightings.begin(), sightings.end(),
                   [](const auto& a, const auto& b) { return a.ellipse.a > b.ellipse.a; });
  sightings.resize(kPairedSightings);
  return sightings;
}

bool same_place(const Pose2& a, const Pose2& b) {
  const Eigen::Vector3d apart = difference(a, b);
  return apart.head<2>().norm() < 0.1 && std::abs(apart.z()) < from_deg(2.0);
}

}  // namespace

Relocalizer::Relocalizer(LandmarkMap map, FloorPlan plan, const RigOnGround& on_ground,
                         const RelocalizerParams& params)
    : params_(params),
      model_(std::move(map), on_ground, measurement_params(params), plan),
      plan_(std::move(plan)),
      biases_(look_covariance(params.sensor)) {}

Relocalization Relocalizer::solve(const Sweep& sweep, const PlacePrior& place) const {
  const std::vector<EllipseObservation> sightings = distinct(sweep.sightings);
  auto found = hypotheses(sweep, sightings, seeds(sightings), std::nullopt);
  for (Hypothesis& h : found) h.log_weight += std::log(relative_density(h.fit, place));
  return weighed(std::move(found), sightings.size());
}

Relocalization Relocalizer::confirm(const Sweep& sweep, const Prior& prior) const {
  const std::vector<EllipseObservation> sightings = distinct(sweep.sightings);
  auto found = hypotheses(sweep, sightings, {prior.pose}, prior);
  if (found.empty()) return {};
  const auto shown = static_cast<int>(landmarks_of(found.front().matches).size());
  if (found.front().missed >= shown) return {};
  return weighed(std::move(found), sightings.size());
}

std::vector<Relocalizer::Hypothesis> Relocalizer::hypotheses(
    const Sweep& sweep, const std::vector<EllipseObservation>& sightings,
    const std::vector<Pose2>& seeds, const std::optional<Prior>& prior) const {
  std::vector<Hypothesis> found;
  for (const Pose2& seed : seeds) {
    const bool known = std::any_of(found.begin(), found.end(), [&seed](const Hypothesis& h) {
      return same_place(h.fit.pose, seed);
    });
    if (known) continue;
    auto candidate = hypothesis(seed, sweep, sightings, prior);
    if (!candidate) continue;
    const auto twin = std::find_if(found.begin(), found.end(), [&candidate](const Hypothesis& h) {
      return same_place(h.fit.pose, candidate->fit.pose);
    });
    if (twin == found.end())
      found.push_back(std::move(*candidate));
    else if (candidate->log_weight > twin->log_weight)
      *twin = std::move(*candidate);
  }
  return found;
}

double Relocalizer::relative_density(const Fit& fit, const PlacePrior& place) const {
  constexpr double kMinArea_m2 = 1.0;
  const double area = std::max(kMinArea_m2, polygon_area(plan_.outline()));
  const double anywhere = 1.0 / (area * 2.0 * kPi);
  double elsewhere = 1.0;
  double density = 0.0;
  for (const PoseHypothesis& component : place.components) {
    const Eigen::Matrix3d S = component.covariance + fit.covariance;
    const Eigen::Vector3d e = difference(fit.pose, component.pose);
    const double norm = std::sqrt(std::pow(2.0 * kPi, 3) * S.determinant());
    density += component.weight * std::exp(-0.5 * e.dot(S.llt().solve(e))) / norm;
    elsewhere -= component.weight;
  }
  constexpr double kNotImpossible = 1e-6;
  return std::max(elsewhere, kNotImpossible) + density / anywhere;
}

Relocalization Relocalizer::weighed(std::vector<Hypothesis> found, std::size_t sightings) const {
  if (found.empty()) return {};
  std::stable_sort(found.begin(), found.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.log_weight > b.log_weight;
  });
  double sum = 0.0;
  for (const Hypothesis& h : found) sum += std::exp(h.log_weight - found.front().log_weight);
  Relocalization result;
  for (const Hypothesis& h : found) {
    const double weight = std::exp(h.log_weight - found.front().log_weight) / sum;
    result.hypotheses.push_back({h.fit.pose, h.fit.covariance, weight});
  }
  const auto explained = static_cast<double>(found.front().matches.size());
  const bool sure = result.hypotheses.front().weight >= params_.found_weight &&
                    explained >= params_.explained_share * static_cast<double>(sightings);
  result.status = sure ? RelocalizationStatus::found : RelocalizationStatus::ambiguous;
  return result;
}

std::vector<Pose2> Relocalizer::seeds(const std::vector<EllipseObservation>& all) const {
  const std::vector<EllipseObservation> sightings = largest(all);
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    for (std::size_t j = i + 1; j < sightings.size(); ++j) {
      for (const Landmark& k : model_.map().all()) {
        for (const Landmark& l : model_.map().all()) {
          if (k.id == l.id || !disc_radius(k) || !disc_radius(l)) continue;
          const Eigen::Vector2d q_i = place(sightings[i], *disc_radius(k), model_.on_ground());
          const Eigen::Vector2d q_j = place(sightings[j], *disc_radius(l), model_.on_ground());
          const Eigen::Vector2d p_k = k.centre_w().head<2>();
          const Eigen::Vector2d p_l = l.centre_w().head<2>();
          const double tolerance =
              kPlaceTolerance_m + kPlaceToleranceShare * (q_i.norm() + q_j.norm());
          if (std::abs((q_j - q_i).norm() - (p_l - p_k).norm()) < tolerance)
            poses.push_back(align(q_i, q_j, p_k, p_l));
        }
      }
    }
  }
  return best_supported(std::move(poses), all);
}

/// Pairs that fit in distance alone grow with the square of sightings and of landmarks; a look at
/// where the other sightings stand from there sorts most of them out.
std::vector<Pose2> Relocalizer::best_supported(
    std::vector<Pose2> poses, const std::vector<EllipseObservation>& sightings) const {
  if (poses.size() <= kMaxSeeds) return poses;
  const std::vector<DiscPlace> places = possible_places(sightings);
  std::vector<std::pair<int, std::size_t>> order;
  order.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    order.emplace_back(-supporters(poses[i], places), i);
  std::sort(order.begin(), order.end());
  std::vector<Pose2> chosen;
  for (const auto& [support, i] : order) {
    const Pose2& pose = poses[i];
    const bool known = std::any_of(chosen.begin(), chosen.end(),
                                   [&](const Pose2& other) { return same_place(other, pose); });
    if (!known) chosen.push_back(pose);
    if (chosen.size() == kChosenSeeds) break;
  }
  return chosen;
}

std::vector<Relocalizer::DiscPlace> Relocalizer::possible_places(
    const std::vector<EllipseObservation>& sightings) const {
  std::vector<DiscPlace> places;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    for (const Landmark& landmark : model_.map().all()) {
      if (const auto radius = disc_radius(landmark))
        places.push_back(
            {i, place(sightings[i], *radius, model_.on_ground()), landmark.centre_w().head<2>()});
    }
  }
  return places;
}

int Relocalizer::supporters(const Pose2& pose, const std::vector<DiscPlace>& places) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(pose.theta).toRotationMatrix();
  constexpr auto kNone = static_cast<std::size_t>(-1);
  std::size_t counted = kNone;
  int count = 0;
  for (const DiscPlace& at : places) {
    if (at.sighting == counted) continue;
    const double tolerance = kPlaceTolerance_m + kPlaceToleranceShare * at.p_r.norm();
    const Eigen::Vector2d off = pose.position() + turn * at.p_r - at.landmark_w;
    if (off.squaredNorm() > tolerance * tolerance) continue;
    counted = at.sighting;
    ++count;
  }
  return count;
}

/// What a sighting of the landmark says about the pose, the biases of its look at zero.
std::optional<Linearised<3>> Relocalizer::linearised(const Sighting& match,
                                                     const Pose2& pose) const {
  const auto disc = localization::match(model_, *match.sighting, *match.landmark);
  return disc ? linearise(model_, *disc, state_vector(pose)) : std::nullopt;
}

std::optional<Relocalizer::Fit> Relocalizer::refine(const Pose2& start,
                                                    const std::vector<Sighting>& matches,
                                                    const std::optional<Prior>& prior) const {
  Fit fit;
  fit.pose = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    fit.chi2 = 0.0;
    if (prior) {
      information = prior->covariance.inverse();
      const Eigen::Vector3d e = difference(prior->pose, fit.pose);
      gradient = information * e;
      fit.chi2 = e.dot(gradient);
    }
    for (const Sighting& match : matches) {
      const auto seen = linearised(match, fit.pose);
      if (!seen) return std::nullopt;
      const auto factor = marginal_covariance(*seen, biases_).llt();
      const Eigen::Matrix3d J = pose_jacobian(*seen);
      const Eigen::Matrix3d weighted = factor.solve(J);
      information += J.transpose() * weighted;
      gradient += weighted.transpose() * seen->y;
      fit.chi2 += seen->y.dot(factor.solve(seen->y));
    }
    const auto factor = information.ldlt();
    const Eigen::Vector3d move = factor.solve(gradient);
    if (!move.allFinite()) return std::nullopt;
    fit.covariance = factor.solve(Eigen::Matrix3d::Identity());
    if (move.cwiseAbs().maxCoeff() < 1e-6) return fit;
    fit.pose = Pose2::from_vector(fit.pose.vector() + move);
  }
  return std::nullopt;
}

bool Relocalizer::plausible(const Sighting& match, const Pose2& pose) const {
  const Shot& shot = match.sighting->shot;
  const Eigen::Isometry3d wMc = model_.on_ground().wMc(shot.camera, shot.head, pose);
  if (!plan_.line_of_sight(wMc.translation(), match.landmark->centre_w())) return false;
  const auto image = disc_image(*match.landmark, pinhole(shot), wMc);
  if (!image) return false;
  const Ellipse& seen = match.sighting->ellipse;
  return std::abs(image->b / image->a - seen.b / seen.a) < params_.aspect_tolerance;
}

std::vector<Relocalizer::Sighting> Relocalizer::explain(
    const Fit& fit, const std::vector<EllipseObservation>& sightings) const {
  std::vector<Sighting> matches;
  for (const EllipseObservation& seen : sightings) {
    Sighting best{&seen, nullptr};
    double min_nis = model_.gate(3);
    for (const Landmark& landmark : model_.map().all()) {
      const auto image = linearised({&seen, &landmark}, fit.pose);
      if (!image) continue;
      const Eigen::Matrix3d J = pose_jacobian(*image);
      const Eigen::Matrix3d S =
          marginal_covariance(*image, biases_) + J * fit.covariance * J.transpose();
      const double nis = image->y.dot(S.llt().solve(image->y));
      if (nis > min_nis || !plausible({&seen, &landmark}, fit.pose)) continue;
      min_nis = nis;
      best.landmark = &landmark;
    }
    if (best.landmark != nullptr) matches.push_back(best);
  }
  return matches;
}

bool Relocalizer::should_be_seen(const Landmark& landmark, const Pose2& pose,
                                 const Shot& view) const {
  const Eigen::Isometry3d wMc = model_.on_ground().wMc(view.camera, view.head, pose);
  const auto image = disc_image(landmark, pinhole(view), wMc);
  if (!image || image->a < params_.min_radius_px) return false;
  const double margin = 2.0 * image->a;
  if (!in_image(pinhole(view), {image->u, image->v}, margin)) return false;
  const Eigen::Vector3d line = wMc.translation() - landmark.centre_w();
  const double cosine = line.normalized().dot(landmark.normal_w());
  return line.norm() <= params_.max_range_m &&
         cosine >= std::cos(from_deg(params_.max_view_angle_deg)) &&
         plan_.line_of_sight(wMc.translation(), landmark.centre_w());
}

std::set<LandmarkId> Relocalizer::landmarks_of(const std::vector<Sighting>& matches) {
  std::set<LandmarkId> ids;
  for (const Sighting& match : matches) ids.insert(match.landmark->id);
  return ids;
}

int Relocalizer::missed(const Hypothesis& hypothesis, const Sweep& sweep) const {
  const std::set<LandmarkId> seen = landmarks_of(hypothesis.matches);
  return static_cast<int>(std::count_if(
      model_.map().all().begin(), model_.map().all().end(), [&](const Landmark& landmark) {
        return seen.count(landmark.id) == 0 &&
               std::any_of(sweep.views.begin(), sweep.views.end(), [&](const Shot& view) {
                 return should_be_seen(landmark, hypothesis.fit.pose, view);
               });
      }));
}

std::optional<Relocalizer::Hypothesis> Relocalizer::hypothesis(
    const Pose2& seed, const Sweep& sweep, const std::vector<EllipseObservation>& sightings,
    const std::optional<Prior>& prior) const {
  if (plan_.clearance(seed.position()) < params_.min_clearance_m - 3.0 * kSeedSigma.x())
    return std::nullopt;
  Hypothesis h;
  h.fit.pose = seed;
  h.fit.covariance = kSeedSigma.cwiseAbs2().asDiagonal();
  // The first pass takes what the rough pose explains, the second what the refined one does.
  for (int pass = 0; pass < 2; ++pass) {
    h.matches = explain(h.fit, sightings);
    if (landmarks_of(h.matches).size() < (prior ? 1U : 2U)) return std::nullopt;
    const auto fit = refine(h.fit.pose, h.matches, prior);
    if (!fit) return std::nullopt;
    h.fit = *fit;
  }
  const double dof = 3.0 * static_cast<double>(h.matches.size()) - (prior ? 0.0 : 3.0);
  if (h.fit.chi2 > chi_square_quantile(1.0 - kImpossible, dof)) return std::nullopt;
  if (plan_.clearance(h.fit.pose.position()) < params_.min_clearance_m) return std::nullopt;
  const auto unexplained = static_cast<double>(sightings.size() - h.matches.size());
  h.missed = missed(h, sweep);
  h.log_weight = -0.5 * h.fit.chi2 - params_.clutter_cost * unexplained +
                 std::log(1.0 - params_.detection_probability) * h.missed;
  return h;
}

}  // namespace vigia::localization
