#include "vigia/localization/bearing_only.hpp"

#include "lost_probability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vigia/core/overloaded.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {
namespace {

constexpr int kTriples = 10;  // of looks that a search begins from
constexpr int kRefinements = 10;
constexpr double kMaxStep_m = 5.0;         // a refinement that goes farther diverges
constexpr double kSearchConverged = 1e-4;  // m, rad
constexpr std::size_t kMinLandmarks = 3;   // that a pose must explain
constexpr double kUnlikely = 1e-4;         // a pose less likely than this explains nothing

MeasurementParams measurement_params(const BearingOnlyParams& params) {
  MeasurementParams measurement;
  measurement.sensor = params.sensor;
  measurement.gate_probability = params.gate_probability;
  measurement.ambiguity_ratio = params.ambiguity_ratio;
  measurement.centre_floor_px = 0.1;
  measurement.size_floor = 2e-3;
  return measurement;
}

Eigen::Rotation2Dd turn(double angle) {
  return Eigen::Rotation2Dd(angle);
}

/// The increment as a pose of the robot after it in the frame of the robot before it.
Pose2 step_of(const OdometryIncrement& u) {
  return move({}, u);
}

/// A line of sight and the landmark that it may show.
struct Bearing {
  Eigen::Vector2d eye_r = Eigen::Vector2d::Zero();
  Eigen::Vector2d u_r = Eigen::Vector2d::UnitX();
  Eigen::Vector2d landmark = Eigen::Vector2d::Zero();
};

/// The poses from which three landmarks lie on three lines of sight: none, one or two. With
/// z = (cos θ, sin θ, q), q = −Rᵀ p, each line reads (Rᵀ p_l + q − e) × u = 0, linear in z.
std::vector<Pose2> resect(const std::array<Bearing, 3>& bearings) {
  Eigen::Matrix<double, 3, 4> A;
  Eigen::Vector3d b;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Bearing& line = bearings[static_cast<std::size_t>(i)];
    A.row(i) << cross(line.landmark, line.u_r), line.landmark.dot(line.u_r), line.u_r.y(),
        -line.u_r.x();
    b(i) = cross(line.eye_r, line.u_r);
  }
  const Eigen::FullPivLU<Eigen::Matrix<double, 3, 4>> factor(A);
  if (factor.dimensionOfKernel() != 1) return {};
  const Eigen::Vector4d z0 = factor.solve(b);
  const Eigen::Vector4d n = factor.kernel();
  // |(z0 + λ n) head| = 1
  const double quadratic = n.head<2>().squaredNorm();
  const double half_linear = z0.head<2>().dot(n.head<2>());
  const double discriminant =
      half_linear * half_linear - quadratic * (z0.head<2>().squaredNorm() - 1.0);
  if (!(quadratic > 1e-12) || discriminant < 0.0) return {};
  std::vector<Pose2> poses;
  for (const double sign : {-1.0, 1.0}) {
    const Eigen::Vector4d z = z0 + (sign * std::sqrt(discriminant) - half_linear) / quadratic * n;
    const double theta = std::atan2(z(1), z(0));
    const Eigen::Vector2d p = turn(theta) * Eigen::Vector2d(-z.tail<2>());
    poses.push_back({p.x(), p.y(), theta});
  }
  return poses;
}

/// The landmark of those that say who they are.
std::optional<LandmarkId> named_landmark(const Observation& observation) {
  const auto* seen = std::get_if<PointsObservation>(&observation);
  return seen == nullptr ? std::nullopt : std::optional(seen->landmark);
}

/// How far the middle of the landmark's image lies from the image of its centre, px, seen from wMc:
/// the perspective of a disc or a square, degrees from half a metre away. Nothing without an image.
std::optional<Eigen::Vector2d> centre_shift(const Observation& observation,
                                            const Landmark& landmark,
                                            const Eigen::Isometry3d& wMc) {
  const Shot& shot = shot_of(observation);
  const Eigen::Isometry3d cMl = wMc.inverse() * landmark.wMl;
  const auto centre = project(shot.model, cMl.translation());
  if (!centre) return std::nullopt;
  const auto seen_image = landmark_image(observation);
  if (!seen_image) return std::nullopt;
  return std::visit(
      Overloaded{[&](const EllipseObservation*) -> std::optional<Eigen::Vector2d> {
                   const auto image = disc_image(landmark, pinhole(shot), wMc);
                   if (!image) return std::nullopt;
                   return Eigen::Vector2d(Eigen::Vector2d(image->u, image->v) - *centre);
                 },
                 [&](const PointsObservation* seen) -> std::optional<Eigen::Vector2d> {
                   PointsObservation predicted = *seen;
                   predicted.points.clear();
                   for (const SeenPoint& point : seen_points(landmark, *seen)) {
                     const auto image = predict_point(point.point, pinhole(shot), cMl);
                     if (!image) return std::nullopt;
                     predicted.points.push_back(
                         {point.point.label, image->uv, Eigen::Matrix2d::Identity()});
                   }
                   return Eigen::Vector2d(image_extent(predicted).centre - *centre);
                 }},
      *seen_image);
}

/// The horizontal direction of a pixel in the robot's frame at the exposure, rad.
std::optional<double> bearing_of(const Shot& shot, const Eigen::Vector2d& uv,
                                 const RigOnGround& on_ground) {
  const auto ray_c = ray(shot.model, uv);
  if (!ray_c) return std::nullopt;
  const Eigen::Vector3d ray_r = on_ground.rig.at(shot.camera).rMc(shot.head).linear() * *ray_c;
  return std::atan2(ray_r.y(), ray_r.x());
}

bool same_pose(const Pose2& a, const Pose2& b) {
  const Eigen::Vector3d apart = difference(a, b);
  return apart.head<2>().norm() < 0.2 && std::abs(apart.z()) < from_deg(3.0);
}

/// Three looks and how far apart their directions are.
struct Triple {
  std::array<std::size_t, 3> looks;
  double spread;
};

/// The best spread ones first. @p bearing of a look's index, rad.
template <typename F>
std::vector<Triple> spread_triples(std::size_t looks, const F& bearing) {
  const auto apart = [&](std::size_t a, std::size_t b) {
    return std::abs(std::sin(bearing(a) - bearing(b)));
  };
  std::vector<Triple> triples;
  for (std::size_t i = 0; i < looks; ++i)
    for (std::size_t j = i + 1; j < looks; ++j)
      for (std::size_t k = j + 1; k < looks; ++k)
        triples.push_back({{i, j, k}, std::min({apart(i, j), apart(i, k), apart(j, k)})});
  std::stable_sort(triples.begin(), triples.end(),
                   [](const Triple& a, const Triple& b) { return a.spread > b.spread; });
  if (triples.size() > kTriples) triples.resize(kTriples);
  return triples;
}

}  // namespace

BearingOnlyLocalizer::BearingOnlyLocalizer(const LandmarkMap& map, const RigOnGround& on_ground,
                                           const BearingOnlyParams& params,
                                           std::optional<FloorPlan> plan)
    : model_(map, on_ground, measurement_params(params), std::move(plan)),
      params_(params),
      mean_speed_(params.odometry) {
  reset(Stamp{}, std::nullopt);
}

void BearingOnlyLocalizer::reset(Stamp stamp, const std::optional<Prior>& prior) {
  stamp_ = stamp;
  history_.clear();
  remembered_.clear();
  mean_speed_.reset();
  start(prior.value_or(anywhere()));
  if (!prior) lose();
}

void BearingOnlyLocalizer::start(const Prior& prior) {
  mean_ << prior.pose.vector(), 0.0;
  covariance_.setZero();
  covariance_.topLeftCorner<3, 3>() = prior.covariance;
  begin_look(0);
  lost_ = false;
  rejections_ = 0;
  rejected_spans_.clear();
  remembered_.clear();
  belief_.hypotheses.clear();
  refresh_belief();
}

void BearingOnlyLocalizer::lose() {
  lost_ = true;
  remembered_.clear();
  belief_.hypotheses.clear();
  refresh_belief();
}

void BearingOnlyLocalizer::begin_look(LookId look) {
  look_ = look;
  mean_(3) = 0.0;
  covariance_.row(3).setZero();
  covariance_.col(3).setZero();
  covariance_(3, 3) = params_.sensor.look_angle * params_.sensor.look_angle;
}

void BearingOnlyLocalizer::predict(const OdometryIncrement& increment) {
  const Eigen::Matrix3d Q =
      control_covariance(mean_speed_.at_mean_speed(increment), params_.odometry);
  const Pose2 pose = Pose2::from_vector(mean_.head<3>());
  const auto propagated = [&](const Pose2& at, const Eigen::Matrix3d& P) {
    const Eigen::Matrix3d F = move_jacobian_pose(at, increment);
    const Eigen::Matrix3d G = move_jacobian_control(at, increment);
    return Eigen::Matrix3d(F * P * F.transpose() + G * Q * G.transpose());
  };
  const Eigen::Matrix3d F = move_jacobian_pose(pose, increment);
  covariance_.topLeftCorner<3, 3>() = propagated(pose, covariance_.topLeftCorner<3, 3>());
  covariance_.topRightCorner<3, 1>() = (F * covariance_.topRightCorner<3, 1>()).eval();
  covariance_.bottomLeftCorner<1, 3>() = covariance_.topRightCorner<3, 1>().transpose();
  mean_.head<3>() = move(pose, increment).vector();
  for (PoseHypothesis& hypothesis : belief_.hypotheses) {
    hypothesis.covariance = propagated(hypothesis.pose, hypothesis.covariance);
    hypothesis.pose = move(hypothesis.pose, increment);
  }
  const Pose2 step = step_of(increment);
  const double turn_variance = Q(0, 0) + Q(2, 2);
  for (Sightline& seen : remembered_) {
    seen.eye_r = turn(-step.theta) * (seen.eye_r - step.position());
    seen.bearing = wrap_angle(seen.bearing - step.theta);
    seen.variance += turn_variance;
    seen.position_variance += Q(1, 1) + turn_variance * seen.eye_r.squaredNorm();
  }
  stamp_ = increment.to;
  history_.push_back(increment);
  const Stamp oldest = stamp_ - Duration::from_seconds(params_.history_s);
  while (history_.front().to < oldest) history_.pop_front();
  refresh_belief();
}

/// The direction of the landmark's image, carried from the exposure to the present robot frame.
std::optional<BearingOnlyLocalizer::Sightline> BearingOnlyLocalizer::sightline(
    const Observation& observation) const {
  const Shot& shot = shot_of(observation);
  const auto bearing = bearing_of(shot, image_extent(observation).centre, model_.on_ground());
  if (!bearing) return std::nullopt;
  const Eigen::Isometry3d rMc = model_.on_ground().rig.at(shot.camera).rMc(shot.head);
  Sightline seen;
  seen.span = span_of(shot, model_.on_ground().rig);
  seen.landmark = named_landmark(observation);
  seen.eye_r = rMc.translation().head<2>();
  seen.height_m = rMc.translation().z();
  seen.bearing = *bearing;
  const double reading = params_.sensor.reading_angle;
  seen.variance = params_.bearing_floor * params_.bearing_floor + reading * reading;
  for (const OdometryIncrement& u : history_) {
    if (u.to <= shot.stamp) continue;
    const Pose2 step = step_of(u);
    seen.eye_r = turn(-step.theta) * (seen.eye_r - step.position());
    seen.bearing = wrap_angle(seen.bearing - step.theta);
  }
  return seen;
}

UpdateResult BearingOnlyLocalizer::update(const Observation& observation) {
  const auto image = landmark_image(observation);
  if (!image) return {};
  const Shot& shot = shot_of(observation);
  const bool usable = std::visit([](const auto* seen) { return is_usable(*seen); }, *image);
  if (!usable) return {UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  if (shot.stamp < stamp_ - Duration::from_seconds(params_.history_s))
    return {UpdateStatus::too_late, std::nullopt, 0.0, 0};
  const auto seen = sightline(observation);
  if (!seen) return {UpdateStatus::degenerate, std::nullopt, 0.0, 0};
  if (lost_) {
    remember(*seen);
    const UpdateStatus status = lost_ ? UpdateStatus::ambiguous : UpdateStatus::fused;
    return {status, seen->landmark, 0.0, 0};
  }
  const UpdateResult result = fuse(observation, *seen);
  monitor(result, span_of(shot, model_.on_ground().rig));
  refresh_belief();
  return result;
}

/// The state as the association wants it, at the exposure; tilt and focal length as known a priori.
LookState BearingOnlyLocalizer::look_state(const Shot& shot) const {
  Pose2 pose = Pose2::from_vector(mean_.head<3>());
  for (auto u = history_.rbegin(); u != history_.rend() && u->to > shot.stamp; ++u)
    pose = compose(pose, inverse(step_of(*u)));
  LookState state = localization::begin_look(initial_state(shot.stamp, {}, params_.sensor),
                                             shot.look, params_.sensor);
  state.mean.head<4>() << pose.vector(), mean_(3);
  state.covariance.topLeftCorner<4, 4>() = covariance_;
  return state;
}

BearingOnlyLocalizer::Residual BearingOnlyLocalizer::residual(const Sightline& seen,
                                                              const Landmark& landmark) const {
  const Eigen::Rotation2Dd wRr = turn(mean_(2));
  const Eigen::Vector2d arm = wRr * seen.eye_r;
  const Eigen::Vector2d u = unit_vector(mean_(2) + seen.bearing + mean_(3));
  const Eigen::Vector2d a = in_plan(landmark) - mean_.head<2>() - arm;
  const double range = a.dot(u);
  const Eigen::Vector2d arm_by_turn(-arm.y(), arm.x());
  Eigen::Matrix<double, 2, 4> de_dx = Eigen::Matrix<double, 2, 4>::Zero();
  de_dx.leftCols<2>().setIdentity();
  de_dx.col(2) = arm_by_turn;
  const Eigen::RowVector4d along = u.transpose() * de_dx;  // ∂(e·u)/∂x
  const Eigen::RowVector4d by_direction(0.0, 0.0, 1.0, 1.0);
  Residual residual;
  // d = (p_l − e) × u: −e × u by the position, range by the direction.
  residual.H = -Eigen::RowVector2d(u.y(), -u.x()) * de_dx + range * by_direction;
  const double P_uu = along * covariance_ * along.transpose();
  const double P_ff = by_direction * covariance_ * by_direction.transpose();
  const double P_uf = along * covariance_ * by_direction.transpose();
  residual.d = cross(a, u) - P_uf;
  residual.variance = seen.variance * (range * range + P_uu) + P_uu * P_ff + P_uf * P_uf;
  return residual;
}

UpdateResult BearingOnlyLocalizer::fuse(const Observation& observation, const Sightline& seen) {
  const Shot& shot = shot_of(observation);
  if (shot.look != look_ && model_.has_look_biases(shot.camera)) begin_look(shot.look);
  const LookState state = look_state(shot);
  const Association found = model_.associate(observation, state);
  if (!found.match) return found.result;
  const Landmark& landmark = *model_.map().find(*found.result.landmark);
  const RigOnGround& on_ground = model_.on_ground();
  const HeadAngles head{shot.head.pan + mean_(3), shot.head.tilt};
  const auto shift =
      centre_shift(observation, landmark, on_ground.wMc(shot.camera, head, state.pose()));
  if (!shift) return {UpdateStatus::degenerate, landmark.id, 0.0, 0};
  // The direction of the landmark's centre, not of its image's.
  const Eigen::Vector2d middle = image_extent(observation).centre;
  const auto centre_bearing = bearing_of(shot, middle - *shift, on_ground);
  const auto middle_bearing = bearing_of(shot, middle, on_ground);
  if (!centre_bearing || !middle_bearing) return {UpdateStatus::degenerate, landmark.id, 0.0, 0};
  Sightline of_centre = seen;
  of_centre.bearing += wrap_angle(*centre_bearing - *middle_bearing);
  const Residual about = residual(of_centre, landmark);
  const Eigen::Vector4d PHt = covariance_ * about.H.transpose();
  const double S = about.H * PHt + about.variance;
  const double nis = about.d * about.d / S;
  if (nis > model_.gate(1)) return {UpdateStatus::gated, landmark.id, nis, 1};
  const Eigen::Vector4d K = PHt / S;
  mean_ -= K * about.d;
  mean_(2) = wrap_angle(mean_(2));
  const Eigen::Matrix4d I_KH = Eigen::Matrix4d::Identity() - K * about.H;
  const Eigen::Matrix4d updated =
      I_KH * covariance_ * I_KH.transpose() + K * about.variance * K.transpose();
  covariance_ = 0.5 * (updated + updated.transpose());
  return {UpdateStatus::fused, landmark.id, nis, 1};
}

void BearingOnlyLocalizer::monitor(const UpdateResult& result, const ImageSpan& span) {
  if (result.status == UpdateStatus::gated || result.status == UpdateStatus::degenerate) {
    ++rejections_;
    rejected_spans_.insert(span);
  }
  if (result.status == UpdateStatus::fused) {
    rejections_ = 0;
    rejected_spans_.clear();
  }
  if (rejections_ >= params_.lost_rejections &&
      rejected_spans_.size() >= static_cast<std::size_t>(params_.lost_looks))
    lose();
}

void BearingOnlyLocalizer::remember(const Sightline& seen) {
  // One direction of a look counts: its images share their error.
  const bool known = std::any_of(remembered_.begin(), remembered_.end(),
                                 [&](const Sightline& other) { return other.span == seen.span; });
  if (known) return;
  remembered_.push_back(seen);
  remembered_.back().variance += params_.sensor.look_angle * params_.sensor.look_angle;
  if (remembered_.size() > static_cast<std::size_t>(params_.search_looks)) remembered_.pop_front();
  if (remembered_.size() >= static_cast<std::size_t>(params_.min_looks)) search();
  refresh_belief();
}

Eigen::Vector2d BearingOnlyLocalizer::in_plan(const Landmark& landmark) const {
  return model_.on_ground().ground.in_plan(landmark.centre_w()).head<2>();
}

std::vector<const Landmark*> BearingOnlyLocalizer::candidates_for(const Sightline& seen) const {
  std::vector<const Landmark*> landmarks;
  for (const Landmark& landmark : model_.map().all()) {
    const bool may_be = seen.landmark ? landmark.id == *seen.landmark
                                      : std::holds_alternative<DiscShape>(landmark.shape);
    if (may_be) landmarks.push_back(&landmark);
  }
  return landmarks;
}

bool BearingOnlyLocalizer::in_sight(const Landmark& landmark, const Pose2& pose,
                                    const Sightline& seen) const {
  const Eigen::Isometry3d wMr = model_.on_ground().ground.place(pose);
  const Eigen::Vector3d eye_w =
      wMr * Eigen::Vector3d(seen.eye_r.x(), seen.eye_r.y(), seen.height_m);
  const Eigen::Vector3d line = eye_w - landmark.centre_w();
  const Eigen::Vector2d u = unit_vector(pose.theta + seen.bearing);
  return line.norm() < params_.max_range_m && line.dot(landmark.normal_w()) > 0.0 &&
         -line.head<2>().dot(u) > 0.0 && !model_.hides(eye_w, landmark.centre_w());
}

/// The landmark in sight that lies nearest to the line of sight from a pose of covariance @p P, in
/// its gate.
std::optional<BearingOnlyLocalizer::Sighted> BearingOnlyLocalizer::nearest(
    const Sightline& seen, const Pose2& pose, const Eigen::Matrix3d& P) const {
  const Eigen::Vector2d arm = turn(pose.theta) * seen.eye_r;
  const Eigen::Vector2d u = unit_vector(pose.theta + seen.bearing);
  double min_cost = model_.gate(1);
  std::optional<Sighted> best;
  for (const Landmark* landmark : candidates_for(seen)) {
    const Eigen::Vector2d a = in_plan(*landmark) - pose.position() - arm;
    const double range = a.dot(u);
    const double d = cross(a, u);
    const Eigen::RowVector3d H(-u.y(), u.x(), range + arm.dot(u));
    const double R = seen.variance * range * range + seen.position_variance;
    const double cost = d * d / (R + H * P * H.transpose());
    if (cost > min_cost || !in_sight(*landmark, pose, seen)) continue;
    min_cost = cost;
    best = Sighted{landmark->id, d, H, R};
  }
  return best;
}

/// Gauss–Newton on the looks that a landmark in sight explains, found anew at each step.
std::optional<BearingOnlyLocalizer::Candidate> BearingOnlyLocalizer::explain(
    const Pose2& seed) const {
  Candidate found;
  found.pose.pose = seed;
  const Eigen::Vector3d seed_sigma(0.3, 0.3, from_deg(3.0));
  found.pose.covariance = seed_sigma.cwiseAbs2().asDiagonal();
  double chi2 = 0.0;
  for (int step = 0; step < kRefinements; ++step) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    std::set<LandmarkId> landmarks;
    chi2 = 0.0;
    found.explained = 0;
    for (const Sightline& seen : remembered_) {
      const auto best = nearest(seen, found.pose.pose, found.pose.covariance);
      if (!best) continue;
      ++found.explained;
      landmarks.insert(best->landmark);
      information += best->H.transpose() * best->H / best->R;
      gradient -= best->H.transpose() * best->d / best->R;
      chi2 += best->d * best->d / best->R;
    }
    if (landmarks.size() < kMinLandmarks) return std::nullopt;
    const auto factor = information.ldlt();
    const Eigen::Vector3d move = factor.solve(gradient);
    if (!move.allFinite() || move.head<2>().norm() > kMaxStep_m) return std::nullopt;
    found.pose.covariance = factor.solve(Eigen::Matrix3d::Identity());
    found.pose.pose = Pose2::from_vector(found.pose.pose.vector() + move);
    if (move.cwiseAbs().maxCoeff() < kSearchConverged) break;
  }
  const double dof = std::max(1, found.explained - 3);
  if (found.explained < params_.min_looks || chi2 > chi_square_quantile(1.0 - kUnlikely, dof))
    return std::nullopt;
  const auto unexplained = static_cast<double>(remembered_.size()) - found.explained;
  found.log_weight = -0.5 * chi2 - params_.clutter_cost * unexplained;
  return found;
}

/// Every pose from which three landmarks lie on the directions of three looks.
std::vector<Pose2> BearingOnlyLocalizer::seeds() const {
  std::vector<Pose2> poses;
  int tries = 0;
  const auto bearing = [this](std::size_t i) { return remembered_[i].bearing; };
  for (const Triple& triple : spread_triples(remembered_.size(), bearing)) {
    std::array<Bearing, 3> lines;
    std::array<std::vector<const Landmark*>, 3> landmarks;
    for (std::size_t i = 0; i < 3; ++i) {
      const Sightline& seen = remembered_[triple.looks[i]];
      lines[i] = {seen.eye_r, unit_vector(seen.bearing), Eigen::Vector2d::Zero()};
      landmarks[i] = candidates_for(seen);
    }
    for (const Landmark* first : landmarks[0])
      for (const Landmark* second : landmarks[1])
        for (const Landmark* third : landmarks[2]) {
          if (first == second || second == third || third == first) continue;
          if (++tries > params_.max_tries) return poses;
          lines[0].landmark = in_plan(*first);
          lines[1].landmark = in_plan(*second);
          lines[2].landmark = in_plan(*third);
          for (const Pose2& pose : resect(lines)) poses.push_back(pose);
        }
  }
  return poses;
}

void BearingOnlyLocalizer::search() {
  std::vector<Candidate> found;
  const auto known = [&found](const Pose2& pose) {
    return std::any_of(found.begin(), found.end(),
                       [&pose](const Candidate& c) { return same_pose(c.pose.pose, pose); });
  };
  for (const Pose2& seed : seeds()) {
    if (known(seed)) continue;
    const auto candidate = explain(seed);
    if (candidate && !known(candidate->pose.pose)) found.push_back(*candidate);
  }
  belief_.hypotheses.clear();
  if (found.empty()) return;
  std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return a.log_weight > b.log_weight;
  });
  double sum = 0.0;
  for (const Candidate& c : found) sum += std::exp(c.log_weight - found.front().log_weight);
  if (1.0 / sum >= params_.found_weight) {
    start(found.front().pose);
    return;
  }
  for (const Candidate& c : found)
    belief_.hypotheses.push_back(
        {c.pose.pose, c.pose.covariance, std::exp(c.log_weight - found.front().log_weight) / sum});
}

void BearingOnlyLocalizer::refresh_belief() {
  belief_.stamp = stamp_;
  if (lost_ && !belief_.hypotheses.empty()) {
    const PoseHypothesis& best = belief_.hypotheses.front();
    belief_.status = BeliefStatus::ambiguous;
    belief_.pose = best.pose;
    belief_.covariance = best.covariance;
    belief_.lost_probability = 1.0 - best.weight;
    return;
  }
  belief_.pose = Pose2::from_vector(mean_.head<3>());
  belief_.covariance = covariance_.topLeftCorner<3, 3>();
  const bool wide = belief_.position_sigma() > params_.lost_sigma_m;
  belief_.status = lost_ || wide ? BeliefStatus::lost : BeliefStatus::tracking;
  belief_.lost_probability =
      lost_ ? kSaidLost
            : either(probability_of_half_a_metre(belief_.position_sigma()),
                     rejection_probability(rejections_, params_.lost_rejections));
}

}  // namespace vigia::localization
