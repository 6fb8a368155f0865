#include "campaign_figures.hpp"

#include "object_file.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "vigia/core/error.hpp"
#include "vigia/evaluation/campaign_results.hpp"
#include "vigia/report/campaign_page.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json summary_of(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  ObjectFile summary = object_in(file);
  if (!summary.fault.empty())
    throw InputError(fmt::format("{} is no campaign's folder: {}; `vigia evaluate` makes one",
                                 folder.string(), summary.fault));
  const auto arms = summary.values.find("arms");
  if (arms == summary.values.end() || !arms->is_array() || arms->empty())
    throw InputError(file.string() + ": has no list 'arms', must be a campaign's");
  return std::move(summary.values);
}

/// What keeps the table from being read, for the page to say; nothing when it can be.
std::optional<std::string> table_fault(const fs::path& csv) {
  constexpr std::uintmax_t kMaxBytes = 1U << 30U;
  std::error_code missing;
  const auto bytes = fs::file_size(csv, missing);
  if (missing) return "There is no results.csv: distributions are left out.";
  if (bytes > kMaxBytes)
    return fmt::format(
        "results.csv has {:.1f} GB, more than the page reads (1.1): distributions are left out.",
        static_cast<double>(bytes) * 1e-9);
  return std::nullopt;
}

Json share_json(const std::string& name, int count, int of) {
  const auto interval = evaluation::clopper_pearson(count, of);
  return {
      {"name", name}, {"count", count}, {"of", of}, {"low", interval.low}, {"high", interval.high}};
}

Json box_json(const evaluation::Distribution& d) {
  return {{"low", d.low},       {"q1", d.quartile_1}, {"median", d.median},
          {"q3", d.quartile_3}, {"high", d.high},     {"max", d.max}};
}

/// At most @p most of the missions, evenly.
Json points_json(const std::vector<evaluation::ErrorOverBound>& errors, std::size_t most) {
  Json points = Json::array();
  const std::size_t step = std::max<std::size_t>(1, (errors.size() + most - 1) / most);
  for (std::size_t i = 0; i < errors.size(); i += step)
    points.push_back({errors[i].bound_m, errors[i].error_m});
  return points;
}

Json results_json(const fs::path& csv) {
  constexpr std::size_t kPoints = 3000;
  Json list = Json::array();
  const auto arms = evaluation::read_results(csv);
  std::set<std::string> outcome_names;
  for (const auto& arm : arms)
    for (const auto& [name, count] : arm.outcomes) outcome_names.insert(name);
  for (const auto& arm : arms) {
    Json outcomes = Json::array();
    Json boxes = Json::object();
    for (const std::string& name : outcome_names) {
      const auto at = arm.outcomes.find(name);
      const int count = at == arm.outcomes.end() ? 0 : at->second;
      outcomes.push_back(share_json(name, count, static_cast<int>(arm.missions)));
    }
    for (const auto& [figure, values] : arm.figures)
      boxes[figure] = box_json(evaluation::distribution(values));
    const std::size_t most = std::max<std::size_t>(10, kPoints / arms.size());
    list.push_back({{"name", arm.name},
                    {"outcomes", outcomes},
                    {"boxes", boxes},
                    {"points", points_json(arm.errors, most)}});
  }
  return list;
}

/// By the number of missions of an arm.
Json bands_json(const Json& arms) {
  constexpr std::int64_t kMostRuns = 100'000'000;
  Json bands = Json::object();
  for (const Json& arm : arms) {
    const auto runs = arm.is_object() ? arm.find("runs") : arm.end();
    if (!arm.is_object() || runs == arm.end() || !runs->is_number_integer()) continue;
    const auto count = runs->get<std::int64_t>();
    if (count < 1 || count > kMostRuns) continue;
    const auto band = evaluation::anees_band(static_cast<int>(count), 3);
    bands[std::to_string(count)] = {{"low", band.low}, {"high", band.high}};
  }
  return bands;
}

std::string text_of(const Json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>() : std::string();
}

std::string subtitle_of(const Json& summary) {
  const Json seeds = summary.value("seeds", Json::object());
  const bool known = seeds.is_object() && seeds.contains("count") && seeds.contains("first");
  return fmt::format(
      "{} arm{}{}", summary["arms"].size(), summary["arms"].size() == 1 ? "" : "s",
      known ? fmt::format(" × {} seeds from {}", seeds["count"].dump(), seeds["first"].dump())
            : "");
}

}  // namespace

std::string campaign_page_of(const fs::path& folder) {
  const Json summary = summary_of(folder);
  const std::string title = "Campaign " + text_of(summary, "campaign");
  Json data{{"title", title},
            {"subtitle", subtitle_of(summary)},
            {"results", Json::array()},
            {"bands", bands_json(summary["arms"])},
            {"notes", Json::array()}};
  if (const auto fault = table_fault(folder / "results.csv")) {
    spdlog::warn("{}: {}", folder.string(), *fault);
    data["notes"].push_back(*fault);
  } else {
    data["results"] = results_json(folder / "results.csv");
  }
  data["summary"] = summary;
  return report::campaign_page(title, data.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace vigia::app
