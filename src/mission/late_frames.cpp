#include "late_frames.hpp"

#include <algorithm>

namespace vigia::mission {

std::unique_ptr<ExposedFrame> LateFrames::take(Stamp now) {
  if (processing_.ns == 0) return arrived(now);
  std::unique_ptr<ExposedFrame> processed;
  if (in_work_ && done_ <= now) processed = std::move(in_work_);
  if (!in_work_) {
    in_work_ = arrived(now);
    done_ = now + processing_;
  }
  return processed;
}

/// The newest frame that has arrived; the older ones are dropped.
std::unique_ptr<ExposedFrame> LateFrames::arrived(Stamp now) {
  std::unique_ptr<ExposedFrame> newest;
  while (!on_the_way_.empty() && on_the_way_.front().shot.stamp + latency_ <= now) {
    newest = std::make_unique<ExposedFrame>(std::move(on_the_way_.front()));
    on_the_way_.pop_front();
  }
  return newest;
}

void RecentMotion::moved(const OdometryIncrement& u) {
  places_.push_back({u.to, move(places_.back().oMr, u)});
  while (places_.size() > 1 && places_[1].stamp < u.to - length_) places_.pop_front();
}

Belief RecentMotion::belief_at(Stamp stamp, const Belief& now) const {
  const Place& last = places_.back();
  if (stamp >= last.stamp) return now;
  const auto then = std::find_if(places_.begin(), places_.end(),
                                 [stamp](const Place& place) { return place.stamp >= stamp; });
  Belief belief = now;
  belief.stamp = then->stamp;
  belief.in_space.reset();
  belief.pose = compose(now.pose, compose(inverse(last.oMr), then->oMr));
  return belief;
}

}  // namespace vigia::mission
