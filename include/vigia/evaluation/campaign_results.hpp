#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "vigia/evaluation/metrics.hpp"

namespace vigia::evaluation {

/// How a figure is distributed over missions.
struct Distribution {
  double low = 0.0;  ///< 5 % quantile
  double quartile_1 = 0.0;
  double median = 0.0;
  double quartile_3 = 0.0;
  double high = 0.0;  ///< 95 % quantile
  double max = 0.0;
};

/// Quantiles by linear interpolation between the order statistics. Throws std::invalid_argument
/// without values.
Distribution distribution(std::vector<double> values);

/// A mission's root-mean-square error beside that of its bound, m.
struct ErrorOverBound {
  double bound_m = 0.0;
  double error_m = 0.0;
};

/// What results.csv holds of an arm's missions, by the primary localizer's rows.
struct ArmResults {
  std::string name;
  std::size_t missions = 0;
  std::map<std::string, int> outcomes;
  std::map<std::string, std::vector<double>> figures;  ///< position_rmse_m and others, by column
  std::vector<ErrorOverBound> errors;
};

/// Reads a campaign's results.csv, whose columns may come in any order. Arms are in order of their
/// first rows. Throws InputError, which names line and column, for one that was cut off or is none.
std::vector<ArmResults> read_results(const std::filesystem::path& csv);

}  // namespace vigia::evaluation
