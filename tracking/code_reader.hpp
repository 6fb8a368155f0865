#pragma once

#include "dot_fit.hpp"

#include <array>
#include <optional>

#include "vigia/core/colour_pattern.hpp"

namespace vigia::tracking {

/// The levels of the dots that are seen whole, by their places.
using DotLevels = std::array<std::optional<ColourLevels>, kPatternDots>;

enum class ReadStatus {
  read,
  incomplete,  ///< a place of the code without a dot, or no centre-point
  doubtful,    ///< a colour near the border between two, or rings that disagree
};

struct CodeReading {
  ReadStatus status = ReadStatus::incomplete;
  PatternCode code;
  int first = 0;            ///< how many eighths of a turn the black point lies after place 1
  double confidence = 0.0;  ///< probability that every colour is right
};

/// Reads a code from what the dots absorb: 1 − (level over the paper's), channel by channel. Blur
/// makes all channels of a dot absorb less by the same factor, so a colour is told by the channels'
/// ratios alone, whatever the dot's size and whether a camera's response came after the blur: a
/// response that is the same for all channels keeps grey grey and the order of the channels.
/// The black point is the place that absorbs all channels alike; what is left of a tint there
/// (glare under coloured light) is taken out of all dots. It must absorb as much as the coloured
/// dots of its size do. A dot is black when the least absorbed channel comes near the most absorbed
/// one, else the least absorbed channel names its colour. Dots of one place in both rings must
/// agree. Each decision's probability is that of a normal error, of the levels' noise and of a
/// floor for inks and colour interpolation, staying on its side of the border.
CodeReading read_code(const DotLevels& dots, double min_confidence);

/// Whether a dot, whose colour is known, looks like it; @p black are the levels of a black dot.
bool looks_like(const ColourLevels& levels, const ColourLevels& black, DotColour colour);

}  // namespace vigia::tracking
