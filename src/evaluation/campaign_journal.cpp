#include "vigia/evaluation/campaign_journal.hpp"

#include "checked_line.hpp"
#include "mission_line.hpp"
#include "score_json.hpp"

#include <sstream>

#include <fmt/format.h>
#include <unistd.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"
#include "vigia/evaluation/provenance.hpp"

namespace vigia::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader = "campaign.json";
constexpr const char* kJournal = "journal.jsonl";

std::string header_text(const Campaign& campaign) {
  Json header{{"campaign", campaign.name},
              {"version", VIGIA_VERSION},
              {"build", build_fingerprint()},
              {"command", campaign.command},
              {"arms", Json::array()}};
  for (const Arm& arm : campaign.arms)
    header["arms"].push_back(
        {{"name", arm.name}, {"mission", fingerprint(arm.setup.resolved_yaml)}});
  return header.dump(2) + "\n";
}

/// The first line of @p text that @p other lacks, wherever: an override may move a key.
std::string first_line_not_in(const std::string& text, const std::string& other) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (("\n" + other).find("\n" + line + "\n") == std::string::npos)
      return line.substr(std::min(line.find_first_not_of(' '), line.size()));
  return "";
}

/// What two resolved missions differ in.
std::string first_difference(const std::string& before, const std::string& now) {
  return fmt::format("\"{}\" there, \"{}\" now", first_line_not_in(before, now),
                     first_line_not_in(now, before));
}

/// Whether nothing but a beginning of ours stands in the folder.
bool is_ours(const fs::path& folder) {
  if (fs::exists(folder / kHeader)) return true;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != std::string(kHeader) + ".part") return false;
  return true;
}

void write_missions(const fs::path& folder, const Campaign& campaign) {
  fs::create_directories(folder / "missions");
  for (std::size_t i = 0; i < campaign.arms.size(); ++i)
    if (!fs::exists(folder / mission_file(i)))
      write_file(folder / mission_file(i), campaign.arms[i].setup.resolved_yaml);
}

void forget(const fs::path& folder) {
  // The header goes last: until then the folder is known for ours.
  for (const char* name :
       {kJournal, "missions", "results.csv", "summary.json", "table.md", "arms.png", kHeader})
    fs::remove_all(folder / name);
}

}  // namespace

CampaignJournal::CampaignJournal(const fs::path& folder, const Campaign& campaign, bool restart)
    : folder_(folder), campaign_(campaign) {
  try {
    fs::create_directories(folder_);
    if (!is_ours(folder_))
      throw InputError("the folder " + folder_.string() + " holds no " + kHeader +
                       ", so it is not one of ours; choose another --out");
    lock_ = lock_folder(folder_);
    if (restart) forget(folder_);
    const std::string header = header_text(campaign);
    if (fs::exists(folder_ / kHeader))
      check_header(header);
    else
      write_file(folder_ / kHeader, header);
    write_missions(folder_, campaign);
    read();
  } catch (const fs::filesystem_error& error) {
    throw InputError("cannot use the folder " + folder_.string() + ": " + error.code().message());
  }
}

void CampaignJournal::check_header(const std::string& header) const {
  const std::string there = read_bytes(folder_ / kHeader);
  if (there == header) return;
  const std::string refusal = folder_.string() + " holds another campaign: ";
  const std::string advice = "; choose another --out, or begin anew with --restart";
  const Json before = Json::parse(there, nullptr, false);
  const Json now = Json::parse(header);
  if (before.is_discarded() || !before.is_object() || !before.contains("arms"))
    throw InputError(refusal + kHeader + " is damaged" + advice);
  for (const char* key : {"campaign", "version", "build"})
    if (before.value(key, "") != now[key])
      throw InputError(fmt::format("{}its {} is {}, now it is {}{}", refusal, key,
                                   before.value(key, ""), now[key].get<std::string>(), advice));
  if (before["arms"].size() != now["arms"].size())
    throw InputError(fmt::format("{}it has {} arms, now there are {}{}", refusal,
                                 before["arms"].size(), now["arms"].size(), advice));
  for (std::size_t i = 0; i < campaign_.arms.size(); ++i) {
    if (before["arms"][i] == now["arms"][i]) continue;
    throw InputError(fmt::format("{}the mission of arm \"{}\" differs: {}{}", refusal,
                                 campaign_.arms[i].name,
                                 first_difference(read_bytes(folder_ / mission_file(i)),
                                                  campaign_.arms[i].setup.resolved_yaml),
                                 advice));
  }
}

void CampaignJournal::read() {
  const fs::path file = folder_ / kJournal;
  journal_ = open_to_append(file);
  const std::string text = read_bytes(file);
  std::size_t begin = 0;
  for (int number = 1; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const auto mission = end < text.size()
                             ? read_mission_line(std::string_view(text).substr(begin, end - begin))
                             : std::nullopt;
    if (!mission) {
      if (end + 1 < text.size())
        throw InputError({file.string(), number, 1},
                         "this line is damaged, and it is not the last; mend or delete it");
      if (::ftruncate(journal_.get(), static_cast<off_t>(begin)) != 0) fail("mend", file);
      return;
    }
    finished_[mission->task] = mission->score;
    begin = end + 1;
  }
}

void CampaignJournal::append(const CampaignTask& task, const DriveScore& score) {
  append_line(journal_, mission_line(task, score), folder_ / kJournal);
  finished_[task] = score;
}

}  // namespace vigia::evaluation
