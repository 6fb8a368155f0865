#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace vigia {

/// What a colour pattern says of its place (Adán §3.2): 12 floors × 81 rooms × 9 patterns.
struct PatternCode {
  int floor = 0;    ///< 0–11: centre (4 colours) × eighth point (3)
  int room = 0;     ///< 0–80: points two to five
  int pattern = 0;  ///< 0–8: points six and seven
};

bool operator==(const PatternCode& a, const PatternCode& b);
inline bool operator!=(const PatternCode& a, const PatternCode& b) {
  return !(a == b);
}

inline constexpr int kFloors = 12;
inline constexpr int kRooms = 81;
inline constexpr int kPatterns = 9;

enum class DotColour { black, red, green, blue };

/// Adán's pattern: a centre-point and two concentric rings of eight smaller dots on white paper,
/// both with the same code. The first point of each ring is black and lies on the pattern's upward
/// axis; the others follow clockwise as a viewer sees them.
struct PatternShape {
  PatternCode code;
  double outer_radius_m = 0.113;  ///< of the ring that the dots' centres lie on
  double inner_radius_m = 0.072;
  double dot_radius_m = 0.012;
  double centre_radius_m = 0.020;
  double sheet_half_width_m = 0.150;  ///< half the side of the square white paper
};

/// One dot. Labels: 0 the centre-point, 1–8 the outer ring from its first point on, 9–16 the inner.
struct PatternDot {
  int label = 0;
  Eigen::Vector2d centre_l = Eigen::Vector2d::Zero();  ///< (x, y) in the landmark's plane, m
  double radius_m = 0.0;
  DotColour colour = DotColour::black;
};

inline constexpr int kDotsPerRing = 8;
inline constexpr int kPatternDots = 1 + 2 * kDotsPerRing;

/// Colours of the centre-point and of the ring's points one to eight.
struct PatternColours {
  DotColour centre = DotColour::black;
  std::array<DotColour, kDotsPerRing> ring{};
};

/// The colours that say @p code: digits in base 3 (red, green, blue), the most significant first;
/// floor = 3 · centre (black, red, green, blue) + eighth point. Throws std::invalid_argument for a
/// code outside its range.
PatternColours encode(const PatternCode& code);
/// The code that the colours say; the first point must be black and the others must not.
/// Throws std::invalid_argument otherwise.
PatternCode decode(const PatternColours& colours);

/// The same code on a sheet that is @p scale times as large, all measures alike.
PatternShape scaled(PatternShape shape, double scale);

/// All dots of a pattern, in the order of their labels.
std::vector<PatternDot> pattern_dots(const PatternShape& shape);

}  // namespace vigia
