#include "echo_memory.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::pilot {
namespace {

using Eigen::Vector2d;

constexpr double kSameThing = 0.20;     // m between two echoes of one thing, and
constexpr double kSameAngle = 0.10;     // rad more per metre of range
constexpr double kNews = 0.5;           // share of the newest echo in a thing's place
constexpr int kMaxHits = 6;             // so that a thing that went away is soon forgotten
constexpr double kBehind = 0.20;        // m beyond a thing at which an echo means that it is gone
constexpr std::size_t kMaxThings = 40;  // things remembered

/// The reading whose beam points nearest to a bearing.
const RangeReading& beam_towards(const RangeScan& scan, double bearing) {
  return *std::min_element(scan.readings.begin(), scan.readings.end(),
                           [bearing](const RangeReading& a, const RangeReading& b) {
                             return std::abs(wrap_angle(a.bearing - bearing)) <
                                    std::abs(wrap_angle(b.bearing - bearing));
                           });
}

}  // namespace

void EchoMemory::carry(const OdometryIncrement& odometry) {
  if (echoes_.empty()) return;
  const Pose2 before_M_after = move({}, odometry);
  const double c = std::cos(before_M_after.theta);
  const double s = std::sin(before_M_after.theta);
  for (Echo& echo : echoes_) {
    const Vector2d d = echo.front_r - before_M_after.position();
    echo.front_r = {c * d.x() + s * d.y(), -s * d.x() + c * d.y()};
  }
}

void EchoMemory::note(const Vector2d& front_r, Stamp now) {
  const double reach = kSameThing + kSameAngle * front_r.norm();
  Echo* nearest = nullptr;
  double distance = reach;
  for (Echo& echo : echoes_) {
    const double d = (echo.front_r - front_r).norm();
    if (echo.seen == now || d >= distance) continue;
    nearest = &echo;
    distance = d;
  }
  if (nearest != nullptr) {
    nearest->front_r += kNews * (front_r - nearest->front_r);
    nearest->hits = std::min(nearest->hits + 1, kMaxHits);
    nearest->seen = now;
  } else if (echoes_.size() < kMaxThings) {
    echoes_.push_back({front_r, 1, now});
  }
}

void EchoMemory::see_through(const RangeScan& scan) {
  for (Echo& echo : echoes_) {
    if (echo.seen == scan.stamp) continue;
    const double range = echo.front_r.norm();
    const double bearing = std::atan2(echo.front_r.y(), echo.front_r.x());
    const RangeReading& beam = beam_towards(scan, bearing);
    const bool through = !beam.echo || beam.range_m > range + kBehind;
    // What no second scan has shown yet was a slip of the ring unless it comes again at once.
    if (through || !confirmed(echo)) --echo.hits;
  }
  echoes_.erase(std::remove_if(echoes_.begin(), echoes_.end(),
                               [](const Echo& echo) { return echo.hits <= 0; }),
                echoes_.end());
}

void EchoMemory::take(const RangeScan& scan, const std::vector<char>& unexplained) {
  if (scan.readings.empty()) return;
  for (std::size_t i = 0; i < scan.readings.size(); ++i) {
    const RangeReading& reading = scan.readings[i];
    if (unexplained[i] == 0) continue;
    note(reading.range_m * unit_vector(reading.bearing), scan.stamp);
  }
  see_through(scan);
}

void EchoMemory::forget(Stamp now) {
  const Duration longest = Duration::from_seconds(params_.memory_s);
  echoes_.erase(std::remove_if(echoes_.begin(), echoes_.end(),
                               [&](const Echo& echo) { return now - echo.seen > longest; }),
                echoes_.end());
}

}  // namespace vigia::pilot
