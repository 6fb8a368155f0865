#include "vigia/servo/gaze_controller.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/belief_on_ground.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/servo/slew_law.hpp"

namespace vigia::servo {
namespace {

/// A point of the base frame, seen from where the base will be after @p seconds at constant rates.
/// Half of the smaller side of the image, px.
double half_image(const Intrinsics& intrinsics) {
  return 0.5 * std::min(intrinsics.width, intrinsics.height);
}

double largest(const HeadAngles& aim, const HeadAngles& head) {
  return std::max(std::abs(aim.pan - head.pan), std::abs(aim.tilt - head.tilt));
}

}  // namespace

std::string_view to_string(GazeEvent event) {
  switch (event) {
    case GazeEvent::none:
      return "none";
    case GazeEvent::acquired:
      return "acquired";
    case GazeEvent::released:
      return "released";
    case GazeEvent::lost:
      return "lost";
    case GazeEvent::expired:
      return "expired";
  }
  return "";
}

GazeController::GazeController(HeadGeometry geometry, HeadLimits limits, ZoomCalibration zoom,
                               GazeParams params, const Ground& ground)
    : geometry_(std::move(geometry)),
      limits_(limits),
      zoom_(std::move(zoom)),
      params_(params),
      ground_(ground),
      servo_(geometry_, params_.servo),
      zoom_control_(params_.zoom) {}

void GazeController::order(const GazeOrder& order) {
  order_ = order;
  state_ = GazeState::slew;
  state_since_.reset();
  seen_at_r_.reset();
  zoom_control_ = ZoomControl(params_.zoom);
}

void GazeController::cancel() {
  finish(GazeEvent::none);
}

GazeOutput GazeController::finish(GazeEvent event) {
  order_.reset();
  state_ = GazeState::idle;
  seen_at_r_.reset();
  GazeOutput output;
  output.event = event;
  return output;
}

void GazeController::enter(GazeState state, Stamp now) {
  state_ = state;
  state_since_ = now;
}

GazeOutput GazeController::step(const GazeInput& input) {
  carry_target(input);
  if (!order_) return rest(input);
  const Landmark* landmark = input.landmarks.find(order_->landmark);
  if (landmark == nullptr) return finish(GazeEvent::expired);
  if (!state_since_) state_since_ = input.now;

  const bool asked = state_ != GazeState::slew;
  if (asked && input.sighting) return track(input, *landmark);

  const Aim aim = aim_for(input, *landmark);
  if (state_ == GazeState::track) return miss(input, aim);
  if (input.now >= order_->expires) return finish(GazeEvent::expired);
  if (state_ == GazeState::slew) return slew(input, aim);
  if (state_ == GazeState::search) return search(input, *landmark, aim);
  return hold(input, aim);
}

/// Where the landmark was seen, as the base moves on.
void GazeController::carry_target(const GazeInput& input) {
  if (seen_at_r_ && last_step_)
    seen_at_r_ = after_motion(*seen_at_r_, input, (input.now - *last_step_).seconds());
  last_step_ = input.now;
}

Eigen::Vector3d GazeController::landmark_in_base(const GazeInput& input,
                                                 const Landmark& landmark) const {
  // What the camera saw is nearer to the truth than what the belief says.
  if (seen_at_r_) return *seen_at_r_;
  return believed_wMr(input.belief, ground_).inverse() * landmark.centre_w();
}

/// Where a point of the base frame is in it when the base has run on.
Eigen::Vector3d GazeController::after_motion(const Eigen::Vector3d& p_r, const GazeInput& input,
                                             double seconds) const {
  const auto arc = arc_increment(input.base, Stamp{}, Stamp::from_seconds(seconds));
  if (ground_.flat()) return to_isometry(move(Pose2{}, arc)).inverse() * p_r;
  const Pose2& here = input.belief.pose;
  return ground_.place(move(here, arc)).inverse() * (ground_.place(here) * p_r);
}

/// What the ground's shape adds to the base's rates.
BaseTwist GazeController::rolling(const GazeInput& input) const {
  if (ground_.flat()) return BaseTwist::Zero();
  const Pose2& here = input.belief.pose;
  const Eigen::Vector2d ahead = unit_vector(here.theta);
  const Eigen::Vector2d run =
      input.base.v * ahead + input.base.vy * Eigen::Vector2d(-ahead.y(), ahead.x());
  const BaseTwist in_world =
      ground_.dplace_dpose(here) * Eigen::Vector3d(run.x(), run.y(), input.base.w);
  const Eigen::Matrix3d rRw = ground_.place(here).linear().transpose();
  BaseTwist twist;
  twist << rRw * in_world.head<3>() - Eigen::Vector3d(input.base.v, input.base.vy, 0.0),
      rRw * in_world.tail<3>() - Eigen::Vector3d(0.0, 0.0, input.base.w);
  // Within a patch nothing but rounding is left.
  return twist.norm() > 1e-9 ? twist : BaseTwist::Zero();
}

/// The same direction within the head's range: the pan nearest to where the head is, and never
/// through the stop; the end of the range for what lies beyond it.
HeadAngles GazeController::reachable(const HeadAngles& aim, const HeadAngles& from) const {
  HeadAngles result;
  result.pan = std::clamp(aim.pan, limits_.pan_min, limits_.pan_max);
  double best = std::abs(result.pan - aim.pan) > 1e-9 ? 1e9 : std::abs(result.pan - from.pan);
  for (const double pan : {aim.pan - 2.0 * kPi, aim.pan + 2.0 * kPi}) {
    if (pan < limits_.pan_min || pan > limits_.pan_max) continue;
    if (std::abs(pan - from.pan) >= best) continue;
    best = std::abs(pan - from.pan);
    result.pan = pan;
  }
  result.tilt = std::clamp(aim.tilt, limits_.tilt_min, limits_.tilt_max);
  return result;
}

/// When the slowest of pan, tilt and zoom is there.
double GazeController::arrival_time(const GazeInput& input, const HeadAngles& aim,
                                    double focal_px) const {
  const HeadAngles& head = input.head.angles;
  const double zoom_error = zoom_.zoom_for_focal(focal_px) - input.head.zoom_mm;
  return std::max({slew_time(aim.pan - head.pan, limits_.rate, limits_.acceleration),
                   slew_time(aim.tilt - head.tilt, limits_.rate, limits_.acceleration),
                   std::abs(zoom_error) / limits_.zoom_rate_mm_s});
}

double GazeController::held_radius(double radius_px, const Intrinsics& intrinsics) const {
  if (!active().zoom_mm) return active().radius_px;
  return std::clamp(radius_px, params_.planned_min_px,
                    std::max(params_.planned_max * half_image(intrinsics), params_.planned_min_px));
}

GazeOutput GazeController::rest(const GazeInput& input) const {
  GazeOutput output;
  const Landmark* landmark = waiting_ ? input.landmarks.find(waiting_->landmark) : nullptr;
  if (landmark == nullptr) return output;
  const Aim aim = aim_for(input, *landmark);
  output.command = drive(input, aim, aim.intercept, aim.focal_px);
  return output;
}

/// The focal length that is planned or at which the landmark has the ordered size, or the shorter
/// one at which it stays inside the image though belief and head be 3σ off.
double GazeController::wanted_focal(const GazeInput& input, const Landmark& landmark,
                                    const Eigen::Vector3d& p_r) const {
  const Eigen::Vector3d p_h = p_r - geometry_.mount_r;
  const double range = p_h.norm();
  const double radius = extent_radius(landmark);

  // Bearing of the landmark from the head against (x, y, θ) of the base, in the base's axes.
  const double planar2 = std::max(p_h.head<2>().squaredNorm(), 1e-6);
  const Eigen::Vector2d across = Eigen::Vector2d(-p_h.y(), p_h.x()) / planar2;
  const double theta = input.belief.pose.theta;
  const Eigen::Vector2d across_w(std::cos(theta) * across.x() - std::sin(theta) * across.y(),
                                 std::sin(theta) * across.x() + std::cos(theta) * across.y());
  const double lever = across.dot(Eigen::Vector2d(-p_r.y(), p_r.x()));
  const Eigen::RowVector3d bearing(-across_w.x(), -across_w.y(), -lever);
  const double variance = (bearing * input.belief.covariance * bearing.transpose()).value();
  const double sigma = std::hypot(std::sqrt(std::max(variance, 0.0)), params_.look_angle);

  const double planned = active().zoom_mm ? zoom_.at(*active().zoom_mm).px : 0.0;
  const double wanted_px = held_radius(planned * radius / range, input.intrinsics);
  const double by_size = wanted_px * range / radius;
  const double spread = std::tan(std::min(3.0 * sigma, 0.4 * kPi)) + radius / range;
  const double by_field = 0.9 * half_image(input.intrinsics) / spread;
  return std::clamp(std::min(by_size, by_field), zoom_.samples().front().px,
                    zoom_.samples().back().px);
}

GazeController::Aim GazeController::aim_for(const GazeInput& input,
                                            const Landmark& landmark) const {
  Aim aim;
  aim.p_r = landmark_in_base(input, landmark);
  aim.now = reachable(aim_at(geometry_, aim.p_r), input.head.angles);
  // Of the aim, not of where the head is: during a slew the head may have the landmark behind it.
  const Eigen::Vector3d p_c = camera_in_base(geometry_, aim.now).inverse() * aim.p_r;
  if (p_c.z() > 0.0) aim.forward = servo_.compensation(p_c, aim.now, input.base, rolling(input));

  HeadAngles at_arrival = aim.now;
  aim.focal_px = wanted_focal(input, landmark, aim.p_r);
  // The arrival depends on the aim and the aim on the arrival; the second round changes little.
  for (int round = 0; round < 2; ++round) {
    const double ahead =
        std::min(arrival_time(input, at_arrival, aim.focal_px), params_.motion_horizon_s);
    const Eigen::Vector3d p_r = after_motion(aim.p_r, input, ahead);
    at_arrival = reachable(aim_at(geometry_, p_r), input.head.angles);
    aim.focal_px = wanted_focal(input, landmark, p_r);
    aim.intercept = {at_arrival.pan - ahead * aim.forward.pan,
                     at_arrival.tilt - ahead * aim.forward.tilt};
  }
  return aim;
}

bool GazeController::out_of_field(const GazeInput& input, const Aim& aim) const {
  return largest(aim.now, input.head.angles) >
         std::atan(half_image(input.intrinsics) / input.intrinsics.px);
}

/// Rates of head and zoom towards a goal, on top of the compensation for the base's motion.
HeadRates GazeController::drive(const GazeInput& input, const Aim& aim, const HeadAngles& goal,
                                double focal_px) const {
  const double tick = params_.servo.hold_s;
  const HeadAngles& head = input.head.angles;
  const SlewLaw law{limits_.rate, limits_.acceleration, params_.aim_gain, tick};
  HeadRates rates;
  rates.angles.pan =
      std::clamp(law.rate_for(goal.pan - head.pan) + aim.forward.pan, -limits_.rate, limits_.rate);
  rates.angles.tilt = std::clamp(law.rate_for(goal.tilt - head.tilt) + aim.forward.tilt,
                                 -limits_.rate, limits_.rate);
  rates.zoom_mm_s = std::clamp((zoom_.zoom_for_focal(focal_px) - input.head.zoom_mm) / tick,
                               -limits_.zoom_rate_mm_s, limits_.zoom_rate_mm_s);
  return rates;
}

GazeOutput GazeController::slew(const GazeInput& input, const Aim& aim) {
  const double focal_now = zoom_.at(input.head.zoom_mm).px;
  const bool aimed = largest(aim.now, input.head.angles) <= from_deg(params_.settle_deg);
  const bool zoomed = std::abs(std::log(focal_now / aim.focal_px)) <= params_.settle_focal;
  if (aimed && zoomed) {
    enter(GazeState::acquire, input.now);
    return hold(input, aim);
  }
  GazeOutput output;
  output.command = drive(input, aim, aim.intercept, aim.focal_px);
  return output;
}

GazeOutput GazeController::hold(const GazeInput& input, const Aim& aim) {
  if (out_of_field(input, aim)) {
    enter(GazeState::slew, input.now);
    return slew(input, aim);
  }
  GazeOutput output;
  output.command = drive(input, aim, aim.now, aim.focal_px);
  output.request = TrackRequest::acquire;
  if ((input.now - *state_since_).seconds() >= params_.acquire_s)
    enter(GazeState::search, input.now);
  return output;
}

GazeOutput GazeController::search(const GazeInput& input, const Landmark& landmark,
                                  const Aim& aim) {
  const double elapsed = (input.now - *state_since_).seconds();
  if (elapsed >= params_.search_s) return finish(GazeEvent::expired);

  const double focal_now = zoom_.at(input.head.zoom_mm).px;
  const double step = from_deg(params_.search_step_deg) * zoom_.samples().front().px / focal_now;
  const HeadAngles offset = spiral(step, elapsed);
  HeadAngles goal = aim.now;
  goal.pan += offset.pan / std::max(std::cos(aim.now.tilt), 0.1);
  goal.tilt += offset.tilt;
  goal.pan = std::clamp(goal.pan, limits_.pan_min, limits_.pan_max);
  goal.tilt = std::clamp(goal.tilt, limits_.tilt_min, limits_.tilt_max);

  const double range = (aim.p_r - geometry_.mount_r).norm();
  const double smallest = params_.search_radius_px * range / extent_radius(landmark);
  GazeOutput output;
  output.command = drive(input, aim, goal, std::min(aim.focal_px, smallest));
  output.request = TrackRequest::acquire;
  return output;
}

GazeOutput GazeController::track(const GazeInput& input, const Landmark& landmark) {
  GazeOutput output;
  last_seen_ = input.now;
  if (state_ != GazeState::track) {
    enter(GazeState::track, input.now);
    zoom_control_ = ZoomControl(params_.zoom);
    output.event = GazeEvent::acquired;
  } else if ((input.now - *state_since_).seconds() >= order_->dwell_s) {
    return finish(GazeEvent::released);
  }

  const Eigen::Isometry3d rMc = camera_in_base(geometry_, input.head.angles);
  const Eigen::Isometry3d rMw = believed_wMr(input.belief, ground_).inverse();
  // However wrong the belief, what is seen is not within the camera.
  const double range = std::max((rMw * landmark.centre_w() - rMc.translation()).norm(), 0.1);
  const Eigen::Vector2d xy = unproject(input.intrinsics, input.sighting->uv);
  const Eigen::Vector3d p_c = range * Eigen::Vector3d(xy.x(), xy.y(), 1.0).normalized();
  seen_at_r_ = rMc * p_c;

  output.command.angles = servo_.rates(input.intrinsics, input.sighting->uv, p_c.z(),
                                       input.head.angles, input.base, rolling(input));
  const double approach = (camera_jacobian_base(geometry_, input.head.angles).row(2) *
                           Eigen::Vector2d(input.base.v, input.base.w))
                              .value() +
                          camera_twist_sideways(rMc)(2) * input.base.vy;
  output.command.zoom_mm_s =
      std::clamp(zoom_control_.rate(zoom_, input.head.zoom_mm, input.sighting->radius_px,
                                    held_radius(input.sighting->radius_px, input.intrinsics),
                                    -approach / p_c.z()),
                 -limits_.zoom_rate_mm_s, limits_.zoom_rate_mm_s);
  output.request = TrackRequest::track;
  return output;
}

/// Tracked, but not seen in this frame.
GazeOutput GazeController::miss(const GazeInput& input, const Aim& aim) {
  if ((input.now - *state_since_).seconds() >= order_->dwell_s) return finish(GazeEvent::released);
  GazeOutput output;
  output.command = drive(input, aim, aim.now, zoom_.at(input.head.zoom_mm).px);
  output.request = TrackRequest::track;
  if ((input.now - last_seen_).seconds() >= params_.lost_grace_s) {
    enter(GazeState::lost, input.now);
    output.request = TrackRequest::acquire;
    output.event = GazeEvent::lost;
  }
  return output;
}

}  // namespace vigia::servo
