#include "vigia/evaluation/campaign_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "vigia/core/error.hpp"

namespace vigia::evaluation {
namespace {

constexpr const char* kFigures[] = {"position_rmse_m", "position_max_m", "position_final_m"};

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// The table's lines, each as its cells, with what a message needs.
class ResultsTable {
 public:
  explicit ResultsTable(const std::filesystem::path& file) : file_(file), stream_(file) {
    if (!stream_) throw InputError(file.string() + ": cannot be read");
    if (!next()) throw InputError(file.string() + ":1: is empty, must be a campaign's results");
    for (std::size_t c = 0; c < cells_.size(); ++c) column_.emplace(cells_[c], c);
    columns_ = cells_.size();
  }

  /// Goes on to the next row.
  bool next() {
    if (!std::getline(stream_, line_)) return false;
    ++number_;
    const bool cut_off = stream_.eof();
    cells_ = cells_of(line_);
    if (cut_off || (number_ > 1 && cells_.size() != columns_))
      throw InputError(fmt::format(
          "{}:{}: is cut off: found {} cells{}, must be {} and a line feed", file_.string(),
          number_, cells_.size(), cut_off ? " without a line feed" : "", columns_));
    return true;
  }

  std::string text(const std::string& column) const { return std::string(cells_[index(column)]); }

  double number(const std::string& column) const {
    const std::string cell = text(column);
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    if (cell.empty() || *end != '\0')
      throw InputError(fmt::format("{}:{}: {}: found '{}', must be a number", file_.string(),
                                   number_, column, cell));
    return value;
  }

 private:
  std::size_t index(const std::string& column) const {
    const auto at = column_.find(column);
    if (at == column_.end())
      throw InputError(
          fmt::format("{}:1: has no column '{}': written by another version; `vigia "
                      "evaluate` or `vigia campaign merge` writes it anew",
                      file_.string(), column));
    return at->second;
  }

  std::filesystem::path file_;
  std::ifstream stream_;
  std::string line_;
  std::vector<std::string_view> cells_;
  std::map<std::string, std::size_t, std::less<>> column_;
  std::size_t columns_ = 0;
  std::size_t number_ = 0;
};

void add_row(ArmResults& arm, const ResultsTable& row) {
  ++arm.missions;
  ++arm.outcomes[row.text("outcome")];
  for (const char* figure : kFigures) {
    const double value = row.number(figure);
    if (std::isfinite(value)) arm.figures[figure].push_back(value);
  }
  arm.errors.push_back({row.number("pcrlb_position_rms_m"), row.number("position_rmse_m")});
}

}  // namespace

Distribution distribution(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("a distribution has values");
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double share) {
    const double at = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {quantile(0.05), quantile(0.25), quantile(0.5),
          quantile(0.75), quantile(0.95), values.back()};
}

std::vector<ArmResults> read_results(const std::filesystem::path& csv) {
  ResultsTable table(csv);
  std::vector<ArmResults> arms;
  std::map<std::string, std::size_t> places;
  while (table.next()) {
    if (table.text("localizer") != table.text("primary")) continue;
    const auto [place, fresh] = places.emplace(table.text("arm"), arms.size());
    if (fresh) arms.push_back({place->first, 0, {}, {}, {}});
    add_row(arms[place->second], table);
  }
  return arms;
}

}  // namespace vigia::evaluation
