#include "ring_doubt.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/sector.hpp"

namespace vigia::mission {
namespace {

constexpr double kPeriod_s = 0.2;
/// Share of the beams that see through a wall: of a robot that is where it believes to be, in a map
/// that is not perfect, and of one that is not.
constexpr double kLongHere = 0.12;
constexpr double kLongElsewhere = 0.4;
/// Weight of a scan beside one that shares nothing with those before.
constexpr double kTempering = 0.2;
/// Log odds: before anything was seen, and how far a long agreement takes them down below that.
constexpr double kLogPrior = -4.0;
constexpr double kMaxTrust = 3.0;
constexpr double kMaxDoubt = 12.0;
/// How wrong the map's walls may be, m.
constexpr double kMapTolerance_m = 0.12;
constexpr int kRays = 5;

}  // namespace

std::vector<RingDoubt::Beam> RingDoubt::compare(const RangeScan& scan, const Belief& belief) const {
  const double sigma_heading = std::sqrt(belief.covariance(2, 2));
  const double half = std::max(0.0, model_.half_cone - 2.0 * sigma_heading);
  const double tolerance = kMapTolerance_m + 3.0 * belief.position_sigma();
  const NearFaces faces(plan_, belief.pose.position(), scan.reach_m, model_.height_m);
  std::vector<Beam> beams;
  beams.reserve(scan.readings.size());
  std::array<Eigen::Vector2d, kRays> within;
  for (int i = 0; i < kRays; ++i)
    within[static_cast<std::size_t>(i)] = unit_vector(half * (2.0 * i / (kRays - 1) - 1.0));
  for (const RangeReading& reading : scan.readings) {
    const Eigen::Vector2d middle = unit_vector(belief.pose.theta + reading.bearing);
    Beam beam;
    double nearest_m = scan.reach_m;
    for (const Eigen::Vector2d& ray : within) {
      const auto hit = faces.cast(turned(ray, middle), nearest_m);
      if (!hit || hit->distance_m >= nearest_m) continue;
      nearest_m = hit->distance_m;
      beam.face = hit->wall;
    }
    const double farthest_m =
        nearest_m + tolerance + 3.0 * std::hypot(model_.sigma_m, model_.sigma_relative * nearest_m);
    const bool testable = farthest_m < scan.reach_m && absent_.count(beam.face) == 0;
    if (testable) beam.verdict = reading.range_m > farthest_m ? Verdict::longer : Verdict::right;
    beams.push_back(beam);
  }
  return beams;
}

void RingDoubt::process(const RangeScan& scan, const Belief& belief) {
  if (scan.readings.empty() || (scan.stamp - counted_).seconds() < kPeriod_s) return;
  counted_ = scan.stamp;
  const double longer = std::log(kLongElsewhere / kLongHere);
  const double right = std::log((1.0 - kLongElsewhere) / (1.0 - kLongHere));
  double evidence = 0.0;
  for (const Beam& beam : compare(scan, belief)) {
    if (beam.verdict == Verdict::longer) evidence += longer;
    if (beam.verdict == Verdict::right) evidence += right;
  }
  log_odds_ = std::clamp(log_odds_ + kTempering * evidence, -kMaxTrust, kMaxDoubt);
}

double RingDoubt::probability() const {
  return 1.0 / (1.0 + std::exp(-kLogPrior - log_odds_));
}

void RingDoubt::trust(const RangeScan& scan, const Belief& belief) {
  log_odds_ = 0.0;
  for (const Beam& beam : compare(scan, belief))
    if (beam.verdict == Verdict::longer) absent_.insert(beam.face);
}

}  // namespace vigia::mission
