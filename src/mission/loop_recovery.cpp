#include "loop.hpp"

namespace vigia::mission {

// The lost robot stands still and looks around; what it sees, all at once, tells where it is.

void Loop::begin_recovery() {
  tell("lost", {{"sigma_m", belief().position_sigma()}}, {{"localizer", setup_.primary}});
  gaze_.cancel();
  request_ = servo::TrackRequest::none;
  acquired_.reset();
  recovering_ = true;
  failed_in_a_row_ = 0;
  sweep_ = {};
  look_ = scheduler_.next_look();
  simulator_.robot().begin_look();
  look_around_.begin(head_);
}

void Loop::recover(const imaging::Frame* frame) {
  command_ = {};
  // The frame must have been exposed at this stop, standing still.
  const Stamp exposed = frame != nullptr ? delivered_->sensor.stamp : Stamp{};
  if (look_around_.ready(now_, head_, exposed)) {
    const Stopwatch watch;
    const SensorSnapshot& sensor = delivered_->sensor;
    for (auto& seen : watcher_.survey(*frame, sensor)) sweep_.sightings.push_back(seen);
    sweep_.views.push_back(sensor);
    timing_.track += watch.elapsed_ms();
    if (!look_around_.next()) {
      relocalize();
      return;
    }
    look_ = scheduler_.next_look();
    simulator_.robot().begin_look();
  }
  simulator_.robot().command(command_, look_around_.step(head_));
}

void Loop::relocalize() {
  const auto found = relocalizer_.solve(sweep_);
  tell("looked_around", {{"sightings", static_cast<double>(sweep_.sightings.size())},
                         {"hypotheses", static_cast<double>(found.hypotheses.size())}});
  sweep_ = {};
  if (found.status == localization::RelocalizationStatus::found) {
    const auto& best = found.hypotheses.front();
    localizers_[primary_]->reset(now_, {best.pose, best.covariance});
    recovering_ = false;
    look_around_.found();
    tell("recovered", {{"x_m", best.pose.x},
                       {"y_m", best.pose.y},
                       {"theta_rad", best.pose.theta},
                       {"sigma_m", belief().position_sigma()}});
    if (!replan(best.pose, "recovered")) {
      tell("stuck", {}, {{"reason", "no route from where the robot found itself"}});
      gave_up_ = Outcome::stuck;
    }
    return;
  }
  if (look_around_.sweeps() >= setup_.recovery.sweeps) {
    gave_up_ = Outcome::stuck;
    return;
  }
  look_ = scheduler_.next_look();
  simulator_.robot().begin_look();
  look_around_.begin(head_);
}

}  // namespace vigia::mission
