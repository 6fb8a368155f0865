#include "drive_picture.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace vigia::app {

void DrivePicture::on_start(const mission::MissionStart& start) {
  setup_ = &start.setup;
}

void DrivePicture::on_tick(const mission::Tick& tick) {
  const auto& names = setup_->localizers;
  truth_.push_back(tick.truth.pose);
  const Belief& primary = tick.estimator.primary_belief();
  estimate_.push_back({primary.pose, primary.covariance});
  const auto odometry = std::find(names.begin(), names.end(), "odometry");
  if (odometry != names.end())
    odometry_.push_back(
        tick.estimator.localizers[static_cast<std::size_t>(odometry - names.begin())].belief->pose);
  note_look(tick);
}

void DrivePicture::note_look(const mission::Tick& tick) {
  if (tick.estimator.observations.empty() || !tick.attention || !tick.attention->order) return;
  const mission::AttentionTick& attention = *tick.attention;
  const auto& updates = tick.estimator.localizers[tick.estimator.primary].updates;
  const bool fused = std::any_of(updates.begin(), updates.end(), [](const auto& update) {
    return update.status == localization::UpdateStatus::fused;
  });
  if (attention.look != look_) {
    look_ = attention.look;
    looks_.push_back({attention.order->landmark, tick.truth.pose.position(), fused});
  }
  looks_.back().fused = looks_.back().fused || fused;
}

report::MapDrive DrivePicture::drive(const evaluation::DriveScore& score) const {
  const auto& primary = score.localizers.at(setup_->primary);
  report::MapDrive drive{setup_->world};
  drive.title =
      fmt::format("{} – {} after {:.1f} s", setup_->name, to_string(score.outcome), score.sim_s);
  drive.subtitle = fmt::format(
      "seed {}, policy {}, {} looks; {}: final {:.1f} cm, rms {:.1f} cm, NEES {:.2f} per dof",
      score.seed, setup_->look.policy, score.perception.looks, setup_->primary,
      100 * primary.position_final_m, 100 * primary.position_rmse_m, primary.nees_mean / 3.0);
  drive.planned = setup_->path;
  drive.truth = truth_;
  drive.estimate = estimate_;
  drive.estimate_name = setup_->primary;
  drive.odometry = odometry_;
  drive.looks = looks_;
  drive.robot_radius_m = setup_->robot.robot.radius_m;
  return drive;
}

void DrivePicture::draw(const evaluation::DriveScore& score,
                        const std::filesystem::path& png) const {
  report::draw_map(drive(score), png);
}

}  // namespace vigia::app
