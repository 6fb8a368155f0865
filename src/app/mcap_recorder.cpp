#include "mcap_recorder.hpp"

#include <fmt/format.h>

#include "vigia/core/belief_on_ground.hpp"
#include "vigia/imaging/thumbnail.hpp"
#include "vigia/mission/delays.hpp"

namespace vigia::app {
namespace {

namespace foxglove = report::foxglove;
using foxglove::Message;

constexpr const char* kRobotFrame = "robot";

foxglove::LogLevel level_of(mission::EventKind kind) {
  using mission::EventKind;
  switch (kind) {
    case EventKind::collided:
    case EventKind::timeout:
    case EventKind::stuck:
    case EventKind::still_lost:
      return foxglove::LogLevel::error;
    case EventKind::target_lost:
    case EventKind::expired:
    case EventKind::dropped:
    case EventKind::rejected:
    case EventKind::limit_1:
    case EventKind::stop:
    case EventKind::lost:
    case EventKind::ambiguous:
    case EventKind::blocked:
    case EventKind::refused:
    case EventKind::via_missed:
    case EventKind::ground_off:
    case EventKind::kidnapped:
      return foxglove::LogLevel::warning;
    case EventKind::plan:
    case EventKind::look:
    case EventKind::acquired:
    case EventKind::released:
    case EventKind::restart:
    case EventKind::looked_around:
    case EventKind::exploration:
    case EventKind::recovered:
    case EventKind::settled:
    case EventKind::wait:
    case EventKind::evade:
    case EventKind::rejoined:
    case EventKind::replan:
    case EventKind::arrived:
      return foxglove::LogLevel::info;
  }
  return foxglove::LogLevel::info;
}

/// Of (δp, δφ) in world axes.
Eigen::Matrix<double, 6, 6> covariance_in_space(const Belief& belief, const Ground& ground) {
  if (belief.in_space && !ground.flat()) return belief.in_space->covariance;
  const Eigen::Matrix<double, 6, 3> dplace_dpose = ground.dplace_dpose(belief.pose);
  return dplace_dpose * belief.covariance * dplace_dpose.transpose();
}

/// When the picture was exposed: as its observation says, or else by the camera's @p delay.
Stamp exposed(const mission::Tick& tick, CameraId camera, Duration delay) {
  for (const Observation& observation : tick.estimator.observations)
    if (shot_of(observation).camera == camera) return shot_of(observation).stamp;
  const Stamp now = tick.estimator.now;
  return now.ns > delay.ns ? now - delay : Stamp{};
}

}  // namespace

McapRecorder::McapRecorder(report::McapWriter& writer, double images_hz)
    : writer_(writer), images_hz_(images_hz) {}

void McapRecorder::on_start(const mission::MissionStart& start) {
  setup_ = &start.setup;
  rig_ = setup_->robot.rig();
  frames_ = writer_.add_channel("/tf", foxglove::schema(Message::frame_transforms));
  truth_ = writer_.add_channel("/truth/pose", foxglove::schema(Message::pose_in_frame));
  events_ = writer_.add_channel("/events", foxglove::schema(Message::log));
  const auto scene = writer_.add_channel("/scene", foxglove::schema(Message::scene_update));
  const auto robot = writer_.add_channel("/truth/robot", foxglove::schema(Message::scene_update));
  beliefs_ = writer_.add_channel("/beliefs", foxglove::schema(Message::scene_update));
  for (const std::string& name : setup_->localizers) add_localizer(name);
  if (images_hz_ > 0.0)
    for (const Camera& camera : rig_.cameras) add_camera(camera);
  writer_.write(scene, {}, foxglove::world_scene({}, setup_->world, setup_->path));
  writer_.write(robot, {}, foxglove::robot_scene({}, kRobotFrame, setup_->robot.robot.radius_m));
}

void McapRecorder::add_localizer(const std::string& name) {
  const std::string topic = "/localizers/" + name;
  localizers_.push_back(
      {writer_.add_channel(topic + "/pose", foxglove::schema(Message::pose_in_frame)),
       writer_.add_channel(topic + "/odometry", foxglove::schema(Message::odometry)),
       writer_.add_channel(topic + "/hypotheses", foxglove::schema(Message::poses_in_frame))});
}

void McapRecorder::add_camera(const Camera& camera) {
  CameraChannels channels;
  channels.frame = fmt::format("camera_{}", camera.id);
  const std::string topic = "/" + channels.frame;
  channels.image =
      writer_.add_channel(topic + "/image", foxglove::schema(Message::compressed_image));
  channels.annotations =
      writer_.add_channel(topic + "/annotations", foxglove::schema(Message::image_annotations));
  const CameraModel model = camera.model(setup_->robot.initial_zoom_mm);
  if (foxglove::camera_calibration({}, channels.frame, model))
    channels.calibration =
        writer_.add_channel(topic + "/calibration", foxglove::schema(Message::camera_calibration));
  channels.schedule.period_s = 1.0 / images_hz_;
  channels.delay = mission::longest_delay(*setup_, camera);
  cameras_.emplace(camera.id, channels);
}

void McapRecorder::on_tick(const mission::Tick& tick) {
  const Stamp now = tick.estimator.now;
  const Eigen::Isometry3d wMr = true_wMr(tick, setup_->world.ground);
  write_frames(tick, wMr);
  writer_.write(truth_, now, foxglove::pose_in_frame(now, wMr));
  write_beliefs(tick);
  if (ellipses_.due(now.seconds())) write_ellipses(tick);
  for (const mission::EyeTick& shown : tick.eyes) write_picture(tick, shown);
}

void McapRecorder::write_frames(const mission::Tick& tick, const Eigen::Isometry3d& wMr) {
  std::vector<foxglove::Transform> frames{{foxglove::kWorldFrame, kRobotFrame, wMr}};
  for (const Camera& camera : rig_.cameras)
    frames.push_back(
        {kRobotFrame, fmt::format("camera_{}", camera.id), camera.rMc(tick.truth.head)});
  for (std::size_t i = 0; i < localizers_.size(); ++i)
    frames.push_back({foxglove::kWorldFrame, setup_->localizers[i],
                      believed_wMr(*tick.estimator.localizers[i].belief, setup_->world.ground)});
  writer_.write(frames_, tick.estimator.now,
                foxglove::frame_transforms(tick.estimator.now, frames));
}

void McapRecorder::write_beliefs(const mission::Tick& tick) {
  const Stamp now = tick.estimator.now;
  const Ground& ground = setup_->world.ground;
  for (std::size_t i = 0; i < localizers_.size(); ++i) {
    const Belief& belief = *tick.estimator.localizers[i].belief;
    const Eigen::Isometry3d wMr = believed_wMr(belief, ground);
    writer_.write(localizers_[i].pose, now, foxglove::pose_in_frame(now, wMr));
    writer_.write(
        localizers_[i].odometry, now,
        foxglove::odometry(now, setup_->localizers[i], wMr, covariance_in_space(belief, ground)));
  }
}

void McapRecorder::write_ellipses(const mission::Tick& tick) {
  const Stamp now = tick.estimator.now;
  const Ground& ground = setup_->world.ground;
  std::vector<Belief> shown;
  for (const auto& localizer : tick.estimator.localizers)
    shown.push_back(with_likeliest(*localizer.belief));
  std::vector<foxglove::NamedBelief> named;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    named.push_back({setup_->localizers[i], &shown[i]});
    std::vector<Eigen::Isometry3d> places;
    for (const auto& hypothesis : shown[i].hypotheses)
      places.push_back(ground.place(hypothesis.pose));
    writer_.write(localizers_[i].hypotheses, now, foxglove::poses_in_frame(now, places));
  }
  writer_.write(beliefs_, now, foxglove::beliefs_scene(now, named, ground));
}

void McapRecorder::write_picture(const mission::Tick& tick, const mission::EyeTick& shown) {
  const Stamp now = tick.estimator.now;
  const auto found = cameras_.find(shown.camera);
  if (found == cameras_.end() || !found->second.schedule.due(now.seconds())) return;
  const CameraChannels& to = found->second;
  const Stamp at = exposed(tick, shown.camera, to.delay);
  const std::string jpeg = imaging::encode_jpeg(imaging::colour_image(*shown.frame), kQuality);
  writer_.write(to.image, now, foxglove::compressed_image(at, to.frame, jpeg));
  writer_.write(
      to.annotations, now,
      foxglove::image_annotations(at, shown.observed ? shown.eye->overlay() : imaging::Overlay{}));
  if (!to.calibration) return;
  const CameraModel model = rig_.at(shown.camera).model(tick.truth.zoom_mm);
  writer_.write(*to.calibration, now, *foxglove::camera_calibration(at, to.frame, model));
}

void McapRecorder::on_event(const mission::Event& event) {
  writer_.write(events_, event.stamp,
                foxglove::log(event.stamp, level_of(event.kind), std::string(to_string(event.kind)),
                              in_words(event)));
}

}  // namespace vigia::app
