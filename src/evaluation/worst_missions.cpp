#include "vigia/evaluation/worst_missions.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "vigia/core/shell.hpp"
#include "vigia/evaluation/provenance.hpp"
#include "vigia/evaluation/text_table.hpp"

namespace vigia::evaluation {

std::vector<WorstMission> worst_missions(const std::vector<std::vector<DriveScore>>& scores,
                                         std::size_t count) {
  std::vector<WorstMission> all;
  for (std::size_t arm = 0; arm < scores.size(); ++arm)
    for (const DriveScore& score : scores[arm])
      all.push_back(
          {{arm, score.seed}, score.outcome, score.localizers.at(score.primary).position_max_m});
  const auto rank = [](const WorstMission& m) {
    return std::make_tuple(m.outcome == mission::Outcome::arrived, -m.position_max_m, m.task.seed,
                           m.task.arm);
  };
  const std::size_t kept = std::min(count, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept), all.end(),
                    [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  all.resize(kept);
  return all;
}

std::string repeat_command(const CampaignTask& task, const std::filesystem::path& folder) {
  const auto file = (folder / mission_file(task.arm)).lexically_normal();
  return fmt::format("vigia run {} --seed {}", shell_word(file.string()), task.seed);
}

std::string worst_missions_text(const Campaign& campaign, const std::vector<WorstMission>& worst,
                                const std::filesystem::path& folder) {
  TextRows rows{{"worst", "outcome", "path max cm", "again"}};
  for (const WorstMission& m : worst)
    rows.push_back({campaign.arms[m.task.arm].name, std::string(to_string(m.outcome)),
                    fmt::format("{:.1f}", 100 * m.position_max_m), repeat_command(m.task, folder)});
  return aligned_table(rows, Cells::words);
}

}  // namespace vigia::evaluation
