#include "vigia/evaluation/paper_table.hpp"

#include "json.hpp"

#include <cmath>

#include <fmt/format.h>

#include "vigia/evaluation/text_table.hpp"

namespace vigia::evaluation {
namespace {

template <typename Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Three significant digits without an exponent.
std::string figure(double value) {
  const double size = std::abs(value);
  if (size >= 100.0) return fmt::format("{:.0f}", value);
  if (size >= 10.0) return fmt::format("{:.1f}", value);
  if (size >= 1.0 || value == 0.0) return fmt::format("{:.2f}", value);
  return fmt::format("{:.3g}", value);
}

std::string cell(const std::optional<double>& value, const std::optional<Interval>& interval = {}) {
  if (!value) return "–";
  if (!interval) return figure(*value);
  return fmt::format("{} [{}, {}]", figure(*value), figure(interval->low), figure(interval->high));
}

Json row_json(const PaperRow& row) {
  Json json{{"quantity", row.quantity},
            {"unit", row.unit},
            {"published", or_null(row.published)},
            {"as_published", or_null(row.as_published)},
            {"best", or_null(row.best)},
            {"limit", or_null(row.limit)},
            {"n", or_null(row.n)}};
  if (row.as_published_95)
    json["as_published_95"] = {row.as_published_95->low, row.as_published_95->high};
  if (row.best_95) json["best_95"] = {row.best_95->low, row.best_95->high};
  return json;
}

}  // namespace

std::string paper_table_json(const PaperTable& table) {
  Json json{{"paper", table.paper}, {"noise", Json::object()}, {"rows", Json::array()}};
  for (const auto& [name, value] : table.noise) json["noise"][name] = value;
  for (const auto& row : table.rows) json["rows"].push_back(row_json(row));
  if (!table.remarks.empty()) json["remarks"] = table.remarks;
  return json.dump(2) + "\n";
}

std::string paper_table_text(const PaperTable& table) {
  TextRows rows{{"quantity", "unit", "published", "as published", "best", "limit", "n"}};
  for (const auto& row : table.rows)
    rows.push_back({row.quantity, row.unit, cell(row.published),
                    cell(row.as_published, row.as_published_95), cell(row.best, row.best_95),
                    cell(row.limit), row.n ? std::to_string(*row.n) : "–"});
  std::string text = table.paper + "\n\n" + aligned_table(rows) + "\nnoise:";
  for (const auto& [name, value] : table.noise)
    text += fmt::format("{}{} = {}", &value == &table.noise.front().second ? " " : ", ", name,
                        figure(value));
  text += '\n';
  for (const auto& remark : table.remarks) text += remark + '\n';
  return text;
}

}  // namespace vigia::evaluation
