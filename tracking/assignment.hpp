#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace vigia::tracking {

/// Pairs @p rows things with @p columns others, each at most once: the cheapest pair first, then
/// the cheapest of what is left. @p cost gives nothing for a pair that can't be. The result has for
/// each row its column, or nothing.
std::vector<std::optional<std::size_t>> assign_nearest(
    std::size_t rows, std::size_t columns,
    const std::function<std::optional<double>(std::size_t, std::size_t)>& cost);

}  // namespace vigia::tracking
