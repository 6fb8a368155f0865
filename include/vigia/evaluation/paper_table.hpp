#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vigia/evaluation/metrics.hpp"

namespace vigia::evaluation {

/// A quantity of a paper's experiment. Empty where a column does not apply.
struct PaperRow {
  std::string quantity = {};
  std::string unit = {};
  std::optional<double> published = {};     ///< as printed in the paper
  std::optional<double> as_published = {};  ///< measured here with the paper's own method
  std::optional<double> best = {};   ///< measured here with the best method, on the same images
  std::optional<double> limit = {};  ///< the Cramér–Rao bound for the noise that was set
  std::optional<int> n = {};         ///< drives, images or trials behind the measured figures
  std::optional<Interval> as_published_95 = {};  ///< 95 % intervals of the measured figures
  std::optional<Interval> best_95 = {};
};

/// A paper's figures beside ours. No figure is reported without the noise that it was got under.
struct PaperTable {
  std::string paper = {};                                  ///< its short name, e.g. "armingol"
  std::vector<std::pair<std::string, double>> noise = {};  ///< name with its unit, value
  std::vector<PaperRow> rows = {};
  std::vector<std::string> remarks = {};  ///< what a reader must know beside the figures
};

/// table.json: {"paper", "noise", "rows": [{quantity, unit, published, as_published, best, limit,
/// n}]}, null where a column does not apply; "as_published_95" and "best_95" are [low, high] where
/// an interval is known, "remarks" a list.
std::string paper_table_json(const PaperTable& table);

/// The same as aligned text, three significant digits.
std::string paper_table_text(const PaperTable& table);

}  // namespace vigia::evaluation
