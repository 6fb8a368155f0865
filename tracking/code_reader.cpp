#include "code_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vigia::tracking {
namespace {

// Of the most absorbed channel, like all ratios here.
constexpr double kBlackAbove = 0.78;     // the least absorbed channel of black
constexpr double kGreyest = 0.75;        // the same of the black point, tinted by light
constexpr double kFloor = 0.03;          // σ of inks and colour interpolation
constexpr double kTwinTolerance = 0.20;  // between the rings' dots of one place
constexpr double kTwinSigmas = 4.0;
// Of the paper's light.
constexpr double kMinStrength = 0.12;  // of the most absorbed channel
// Against the median of the dots of one ring.
constexpr double kWeakestBlack = 0.85;   // the black point
constexpr double kWeakestCentre = 0.80;  // the centre-point, which blur weakens less

/// What a dot takes of the paper's light.
struct Absorbance {
  Eigen::Array3d value = Eigen::Array3d::Zero();
  Eigen::Array3d variance = Eigen::Array3d::Zero();

  double strength() const { return value.maxCoeff(); }
  double greyness() const { return value.minCoeff() / std::max(strength(), 1e-6); }
};

using Ring = std::array<Absorbance, kDotsPerRing>;

Absorbance absorbance_of(const ColourLevels& levels) {
  const Eigen::Array3d ground = levels.ground.max(1.0);
  return {1.0 - levels.dot / ground, (levels.dot_sigma / ground).square()};
}

double normal_share(double t) {
  return 0.5 * std::erfc(-t / std::sqrt(2.0));
}

struct Decision {
  DotColour colour = DotColour::black;
  double probability = 0.0;
};

/// The tint of the black point: what its channels absorb, the most absorbed one 1.
Eigen::Array3d tint_of(const Absorbance& black) {
  return (black.value / std::max(black.strength(), 1e-6)).max(0.5);
}

Absorbance balanced(const Absorbance& dot, const Eigen::Array3d& tint) {
  return {dot.value / tint, dot.variance / tint.square()};
}

/// The colour of a dot in balanced light.
Decision decide(const Absorbance& dot) {
  Eigen::Index most = 0;
  Eigen::Index least = 0;
  const double strength = dot.value.maxCoeff(&most);
  if (strength < kMinStrength) return {};
  const Eigen::Array3d ratio = dot.value / strength;
  ratio.minCoeff(&least);
  const Eigen::Array3d variance = dot.variance / (strength * strength) + kFloor * kFloor;
  const auto probability_of = [&](double margin, double var) {
    return normal_share(margin / std::sqrt(var));
  };
  const double least_ratio = ratio[least];
  const double var = variance[least] + least_ratio * least_ratio * variance[most];
  if (least_ratio > kBlackAbove)
    return {DotColour::black, probability_of(least_ratio - kBlackAbove, var)};
  const Eigen::Index middle = 3 - least - most;
  return {static_cast<DotColour>(least + 1),
          probability_of(kBlackAbove - least_ratio, var) *
              probability_of(ratio[middle] - least_ratio, variance[middle] + variance[least])};
}

bool agree(const Absorbance& a, const Absorbance& b) {
  const double strength = std::max({a.strength(), b.strength(), 1e-6});
  const Eigen::Array3d limit =
      kTwinTolerance + kTwinSigmas * (a.variance + b.variance).sqrt() / strength;
  return ((a.value - b.value).abs() / strength < limit).all();
}

Absorbance combine(const Absorbance& a, const Absorbance& b) {
  constexpr double kTiny = 1e-8;
  const Eigen::Array3d wa = 1.0 / (a.variance + kTiny);
  const Eigen::Array3d wb = 1.0 / (b.variance + kTiny);
  return {(wa * a.value + wb * b.value) / (wa + wb), 1.0 / (wa + wb)};
}

struct RingReading {
  ReadStatus status = ReadStatus::read;
  Ring places;
};

/// The ring's places, read from either ring or both.
RingReading read_ring(const DotLevels& dots) {
  RingReading ring;
  for (std::size_t i = 0; i < kDotsPerRing; ++i) {
    const auto& outer = dots[1 + i];
    const auto& inner = dots[1 + kDotsPerRing + i];
    if (!outer && !inner) {
      ring.status = ReadStatus::incomplete;
      continue;
    }
    ring.places[i] = absorbance_of(outer ? *outer : *inner);
    if (!outer || !inner) continue;
    const Absorbance twin = absorbance_of(*inner);
    if (!agree(ring.places[i], twin)) {
      ring.status = ReadStatus::doubtful;
      return ring;
    }
    ring.places[i] = combine(ring.places[i], twin);
  }
  return ring;
}

double median_strength(const Ring& ring) {
  std::array<double, kDotsPerRing> strengths{};
  std::transform(ring.begin(), ring.end(), strengths.begin(),
                 [](const Absorbance& dot) { return dot.strength(); });
  std::nth_element(strengths.begin(), strengths.begin() + kDotsPerRing / 2, strengths.end());
  return strengths[kDotsPerRing / 2];
}

/// The place of the black point, the greyest; nothing when that isn't black.
std::optional<std::size_t> black_place(const Ring& ring) {
  const auto greyest = std::max_element(
      ring.begin(), ring.end(),
      [](const Absorbance& a, const Absorbance& b) { return a.greyness() < b.greyness(); });
  if (greyest->greyness() < kGreyest || greyest->strength() < kWeakestBlack * median_strength(ring))
    return std::nullopt;
  return static_cast<std::size_t>(greyest - ring.begin());
}

struct Decoding {
  std::optional<PatternColours> colours;  ///< none when a second place is black
  double probability = 1.0;
};

Decoding decide_all(const Ring& ring, std::size_t first, const Absorbance& centre) {
  const Eigen::Array3d tint = tint_of(ring[first]);
  Decoding decoding;
  const Decision middle = decide(balanced(centre, tint));
  PatternColours colours;
  colours.centre = middle.colour;
  decoding.probability = middle.probability;
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const Decision decision = decide(balanced(ring[(first + i) % ring.size()], tint));
    if (decision.colour == DotColour::black) return decoding;
    colours.ring[i] = decision.colour;
    decoding.probability *= decision.probability;
  }
  decoding.colours = colours;
  return decoding;
}

}  // namespace

CodeReading read_code(const DotLevels& dots, double min_confidence) {
  CodeReading reading;
  const RingReading ring = read_ring(dots);
  reading.status = ring.status;
  if (reading.status != ReadStatus::read) return reading;
  reading.status = dots[0] ? ReadStatus::doubtful : ReadStatus::incomplete;
  if (!dots[0]) return reading;

  const auto first = black_place(ring.places);
  const Absorbance centre = absorbance_of(*dots[0]);
  if (!first || centre.strength() < kWeakestCentre * median_strength(ring.places)) return reading;
  const Decoding decoding = decide_all(ring.places, *first, centre);
  if (!decoding.colours) return reading;
  reading.confidence = decoding.probability;
  if (reading.confidence < min_confidence) return reading;
  reading.status = ReadStatus::read;
  reading.first = static_cast<int>(*first);
  reading.code = decode(*decoding.colours);
  return reading;
}

bool looks_like(const ColourLevels& levels, const ColourLevels& black, DotColour colour) {
  return decide(balanced(absorbance_of(levels), tint_of(absorbance_of(black)))).colour == colour;
}

}  // namespace vigia::tracking
