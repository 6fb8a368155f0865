#include "vigia/localization/relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "vigia/core/line_of_sight.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {
namespace {

constexpr int kMaxSteps = 20;
/// A fit less likely than this is none. Far out: the right pose must not drop out by bad luck and
/// leave the field to a wrong one, and two discs in one look share an error that counts twice here.
constexpr double kImpossible = 1e-6;
/// ln of a weight beside the best that no longer matters.
constexpr double kNegligiblePlace = -14.0;
/// By so many sightings may the support of a rough pose fall short of what the fitted one explains.
constexpr int kSupportSlack = 1;
/// σ of a closed-form pose, as far as the density of a place is concerned.
const Eigen::Vector3d kRoughSigma(0.3, 0.3, from_deg(4.0));

/// Two frames of one look that show the same landmark count once: they share their biases.
bool same_sighting(const Observation& a, const Observation& b) {
  if (shot_of(a).look != shot_of(b).look || a.index() != b.index()) return false;
  const auto* code_a = std::get_if<PointsObservation>(&a);
  const auto* code_b = std::get_if<PointsObservation>(&b);
  if (code_a != nullptr && code_b != nullptr) return code_a->landmark == code_b->landmark;
  const auto direction = [](const Observation& seen) {
    const Shot& shot = shot_of(seen);
    const Eigen::Vector2d xy = unproject(pinhole(shot), image_extent(seen).centre);
    return Eigen::Vector3d(camera_in_base(HeadGeometry{}, shot.head).linear() *
                           xy.homogeneous().normalized());
  };
  return direction(a).dot(direction(b)) > std::cos(from_deg(2.0));
}

bool is_sighting(const Observation& observation) {
  if (const auto* disc = std::get_if<EllipseObservation>(&observation)) return is_usable(*disc);
  if (const auto* code = std::get_if<PointsObservation>(&observation)) return is_usable(*code);
  return false;
}

std::vector<Observation> distinct(const std::vector<Observation>& sightings) {
  std::vector<Observation> kept;
  for (const Observation& seen : sightings) {
    if (!is_sighting(seen)) continue;
    const bool repeated = std::any_of(kept.begin(), kept.end(), [&seen](const Observation& other) {
      return same_sighting(seen, other);
    });
    if (!repeated) kept.push_back(seen);
  }
  return kept;
}

MeasurementParams measurement_params(const RelocalizerParams& params) {
  MeasurementParams measurement;
  measurement.sensor = params.sensor;
  measurement.gate_probability = params.gate_probability;
  measurement.centre_floor_px = params.centre_floor_px;
  measurement.size_floor = params.size_floor;
  return measurement;
}

bool same_place(const Pose2& a, const Pose2& b) {
  const Eigen::Vector3d apart = difference(a, b);
  return apart.head<2>().norm() < 0.1 && std::abs(apart.z()) < from_deg(2.0);
}

/// Numbers that the image measures, beyond those that no pose takes away.
template <int Rows>
int dof_of(const Linearised<Rows>& seen) {
  return seen.rank + std::max(0, seen.scatter_dof);
}

/// Whether one of the landmarks says who it is.
template <typename Explained>
bool is_named(const std::vector<Explained>& explained) {
  return std::any_of(explained.begin(), explained.end(), [](const Explained& one) {
    return std::holds_alternative<PointsMatch>(one.match);
  });
}

/// The landmark as a disc of the size of all that is seen of it.
Landmark outline(const Landmark& landmark) {
  return {landmark.id, landmark.wMl, DiscShape{extent_radius(landmark)}};
}

}  // namespace

Relocalizer::Relocalizer(LandmarkMap map, FloorPlan plan, const RigOnGround& on_ground,
                         const RelocalizerParams& params)
    : params_(params),
      model_(std::move(map), on_ground, measurement_params(params), plan),
      plan_(std::move(plan)),
      candidates_(model_.map(), on_ground),
      biases_(look_covariance(params.sensor)) {}

Relocalizer::Task Relocalizer::task(const Sweep& sweep) const {
  Task task{sweep, distinct(sweep.sightings), {}, {}, std::nullopt, {}, 0};
  task.clues = candidates_.clues(task.sightings);
  return task;
}

Relocalization Relocalizer::solve(const Sweep& sweep, const PlacePrior& place) const {
  Task task = this->task(sweep);
  task.place = place;
  for (const PoseHypothesis& known : place.components) {
    ++task.fits;
    if (auto found = fitted({known.pose, {}, known.covariance}, task))
      take(task, std::move(*found));
  }
  const CandidatePoses candidates = candidates_.search(task.clues, params_.max_pairs);
  Relocalization result;
  result.pairs = candidates.pairs;
  result.complete = candidates.complete;
  try_all(task, candidates, result);
  return weighed(std::move(task), std::move(result));
}

void Relocalizer::try_all(Task& task, const CandidatePoses& candidates,
                          Relocalization& result) const {
  const auto sightings = static_cast<int>(task.clues.size());
  for (const CandidatePose& candidate : candidates.poses) {
    const int unexplained = std::max(0, sightings - candidate.support - kSupportSlack);
    if (!may_weigh(params_.clutter_cost * unexplained, candidate.pose, task)) continue;
    if (is_known(candidate, task.found)) continue;
    if (task.fits == params_.max_fits) {
      result.complete = false;
      return;
    }
    ++task.fits;
    if (auto found = fitted({candidate.pose, candidate.by, {}}, task))
      take(task, std::move(*found));
  }
}

Relocalization Relocalizer::confirm(const Sweep& sweep, const Prior& prior) const {
  Task task = this->task(sweep);
  task.prior = prior;
  task.fits = 1;
  auto found = fitted({prior.pose, {}, prior.covariance}, task);
  if (!found || found->missed >= static_cast<int>(landmarks_of(found->explained))) return {};
  task.found.push_back(std::move(*found));
  return weighed(std::move(task), {});
}

/// Adds it, or puts it in the place of a poorer one that is the same pose.
void Relocalizer::take(Task& task, Hypothesis hypothesis) const {
  const auto twin = std::find_if(
      task.found.begin(), task.found.end(),
      [&hypothesis](const Hypothesis& h) { return same_place(h.fit.pose, hypothesis.fit.pose); });
  if (twin == task.found.end())
    task.found.push_back(std::move(hypothesis));
  else if (hypothesis.log_weight > twin->log_weight)
    *twin = std::move(hypothesis);
}

/// Whether a hypothesis takes the candidate's sightings for the same landmarks: the fit would be
/// the same.
bool Relocalizer::is_known(const CandidatePose& candidate, const std::vector<Hypothesis>& found) {
  if (candidate.by.size() < 2) return false;
  return std::any_of(found.begin(), found.end(), [&candidate](const Hypothesis& h) {
    return std::all_of(candidate.by.begin(), candidate.by.end(), [&h](const Identification& as) {
      return std::any_of(h.explained.begin(), h.explained.end(),
                         [&as](const Explained& other) { return other.as == as; });
    });
  });
}

bool Relocalizer::may_weigh(double unexplained_cost, const Pose2& pose, const Task& task) const {
  if (task.found.empty()) return true;
  const auto best = std::max_element(
      task.found.begin(), task.found.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.log_weight < b.log_weight; });
  Fit rough;
  rough.pose = pose;
  rough.covariance = kRoughSigma.cwiseAbs2().asDiagonal();
  const double density = std::max(0.0, std::log(relative_density(rough, task.place)));
  return density - unexplained_cost > best->log_weight + kNegligiblePlace;
}

double Relocalizer::cost_of(const Clue& clue) const {
  const bool disc = std::holds_alternative<EllipseObservation>(*clue.seen);
  return disc ? params_.clutter_cost : params_.misread_cost;
}

double Relocalizer::unexplained_cost(const std::vector<Explained>& explained,
                                     const Task& task) const {
  double cost = 0.0;
  for (const Clue& clue : task.clues) cost += cost_of(clue);
  for (const Explained& one : explained) cost -= cost_of(task.clues[one.as.clue]);
  return cost;
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

Relocalization Relocalizer::weighed(Task task, Relocalization result) const {
  result.fits = task.fits;
  result.modelled_s =
      1e-6 * (params_.pair_us * static_cast<double>(result.pairs) + params_.fit_us * task.fits);
  std::vector<Hypothesis>& found = task.found;
  if (found.empty()) return result;
  std::stable_sort(found.begin(), found.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.log_weight > b.log_weight;
  });
  double sum = 0.0;
  for (const Hypothesis& h : found) sum += std::exp(h.log_weight - found.front().log_weight);
  for (const Hypothesis& h : found) {
    const double weight = std::exp(h.log_weight - found.front().log_weight) / sum;
    result.hypotheses.push_back({h.fit.pose, h.fit.covariance, weight});
  }
  // Discs may be look-alikes, a pattern's own dots among them; who says who it is, is none.
  const auto explained = static_cast<double>(found.front().explained.size());
  const bool believed =
      is_named(found.front().explained) ||
      explained >= params_.explained_share * static_cast<double>(task.sightings.size());
  const bool sure =
      result.complete && believed && result.hypotheses.front().weight >= params_.found_weight;
  result.status = sure ? RelocalizationStatus::found : RelocalizationStatus::ambiguous;
  return result;
}

std::optional<Relocalizer::Explained> Relocalizer::explained_as(const Identification& as,
                                                                const Task& task) const {
  auto matched = model_.match(*task.clues[as.clue].seen, model_.map().all()[as.landmark]);
  if (!matched) return std::nullopt;
  return Explained{as, std::move(*matched)};
}

/// What the pose of @p start becomes by the sightings that it was made of.
std::optional<Relocalizer::Fit> Relocalizer::first_fit(const Start& start, const Task& task) const {
  if (start.by.empty()) {
    Fit fit;
    fit.pose = start.pose;
    fit.covariance = start.covariance;
    return fit;
  }
  std::vector<Explained> explained;
  for (const Identification& as : start.by) {
    auto one = explained_as(as, task);
    if (!one) return std::nullopt;
    explained.push_back(std::move(*one));
  }
  auto fit = refine(start.pose, explained, std::nullopt);
  if (fit && fit->chi2 > chi_square_quantile(1.0 - kImpossible, fit->dof)) return std::nullopt;
  return fit;
}

std::optional<Relocalizer::Hypothesis> Relocalizer::fitted(const Start& start,
                                                           const Task& task) const {
  const auto first = first_fit(start, task);
  if (!first) return std::nullopt;
  Hypothesis h;
  h.fit = *first;
  // The first pass takes what the rough pose explains, the second what the refined one does.
  for (int pass = 0; pass < 2; ++pass) {
    h.explained = explain(h.fit, task);
    if (h.explained.empty()) return std::nullopt;
    if (landmarks_of(h.explained) < 2 && !is_named(h.explained) && !task.prior) return std::nullopt;
    if (!may_weigh(unexplained_cost(h.explained, task), h.fit.pose, task)) return std::nullopt;
    const auto fit = refine(h.fit.pose, h.explained, task.prior);
    if (!fit) return std::nullopt;
    h.fit = *fit;
  }
  if (h.fit.chi2 > chi_square_quantile(1.0 - kImpossible, h.fit.dof)) return std::nullopt;
  if (plan_.clearance(h.fit.pose.position()) < params_.min_clearance_m) return std::nullopt;
  h.missed = missed(h, task.sweep);
  h.log_weight = -0.5 * h.fit.chi2 - unexplained_cost(h.explained, task) +
                 std::log(1.0 - params_.detection_probability) * h.missed +
                 std::log(relative_density(h.fit, task.place));
  return h;
}

std::optional<Relocalizer::Fit> Relocalizer::refine(const Pose2& start,
                                                    const std::vector<Explained>& explained,
                                                    const std::optional<Prior>& prior) const {
  Fit fit;
  fit.pose = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    fit.chi2 = 0.0;
    fit.dof = -3.0;
    if (prior) {
      information = prior->covariance.inverse();
      const Eigen::Vector3d e = difference(prior->pose, fit.pose);
      gradient = information * e;
      fit.chi2 = e.dot(gradient);
      fit.dof = 0.0;
    }
    const auto add = [&](const auto& seen) {
      const auto factor = marginal_covariance(seen, biases_).llt();
      const auto J = pose_jacobian(seen);
      const auto weighted = factor.solve(J).eval();
      information += J.transpose() * weighted;
      gradient += weighted.transpose() * seen.y;
      fit.chi2 += seen.y.dot(factor.solve(seen.y)) + seen.scatter;
      fit.dof += dof_of(seen);
    };
    for (const Explained& one : explained)
      if (!model_.linearise(one.match, state_vector(fit.pose), add)) return std::nullopt;
    const auto factor = information.ldlt();
    const Eigen::Vector3d move = factor.solve(gradient);
    if (!move.allFinite()) return std::nullopt;
    fit.covariance = factor.solve(Eigen::Matrix3d::Identity());
    if (move.cwiseAbs().maxCoeff() < 1e-6) return fit;
    fit.pose = Pose2::from_vector(fit.pose.vector() + move);
  }
  return std::nullopt;
}

bool Relocalizer::plausible(const Explained& explained, const Clue& clue, const Pose2& pose) const {
  const Landmark& landmark = model_.map().all()[explained.as.landmark];
  const Shot& shot = shot_of(explained.match);
  const Eigen::Isometry3d wMc = model_.on_ground().wMc(shot.camera, shot.head, pose);
  if (!line_of_sight(plan_, model_.on_ground().ground, wMc.translation(), landmark.centre_w()))
    return false;
  if (!disc_radius(landmark)) return true;
  const auto image = disc_image(landmark, pinhole(shot), wMc);
  return image && std::abs(image->b / image->a - clue.aspect) < params_.aspect_tolerance;
}

std::optional<double> Relocalizer::inside_gate(const Explained& explained, const Fit& fit) const {
  std::optional<double> inside;
  model_.linearise(explained.match, state_vector(fit.pose), [&](const auto& seen) {
    const auto J = pose_jacobian(seen);
    const auto S = (marginal_covariance(seen, biases_) + J * fit.covariance * J.transpose()).eval();
    const double nis = seen.y.dot(S.llt().solve(seen.y));
    const bool tidy = seen.scatter_dof <= 0 || seen.scatter <= model_.gate(seen.scatter_dof);
    if (nis <= model_.gate(seen.rank) && tidy) inside = nis;
  });
  return inside;
}

std::vector<Relocalizer::Explained> Relocalizer::explain(const Fit& fit, const Task& task) const {
  constexpr double kSigmas = 4.0;
  const double off_m = kSigmas * std::sqrt(fit.covariance.topLeftCorner<2, 2>().trace());
  const double off_rad = kSigmas * std::sqrt(fit.covariance(2, 2));
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(fit.pose.theta).toRotationMatrix();
  std::vector<Explained> all;
  for (std::size_t i = 0; i < task.clues.size(); ++i) {
    const Clue& clue = task.clues[i];
    std::optional<Explained> best;
    double min_nis = 0.0;
    for (const Clue::Option& option : clue.options) {
      const double range = option.p_r.norm();
      const double reach = PlaceCandidates::tolerance(range) + off_m + off_rad * range;
      const Eigen::Vector2d off =
          fit.pose.position() + turn * option.p_r - candidates_.in_plan(option.landmark);
      if (off.squaredNorm() > reach * reach) continue;
      auto one = explained_as({i, option.landmark}, task);
      const auto nis = one ? inside_gate(*one, fit) : std::nullopt;
      if (!nis || (best && *nis >= min_nis) || !plausible(*one, clue, fit.pose)) continue;
      min_nis = *nis;
      best = std::move(one);
    }
    if (best) all.push_back(std::move(*best));
  }
  return all;
}

bool Relocalizer::should_be_seen(const Landmark& landmark, const Pose2& pose,
                                 const Shot& view) const {
  const Eigen::Isometry3d wMc = model_.on_ground().wMc(view.camera, view.head, pose);
  const Eigen::Vector3d line = wMc.translation() - landmark.centre_w();
  const double cosine = line.normalized().dot(landmark.normal_w());
  if (line.norm() > params_.max_range_m || cosine < std::cos(from_deg(params_.max_view_angle_deg)))
    return false;
  const auto image = disc_image(outline(landmark), pinhole(view), wMc);
  const double least = disc_radius(landmark) ? params_.min_radius_px : params_.min_code_radius_px;
  if (!image || image->a < least) return false;
  const double margin = 2.0 * image->a;
  return in_image(pinhole(view), {image->u, image->v}, margin) &&
         line_of_sight(plan_, model_.on_ground().ground, wMc.translation(), landmark.centre_w());
}

std::size_t Relocalizer::landmarks_of(const std::vector<Explained>& explained) {
  std::set<std::size_t> landmarks;
  for (const Explained& one : explained) landmarks.insert(one.as.landmark);
  return landmarks.size();
}

int Relocalizer::missed(const Hypothesis& hypothesis, const Sweep& sweep) const {
  std::set<std::size_t> seen;
  for (const Explained& one : hypothesis.explained) seen.insert(one.as.landmark);
  constexpr double kCameraOffCentre_m = 1.0;
  const Pose2& pose = hypothesis.fit.pose;
  int missed = 0;
  for (std::size_t i = 0; i < model_.map().all().size(); ++i) {
    const double range = (candidates_.in_plan(i) - pose.position()).norm();
    if (seen.count(i) > 0 || range > params_.max_range_m + kCameraOffCentre_m) continue;
    const Landmark& landmark = model_.map().all()[i];
    if (std::any_of(sweep.views.begin(), sweep.views.end(),
                    [&](const Shot& view) { return should_be_seen(landmark, pose, view); }))
      ++missed;
  }
  return missed;
}

}  // namespace vigia::localization
