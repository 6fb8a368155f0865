#include "assignment.hpp"

#include <algorithm>
#include <tuple>

namespace vigia::tracking {

std::vector<std::optional<std::size_t>> assign_nearest(
    std::size_t rows, std::size_t columns,
    const std::function<std::optional<double>(std::size_t, std::size_t)>& cost) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      if (const auto c = cost(i, j)) pairs.emplace_back(*c, i, j);
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::optional<std::size_t>> column_of(rows);
  std::vector<bool> taken(columns, false);
  for (const auto& [c, i, j] : pairs) {
    if (column_of[i] || taken[j]) continue;
    column_of[i] = j;
    taken[j] = true;
  }
  return column_of;
}

}  // namespace vigia::tracking
