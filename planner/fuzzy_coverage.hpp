#pragma once

#include "fll_reader.hpp"

namespace vigia::planner {

/// Throws InputError when there are inputs within the ranges that no rule covers: the centroid of
/// nothing is no number. Checked at every corner of the terms and half-way between, in all
/// combinations: the shapes are straight or positive in between.
void check_coverage(const FllSystem& system);

}  // namespace vigia::planner
