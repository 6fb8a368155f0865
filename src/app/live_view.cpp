#include "live_view.hpp"

#include <algorithm>
#include <thread>

#include <spdlog/spdlog.h>

#include "vigia/core/error.hpp"

namespace vigia::app {
namespace {

constexpr auto kBetweenPictures = std::chrono::milliseconds(30);
constexpr int kMapWidth_px = 640;

/// Two pictures beside each other, their upper edges level.
vpImage<vpRGBa> side_by_side(const vpImage<vpRGBa>& left, const vpImage<vpRGBa>& right) {
  vpImage<vpRGBa> both(std::max(left.getHeight(), right.getHeight()),
                       left.getWidth() + right.getWidth(), vpRGBa(255, 255, 255));
  both.insert(left, vpImagePoint(0, 0));
  both.insert(right, vpImagePoint(0, left.getWidth()));
  return both;
}

}  // namespace

void LiveView::on_start(const mission::MissionStart& start) {
  const mission::MissionSetup& setup = start.setup;
  window_.emplace("vigia run: " + setup.name, "the mission goes on without a window");
  wall_.emplace(setup);
  const int height = std::max(480, static_cast<int>(wall_->picture().getHeight()));
  map_.emplace(setup.world, setup.path, setup.robot.robot.radius_m, kMapWidth_px, height);
  start_ = Clock::now();
}

void LiveView::on_tick(const mission::Tick& tick) {
  if (!window_) return;
  const Belief& belief = tick.estimator.primary_belief();
  map_->move(tick.truth.pose, belief.pose);
  const auto now = Clock::now();
  for (const mission::EyeTick& shown : tick.eyes) {
    if (now < due_[shown.camera]) continue;
    due_[shown.camera] = now + kBetweenPictures;
    wall_->show(tick, shown);
  }
  if (now >= next_) {
    next_ = now + kBetweenPictures;
    show(tick);
  }
  if (window_ && pace_ == Pace::real) wait_until(tick.estimator.now);
}

void LiveView::show(const mission::Tick& tick) {
  const bool watches = tick.attention && tick.attention->order;
  const auto target = watches ? std::optional(tick.attention->order->landmark) : std::nullopt;
  try {
    window_->show(
        side_by_side(wall_->picture(), map_->picture(tick.estimator.primary_belief(), target)));
    if (window_->closed()) window_.reset();
  } catch (const InputError& error) {
    spdlog::warn("{}", error.what());
    window_.reset();
  }
}

/// A mission that falls behind goes on in real time from there.
void LiveView::wait_until(Stamp now) {
  const auto due = start_ + std::chrono::nanoseconds(now.ns);
  if (due < Clock::now())
    start_ += Clock::now() - due;
  else
    std::this_thread::sleep_until(due);
}

}  // namespace vigia::app
