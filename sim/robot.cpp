#include "vigia/sim/robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vigia::sim {
namespace {

constexpr double kStepWhileAccelerating = 0.005;  // s

struct AxisStep {
  double rate;
  double distance;
};

/// A rate that runs to its target with bounded acceleration for @p h seconds, exactly.
AxisStep ramp(double rate, double target, double acceleration, double h) {
  const double ramp_s = std::min(h, std::abs(target - rate) / acceleration);
  const double reached =
      ramp_s < h ? target : rate + std::copysign(acceleration * h, target - rate);
  return {reached, 0.5 * (rate + reached) * ramp_s + reached * (h - ramp_s)};
}

/// Moves one angle of the head and stops it at the ends of its range.
void move_axis(double& angle, double& rate, const AxisStep& step, double low, double high) {
  const double wanted = angle + step.distance;
  angle = std::clamp(wanted, low, high);
  const bool stopped = (angle == low && step.rate < 0.0) || (angle == high && step.rate > 0.0);
  rate = stopped ? 0.0 : step.rate;
}

/// An encoder with play follows its axis.
void drag(double& encoder, double axis, double play) {
  encoder = std::clamp(encoder, axis - 0.5 * play, axis + 0.5 * play);
}

Pose2 along_arc(const Pose2& pose, const ArcMotion& motion) {
  const double half = 0.5 * motion.turn;
  const double sinc = std::abs(half) < 1e-6 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  const double c = std::cos(pose.theta + half);
  const double s = std::sin(pose.theta + half);
  const double ahead = motion.distance * sinc;
  const double aside = motion.side * sinc;
  return {pose.x + ahead * c - aside * s, pose.y + ahead * s + aside * c,
          wrap_angle(pose.theta + motion.turn)};
}

double clamp_rate(double rate, double limit) {
  return std::clamp(rate, -limit, limit);
}

Eigen::Matrix<double, 6, 2> head_columns(const HeadGeometry& mount, const HeadAngles& head) {
  return camera_jacobian_head(mount, head);
}

Eigen::Matrix<double, 6, 2> head_columns(const FixedMount& /*mount*/, const HeadAngles& /*head*/) {
  return Eigen::Matrix<double, 6, 2>::Zero();
}

}  // namespace

Robot::Robot(const RobotParams& params, const Pose2& start, double zoom_mm, std::uint64_t seed,
             const Ground& ground)
    : params_(params),
      ground_(ground),
      camera_(params.head),
      zoom_min_mm_(-std::numeric_limits<double>::infinity()),
      zoom_max_mm_(std::numeric_limits<double>::infinity()),
      odometry_pose_(start),
      wheel_pose_(start),
      odometry_random_(seed, "odometry"),
      look_random_(seed, "look"),
      reading_random_(seed, "head reading") {
  truth_.pose = start;
  truth_.zoom_mm = zoom_mm;
  const HeadLimits& limits = params_.head_limits;
  truth_.head.pan = std::clamp(0.0, limits.pan_min, limits.pan_max);
  truth_.head.tilt = std::clamp(0.0, limits.tilt_min, limits.tilt_max);
  encoder_ = truth_.head;
}

void Robot::set_zoom_range(double min_mm, double max_mm) {
  zoom_min_mm_ = min_mm;
  zoom_max_mm_ = max_mm;
  truth_.zoom_mm = std::clamp(truth_.zoom_mm, min_mm, max_mm);
}

void Robot::command(const BaseRates& base, const HeadRates& head) {
  const BaseLimits& limits = params_.base;
  const HeadLimits& head_limits = params_.head_limits;
  base_command_ = {clamp_rate(base.v, limits.speed), clamp_rate(base.w, limits.turn_rate),
                   clamp_rate(base.vy, limits.side_speed)};
  head_command_.angles = {clamp_rate(head.angles.pan, head_limits.rate),
                          clamp_rate(head.angles.tilt, head_limits.rate)};
  head_command_.zoom_mm_s = clamp_rate(head.zoom_mm_s, head_limits.zoom_rate_mm_s);
}

void Robot::advance(Duration dt) {
  double left = dt.seconds();
  while (left > 0.0) {
    const bool steady = truth_.base.v == base_command_.v && truth_.base.w == base_command_.w &&
                        truth_.base.vy == base_command_.vy &&
                        truth_.head_rates.pan == head_command_.angles.pan &&
                        truth_.head_rates.tilt == head_command_.angles.tilt;
    const double h = steady ? left : std::min(left, kStepWhileAccelerating);
    step(h);
    left -= h;
  }
  truth_.stamp = truth_.stamp + dt;
}

void Robot::step(double h) {
  const BaseLimits& base = params_.base;
  const HeadLimits& head = params_.head_limits;

  const AxisStep drive = ramp(truth_.base.v, base_command_.v, base.acceleration, h);
  const AxisStep turn = ramp(truth_.base.w, base_command_.w, base.turn_acceleration, h);
  const AxisStep side = ramp(truth_.base.vy, base_command_.vy, base.side_acceleration, h);
  truth_.base = {drive.rate, turn.rate, side.rate};
  const ArcMotion wheels{drive.distance, turn.distance, side.distance};
  const ArcMotion ground = slip_ ? slip_->over_ground(wheels) : wheels;
  truth_.pose = along_arc(truth_.pose, ground);
  wheel_pose_ = along_arc(wheel_pose_, wheels);
  turned_ += wheels.turn;

  const HeadAngles& rates = truth_.head_rates;
  const AxisStep pan = ramp(rates.pan, head_command_.angles.pan, head.acceleration, h);
  const AxisStep tilt = ramp(rates.tilt, head_command_.angles.tilt, head.acceleration, h);
  move_axis(truth_.head.pan, truth_.head_rates.pan, pan, head.pan_min, head.pan_max);
  move_axis(truth_.head.tilt, truth_.head_rates.tilt, tilt, head.tilt_min, head.tilt_max);
  drag(encoder_.pan, truth_.head.pan, backlash_);
  drag(encoder_.tilt, truth_.head.tilt, backlash_);
  truth_.zoom_mm =
      std::clamp(truth_.zoom_mm + head_command_.zoom_mm_s * h, zoom_min_mm_, zoom_max_mm_);
}

void Robot::begin_look() {
  const SensorNoise& noise = params_.sensor;
  truth_.look_angle_error.pan = noise.look_angle * look_random_.normal();
  truth_.look_angle_error.tilt = noise.look_angle * look_random_.normal();
  truth_.look_log_focal_error = noise.look_focal * look_random_.normal();
}

OdometryIncrement Robot::read_odometry() {
  const auto increment = params_.base.omnidirectional() ? crab_increment : chord_increment;
  OdometryIncrement u =
      increment(odometry_pose_, wheel_pose_, turned_, odometry_stamp_, truth_.stamp);
  const Eigen::Matrix3d covariance = control_covariance(u, params_.odometry);
  u.rot1 += std::sqrt(covariance(0, 0)) * odometry_random_.normal();
  u.trans += std::sqrt(covariance(1, 1)) * odometry_random_.normal();
  u.rot2 += std::sqrt(covariance(2, 2)) * odometry_random_.normal();

  odometry_stamp_ = truth_.stamp;
  odometry_pose_ = wheel_pose_;
  turned_ = 0.0;
  return u;
}

HeadReading Robot::read_head() {
  HeadReading reading;
  const double white = params_.sensor.reading_angle;
  reading.angles.pan =
      encoder_.pan - truth_.look_angle_error.pan - white * reading_random_.normal();
  reading.angles.tilt =
      encoder_.tilt - truth_.look_angle_error.tilt - white * reading_random_.normal();
  reading.rates = truth_.head_rates;
  reading.zoom_mm = truth_.zoom_mm;
  return reading;
}

void Robot::kidnap(const Pose2& pose) {
  truth_.pose = pose;
  truth_.base = {};
  base_command_ = {};
}

Eigen::Isometry3d Robot::camera_pose() const {
  return camera_pose(camera_);
}

Eigen::Isometry3d Robot::camera_pose(const CameraMount& mount) const {
  return camera_at(mount, truth_.pose, truth_.head);
}

Eigen::Isometry3d Robot::camera_pose_after(double s) const {
  return camera_pose_after(camera_, s);
}

Eigen::Isometry3d Robot::camera_pose_after(const CameraMount& mount, double s) const {
  return camera_at(
      mount, along_arc(truth_.pose, {truth_.base.v * s, truth_.base.w * s, truth_.base.vy * s}),
      {truth_.head.pan + truth_.head_rates.pan * s, truth_.head.tilt + truth_.head_rates.tilt * s});
}

Eigen::Isometry3d Robot::camera_at(const CameraMount& mount, const Pose2& pose,
                                   const HeadAngles& head) const {
  const Eigen::Isometry3d rMc = mounted_camera(mount, head);
  const Eigen::Isometry3d wMr = ground_.place(pose);
  const bool on_head = std::holds_alternative<HeadGeometry>(mount);
  return on_head && mounting_ ? wMr * *mounting_ * rMc : wMr * rMc;
}

void Robot::place(const Pose2& pose, const HeadAngles& head) {
  const HeadLimits& limits = params_.head_limits;
  if (head.pan < limits.pan_min || head.pan > limits.pan_max || head.tilt < limits.tilt_min ||
      head.tilt > limits.tilt_max)
    throw std::invalid_argument("pan or tilt lies beyond the head's range");
  truth_.pose = {pose.x, pose.y, wrap_angle(pose.theta)};
  truth_.head = head;
  truth_.base = {};
  truth_.head_rates = {};
  command({}, {});
  encoder_ = truth_.head;
  odometry_pose_ = wheel_pose_ = truth_.pose;
  odometry_stamp_ = truth_.stamp;
  turned_ = 0.0;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> Robot::camera_jacobian() const {
  const Eigen::Isometry3d rMc = mounted_camera(camera_, truth_.head);
  const Eigen::Matrix<double, 6, 2> head =
      std::visit([this](const auto& mount) { return head_columns(mount, truth_.head); }, camera_);
  if (params_.base.omnidirectional()) {
    Eigen::Matrix<double, 6, 5> jacobian;
    jacobian << camera_jacobian_base(rMc), camera_twist_sideways(rMc), head;
    return jacobian;
  }
  Eigen::Matrix<double, 6, 4> jacobian;
  jacobian << camera_jacobian_base(rMc), head;
  return jacobian;
}

}  // namespace vigia::sim
