#include "code_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vigia::tracking {
namespace {

constexpr double kFloor = 0.025;         // σ of inks and light that no noise explains
constexpr double kBlackBelow = 0.2;      // of the paper's reflectance, the black point's being 0
constexpr double kSecondBelow = 0.75;    // of the strongest channel: the next one
constexpr double kGreyWithin = 0.15;     // spread of the black point's channels
constexpr double kDarkestBlack = 0.5;    // its reflectance at most
constexpr double kTwinTolerance = 0.12;  // between the rings' dots of one place
constexpr double kTwinSigmas = 4.0;

struct Reflectance {
  Eigen::Array3d value = Eigen::Array3d::Zero();
  Eigen::Array3d variance = Eigen::Array3d::Zero();
};

Reflectance reflectance_of(const ColourLevels& levels) {
  const Eigen::Array3d ground = levels.ground.max(1.0);
  return {levels.dot / ground, (levels.dot_sigma / ground).square()};
}

double normal_share(double t) {
  return 0.5 * std::erfc(-t / std::sqrt(2.0));
}

struct Decision {
  DotColour colour = DotColour::black;
  double probability = 0.0;
};

/// The colour of a dot, given the black point's reflectance.
Decision decide(const Reflectance& dot, const Reflectance& black) {
  const Eigen::Array3d scale = (1.0 - black.value).max(0.1);
  const Eigen::Array3d depth = (dot.value - black.value) / scale;
  const Eigen::Array3d variance =
      (dot.variance + black.variance) / scale.square() + kFloor * kFloor;
  Eigen::Index first = 0;
  const double strongest = depth.maxCoeff(&first);
  const double over_black = (strongest - kBlackBelow) / std::sqrt(variance[first]);
  if (over_black < 0.0) {
    // Each channel is below the threshold.
    double probability = 1.0;
    for (int c = 0; c < 3; ++c)
      probability *= normal_share((kBlackBelow - depth[c]) / std::sqrt(variance[c]));
    return {DotColour::black, probability};
  }
  double probability = normal_share(over_black);
  for (int c = 0; c < 3; ++c) {
    if (c == first) continue;
    const double margin = kSecondBelow * strongest - depth[c];
    const double sigma = std::sqrt(kSecondBelow * kSecondBelow * variance[first] + variance[c]);
    probability *= normal_share(margin / sigma);
  }
  return {static_cast<DotColour>(first + 1), probability};
}

bool agree(const Reflectance& a, const Reflectance& b) {
  const Eigen::Array3d limit = kTwinTolerance + kTwinSigmas * (a.variance + b.variance).sqrt();
  return ((a.value - b.value).abs() < limit).all();
}

Reflectance combine(const Reflectance& a, const Reflectance& b) {
  constexpr double kTiny = 1e-8;
  const Eigen::Array3d wa = 1.0 / (a.variance + kTiny);
  const Eigen::Array3d wb = 1.0 / (b.variance + kTiny);
  return {(wa * a.value + wb * b.value) / (wa + wb), 1.0 / (wa + wb)};
}

/// The ring's places, read from either ring or both.
ReadStatus read_ring(const DotLevels& dots, std::array<Reflectance, kDotsPerRing>& ring) {
  ReadStatus status = ReadStatus::read;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto& outer = dots[1 + i];
    const auto& inner = dots[1 + kDotsPerRing + i];
    if (!outer && !inner) {
      status = ReadStatus::incomplete;
      continue;
    }
    ring[i] = reflectance_of(outer ? *outer : *inner);
    if (!outer || !inner) continue;
    const Reflectance twin = reflectance_of(*inner);
    if (!agree(ring[i], twin)) return ReadStatus::doubtful;
    ring[i] = combine(ring[i], twin);
  }
  return status;
}

bool is_grey_and_dark(const Reflectance& black) {
  return black.value.maxCoeff() - black.value.minCoeff() < kGreyWithin &&
         black.value.maxCoeff() < kDarkestBlack;
}

}  // namespace

CodeReading read_code(const DotLevels& dots, double min_confidence) {
  CodeReading reading;
  std::array<Reflectance, kDotsPerRing> ring;
  reading.status = read_ring(dots, ring);
  if (reading.status != ReadStatus::read) return reading;
  reading.status = dots[0] ? ReadStatus::doubtful : ReadStatus::incomplete;
  if (!dots[0]) return reading;

  const auto darkest = std::min_element(ring.begin(), ring.end(), [](const auto& a, const auto& b) {
    return a.value.maxCoeff() < b.value.maxCoeff();
  });
  const Reflectance black = *darkest;
  if (!is_grey_and_dark(black)) return reading;
  const auto first = static_cast<std::size_t>(darkest - ring.begin());

  PatternColours colours;
  const Decision centre = decide(reflectance_of(*dots[0]), black);
  colours.centre = centre.colour;
  double probability = centre.probability;
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const Decision decision = decide(ring[(first + i) % ring.size()], black);
    if (decision.colour == DotColour::black) return reading;
    colours.ring[i] = decision.colour;
    probability *= decision.probability;
  }
  reading.confidence = probability;
  if (probability < min_confidence) return reading;
  reading.status = ReadStatus::read;
  reading.first = static_cast<int>(first);
  reading.code = decode(colours);
  return reading;
}

bool looks_like(const ColourLevels& levels, const ColourLevels& black, DotColour colour) {
  return decide(reflectance_of(levels), reflectance_of(black)).colour == colour;
}

}  // namespace vigia::tracking
