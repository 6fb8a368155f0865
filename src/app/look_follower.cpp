#include "look_follower.hpp"

#include <algorithm>

namespace vigia::app {

void LookFollower::on_start(const mission::MissionStart& start) {
  look_.reset();
  const Rig rig = start.setup.robot.rig();
  const Camera* camera = directed_camera(rig);
  camera_ = camera == nullptr ? std::nullopt : std::optional(camera->id);
}

bool LookFollower::observed(const mission::Tick& tick) const {
  const auto& all = tick.estimator.observations;
  return camera_ && std::any_of(all.begin(), all.end(), [&](const Observation& observation) {
           return shot_of(observation).camera == *camera_;
         });
}

std::optional<FollowedLook> LookFollower::process(const mission::Tick& tick) {
  if (!camera_ || !tick.attention || !tick.attention->order) return std::nullopt;
  const LookId id = tick.attention->look;
  if (!look_ || look_->id != id) look_ = {id, tick.attention->order->landmark, false};
  const auto& updates = tick.estimator.localizers[tick.estimator.primary].updates;
  for (std::size_t i = 0; i < updates.size(); ++i) {
    if (updates[i].status != localization::UpdateStatus::fused) continue;
    if (shot_of(tick.estimator.observations[i]).camera != *camera_) continue;
    look_->fused = true;
    look_->landmark = updates[i].landmark.value_or(look_->landmark);
  }
  return look_;
}

}  // namespace vigia::app
