#include "code_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vigia::tracking {
namespace {

// Of the most absorbed channel, like all ratios here.
constexpr double kGreyest = 0.75;      // least absorbed channel of the black point, tinted by light
constexpr double kSecondBlack = 0.88;  // the same of a second black one in the ring, balanced
constexpr double kGreyestInk = 0.66;   // the same of a colour that the ring doesn't show
constexpr double kBlackAbove = 0.78;   // the same of black, where there is no ring to compare
constexpr double kColoursApart = 0.3;  // two colours' least and next channels
constexpr double kGreenAhead = 0.08;   // green inks take much blue, blue ones little: their border
constexpr double kFloor = 0.03;        // σ of inks and colour interpolation
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

/// The channels of a dot in balanced light, of the most absorbed one.
struct Ratios {
  DotColour colour = DotColour::black;  ///< unless the dot is black
  double margin = 0.0;                  ///< to the colour next to it
  double margin_variance = 0.0;
  double least = 0.0;  ///< the least absorbed channel
  double least_variance = 0.0;
  bool faint = false;
};

/// @p floor is the variance of a channel's ratio beside noise.
Ratios ratios_of(const Absorbance& dot, double floor) {
  Eigen::Index most = 0;
  Eigen::Index least = 0;
  const double strength = std::max(dot.value.maxCoeff(&most), 1e-6);
  const Eigen::Array3d ratio = dot.value / strength;
  const Eigen::Array3d variance = dot.variance / (strength * strength) + floor;
  Ratios out;
  out.least = ratio.minCoeff(&least);
  out.least_variance = variance[least] + out.least * out.least * variance[most];
  out.faint = strength < kMinStrength;
  Eigen::Array3d ordered = ratio - kGreenAhead * Eigen::Vector3d::UnitY().array();
  const double lowest = ordered.minCoeff(&least);
  out.colour = static_cast<DotColour>(least + 1);
  ordered[least] = std::numeric_limits<double>::infinity();
  Eigen::Index next = 0;
  out.margin = ordered.minCoeff(&next) - lowest;
  out.margin_variance = variance[least] + variance[next];
  return out;
}

double probability_of(double margin, double variance) {
  return normal_share(margin / std::sqrt(variance));
}

/// Of one of two equally likely classes, @p distance apart, for a value that lies by @p margin on
/// its side of the middle, with a normal error.
double posterior(double margin, double distance, double variance) {
  return 1.0 / (1.0 + std::exp(-margin * distance / variance));
}

/// That a dot which is not black has its colour.
double certainty(const Ratios& dot) {
  return posterior(dot.margin, kColoursApart, dot.margin_variance);
}

/// The colour of a dot; one of the colour that it has unless it is black absorbs @p coloured of its
/// least absorbed channel.
Decision decide(const Ratios& dot, double coloured) {
  if (dot.faint) return {};
  const double off = 0.5 * (1.0 + coloured) - dot.least;
  const double probability = posterior(std::abs(off), 1.0 - coloured, dot.least_variance);
  if (off < 0.0) return {DotColour::black, probability};
  return {dot.colour, probability * certainty(dot)};
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
  std::array<bool, kDotsPerRing> alone{};  ///< read from one of the rings
  double twin_variance = 0.0;              ///< of a ratio of one dot, as twins differ
};

/// Of one ratio of a dot: mean squared difference of the twins' ratios beyond that of their noise.
double excess_of(const Absorbance& a, const Absorbance& b) {
  const auto noise = [](const Absorbance& dot) {
    return dot.variance.sum() / std::max(dot.strength() * dot.strength(), 1e-6);
  };
  const Eigen::Array3d difference =
      a.value / std::max(a.strength(), 1e-6) - b.value / std::max(b.strength(), 1e-6);
  // Two of the three ratios: the most absorbed channel's is 1.
  return 0.5 * (0.5 * difference.square().sum() - (noise(a) + noise(b)) / 3.0);
}

/// The ring's places, read from either ring or both.
RingReading read_ring(const DotLevels& dots) {
  RingReading ring;
  double excess = 0.0;
  int twins = 0;
  for (std::size_t i = 0; i < kDotsPerRing; ++i) {
    const auto& outer = dots[1 + i];
    const auto& inner = dots[1 + kDotsPerRing + i];
    if (!outer && !inner) {
      ring.status = ReadStatus::incomplete;
      continue;
    }
    ring.places[i] = absorbance_of(outer ? *outer : *inner);
    ring.alone[i] = !outer || !inner;
    if (ring.alone[i]) continue;
    const Absorbance twin = absorbance_of(*inner);
    if (!agree(ring.places[i], twin)) {
      ring.status = ReadStatus::doubtful;
      return ring;
    }
    excess += excess_of(ring.places[i], twin);
    ++twins;
    ring.places[i] = combine(ring.places[i], twin);
  }
  if (twins > 0) ring.twin_variance = std::max(0.0, excess / twins);
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

/// The balanced ring: ratios of its places, and of the greyest beside the black one.
struct ColouredRing {
  std::array<Ratios, kDotsPerRing> dots;  ///< from the black point on
  double greyest = 0.0;
};

ColouredRing coloured(const RingReading& ring, std::size_t first, const Eigen::Array3d& tint) {
  ColouredRing out;
  for (std::size_t i = 0; i < kDotsPerRing; ++i) {
    const std::size_t place = (first + i) % kDotsPerRing;
    const double floor = kFloor * kFloor + (ring.alone[place] ? 1.0 : 0.5) * ring.twin_variance;
    out.dots[i] = ratios_of(balanced(ring.places[place], tint), floor);
    if (i > 0) out.greyest = std::max(out.greyest, out.dots[i].least);
  }
  return out;
}

/// What dots of a colour absorb of their least absorbed channel, as the ring shows it.
double least_of(const ColouredRing& ring, DotColour colour) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 1; i < ring.dots.size(); ++i) {
    if (ring.dots[i].colour != colour) continue;
    sum += ring.dots[i].least;
    ++count;
  }
  return count > 0 ? sum / count : kGreyestInk;
}

struct Decoding {
  std::optional<PatternColours> colours;  ///< none when a second place is black, or one faint
  double probability = 1.0;
};

Decoding decide_all(const RingReading& ring, std::size_t first, const Absorbance& centre) {
  const Eigen::Array3d tint = tint_of(ring.places[first]);
  const ColouredRing dots = coloured(ring, first, tint);
  Decoding decoding;
  if (dots.greyest > kSecondBlack) return decoding;
  const Ratios middle = ratios_of(balanced(centre, tint), kFloor * kFloor + ring.twin_variance);
  const Decision decision = decide(middle, least_of(dots, middle.colour));
  PatternColours colours;
  colours.centre = decision.colour;
  decoding.probability = decision.probability;
  const Ratios& black = dots.dots[0];
  for (std::size_t i = 1; i < dots.dots.size(); ++i) {
    const Ratios& dot = dots.dots[i];
    if (dot.faint) return decoding;
    colours.ring[i] = dot.colour;
    decoding.probability *=
        certainty(dot) *
        probability_of(black.least - dot.least, black.least_variance + dot.least_variance);
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
  const Decoding decoding = decide_all(ring, *first, centre);
  if (!decoding.colours) return reading;
  reading.confidence = decoding.probability;
  if (reading.confidence < min_confidence) return reading;
  reading.status = ReadStatus::read;
  reading.first = static_cast<int>(*first);
  reading.code = decode(*decoding.colours);
  return reading;
}

bool looks_like(const ColourLevels& levels, const ColourLevels& black, DotColour colour) {
  const Ratios dot =
      ratios_of(balanced(absorbance_of(levels), tint_of(absorbance_of(black))), kFloor * kFloor);
  return decide(dot, kGreyestInk).colour == colour;
}

}  // namespace vigia::tracking
