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

/// Reads a code. A dot's reflectance is its level over the paper's, channel by channel; that of the
/// black point is subtracted, and the rest scaled so that paper stays 1. What remains is black
/// below a threshold, else the largest channel names the colour. The black point is the darkest
/// place; it must be grey. Dots of one place in both rings must agree. Each decision's probability
/// is that of a normal error, of the levels' noise and of a floor for uneven inks and light,
/// staying on its side of the border.
CodeReading read_code(const DotLevels& dots, double min_confidence);

/// Whether a dot, whose colour is known, looks like it; @p black is a black dot's reflectance.
bool looks_like(const ColourLevels& levels, const ColourLevels& black, DotColour colour);

}  // namespace vigia::tracking
