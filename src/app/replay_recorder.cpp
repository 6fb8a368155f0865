#include "replay_recorder.hpp"

#include "suitability_timeline.hpp"

#include <cmath>

#include <fmt/format.h>

#include "vigia/imaging/thumbnail.hpp"

namespace vigia::app {
namespace {

/// Direction on the floor of what the middle of a side of the picture shows, in the base frame.
std::optional<double> rim(const Camera& camera, const CameraModel& model, const HeadAngles& head,
                          double u) {
  const auto direction_c = ray(model, {u, 0.5 * (image_height(model) - 1)});
  if (!direction_c) return std::nullopt;
  const Eigen::Vector3d direction_r = camera.rMc(head).linear() * *direction_c;
  return std::atan2(direction_r.y(), direction_r.x());
}

bool sees_all_round(const Camera& camera) {
  return std::holds_alternative<CameraModel>(camera.optics) &&
         std::holds_alternative<UnifiedOmni>(std::get<CameraModel>(camera.optics));
}

}  // namespace

void ReplayRecorder::on_start(const mission::MissionStart& start) {
  setup_ = &start.setup;
  run_ = {};
  follower_.on_start(start);
  schedules_.clear();
  camera_index_.clear();
  for (const Camera& camera : setup_->robot.rig().cameras) {
    camera_index_[camera.id] = run_.cameras.size();
    const CameraModel model = camera.model(setup_->robot.initial_zoom_mm);
    run_.cameras.push_back(
        {fmt::format("camera {}", camera.id), image_width(model), image_height(model), {}, {}, {}});
    schedules_.push_back({1.0 / kPictures_hz});
  }
  for (const std::string& name : setup_->localizers)
    run_.localizers.push_back({name, name == setup_->primary, {}, {}});
}

void ReplayRecorder::on_tick(const mission::Tick& tick) {
  const double t_s = tick.estimator.now.seconds();
  run_.t_s.push_back(t_s);
  run_.truth.push_back(tick.truth.pose);
  run_.speed_mps.push_back(tick.truth.base.v);
  run_.pan.push_back(tick.truth.head.pan);
  run_.tilt.push_back(tick.truth.head.tilt);
  run_.zoom_mm.push_back(tick.truth.zoom_mm);
  const auto look = follower_.process(tick);
  run_.target.push_back(look ? std::optional(look->landmark) : std::nullopt);
  for (std::size_t i = 0; i < run_.localizers.size(); ++i) {
    run_.localizers[i].beliefs.push_back(with_likeliest(*tick.estimator.localizers[i].belief));
    run_.localizers[i].bound_m.push_back(std::sqrt(scorer_.bound_position_m2(i)));
  }
  note_cameras(tick);
}

void ReplayRecorder::note_cameras(const mission::Tick& tick) {
  const Rig rig = setup_->robot.rig();
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Camera& camera = rig.cameras[i];
    if (sees_all_round(camera)) continue;
    const CameraModel model = camera.model(tick.truth.zoom_mm);
    const auto left = rim(camera, model, tick.truth.head, 0.0);
    const auto right = rim(camera, model, tick.truth.head, image_width(model) - 1.0);
    run_.cameras[i].left.push_back(left.value_or(NAN));
    run_.cameras[i].right.push_back(right.value_or(NAN));
  }
  for (const mission::EyeTick& shown : tick.eyes) note_picture(shown, tick.estimator.now.seconds());
}

void ReplayRecorder::note_picture(const mission::EyeTick& shown, double t_s) {
  const std::size_t i = camera_index_.at(shown.camera);
  if (!schedules_[i].due(t_s)) return;
  report::ReplayCamera& camera = run_.cameras[i];
  report::ReplayImage image;
  image.t_s = t_s;
  image.jpeg =
      imaging::encode_jpeg(imaging::thumbnail(*shown.frame, kPictureWidth_px), kPictureQuality);
  if (shown.observed) image.overlay = shown.eye->overlay();
  camera.images.push_back(std::move(image));
  if (camera.images.size() > kPictures / run_.cameras.size()) {
    thin_out(camera);
    schedules_[i].period_s *= 2.0;
  }
}

void ReplayRecorder::thin_out(report::ReplayCamera& camera) {
  std::vector<report::ReplayImage> kept;
  for (std::size_t i = 0; i < camera.images.size(); i += 2)
    kept.push_back(std::move(camera.images[i]));
  camera.images = std::move(kept);
}

void ReplayRecorder::on_event(const mission::Event& event) {
  run_.events.push_back(
      {event.stamp.seconds(), std::string(to_string(event.kind)), in_words(event)});
}

report::ReplayRun ReplayRecorder::run(const std::string& command) const {
  report::ReplayRun run = run_;
  const evaluation::DriveScore& score = scorer_.score();
  run.name = setup_->name;
  run.seed = score.seed;
  run.version = VIGIA_VERSION;
  run.command = command;
  run.summary_json = evaluation::summary_json(score);
  run.world = setup_->world;
  run.planned = setup_->path;
  run.robot_radius_m = setup_->robot.robot.radius_m;
  if (directed_camera(setup_->robot.rig()) != nullptr) {
    run.limits_m = {setup_->look.trigger.limit_1_m, setup_->look.trigger.limit_2_m};
    run.suitability = suitability(*setup_, run);
  } else {
    run.pan = run.tilt = run.zoom_mm = {};
  }
  return run;
}

}  // namespace vigia::app
