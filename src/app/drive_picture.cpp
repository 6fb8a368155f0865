#include "drive_picture.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace vigia::app {
namespace {

/// How an event is marked on the picture; nothing for one that is not.
struct Marked {
  const char* word;
  bool grave;
};

std::optional<Marked> marked(mission::EventKind kind) {
  using Kind = mission::EventKind;
  switch (kind) {
    case Kind::kidnapped:
      return Marked{"kidnapped", true};
    case Kind::lost:
      return Marked{"lost", true};
    case Kind::recovered:
      return Marked{"recovered", false};
    case Kind::ambiguous:
      return Marked{"ambiguous", true};
    case Kind::settled:
      return Marked{"settled", false};
    case Kind::collided:
      return Marked{"collision", true};
    case Kind::stuck:
      return Marked{"stuck", true};
    case Kind::still_lost:
      return Marked{"still lost", true};
    default:
      return std::nullopt;
  }
}

}  // namespace

void DrivePicture::on_start(const mission::MissionStart& start) {
  setup_ = &start.setup;
  follower_.on_start(start);
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

void DrivePicture::on_event(const mission::Event& event) {
  // The tick that an event belongs to comes after it.
  const std::size_t coming = truth_.size();
  if (event.kind == mission::EventKind::kidnapped && coming > 0) jumps_.push_back(coming);
  const auto mark = marked(event.kind);
  if (!mark) return;
  const std::string text = fmt::format("{} {:.0f} s", mark->word, event.stamp.seconds());
  const bool leaves = event.kind == mission::EventKind::kidnapped && coming > 0;
  // A robot that stays lost says so, and so does the drive's end.
  if (marks_.empty() || marks_.back().text != text)
    marks_.push_back({leaves ? coming - 1 : coming, text, mark->grave});
}

void DrivePicture::note_look(const mission::Tick& tick) {
  const auto look = follower_.process(tick);
  if (!look || !follower_.observed(tick)) return;
  if (look->id != look_) {
    look_ = look->id;
    looks_.push_back({look->landmark, tick.truth.pose.position(), look->fused});
  }
  looks_.back().landmark = look->landmark;
  looks_.back().fused = look->fused;
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
  drive.marks = marks_;
  // What ends a drive comes after its last tick.
  for (auto& mark : drive.marks) mark.instant = std::min(mark.instant, truth_.size() - 1);
  for (const std::size_t jump : jumps_)
    if (jump < truth_.size()) drive.jumps.push_back(jump);
  drive.looks = looks_;
  drive.robot_radius_m = setup_->robot.robot.radius_m;
  return drive;
}

void DrivePicture::draw(const evaluation::DriveScore& score,
                        const std::filesystem::path& png) const {
  report::draw_map(drive(score), png);
}

}  // namespace vigia::app
