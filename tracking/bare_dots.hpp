#pragma once

#include "dot_fit.hpp"

#include <array>

#include "vigia/core/colour_pattern.hpp"

namespace vigia::tracking {

/// How unlike a bare dot each dot looks that is seen whole, measured by the ring's others: 1 is
/// rare among bare ones. Something of another ink that covers a dot to within some tenths of a
/// pixel leaves a sickle of it, which moves the channels' centres apart, makes the pixels differ
/// from the fitted profile, and moves the common rim; what camera and light do, they do to all
/// dots.
/// @p expected are the outlines as the plane has them, by place; @p shift is the lens's part.
std::array<double, kPatternDots> oddness_of(const std::array<DotFit, kPatternDots>& dots,
                                            const std::array<EllipseShape, kPatternDots>& expected,
                                            const ChromaticShift& shift);

/// By how many px the rim of @p shape lies outside that of @p expected, in the mean.
double growth_of(const EllipseShape& shape, const EllipseShape& expected);

}  // namespace vigia::tracking
