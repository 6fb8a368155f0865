#include "vigia/evaluation/campaign_journal.hpp"

#include "checked_line.hpp"
#include "score_json.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"

namespace vigia::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader = "campaign.json";
constexpr const char* kJournal = "journal.jsonl";

std::string read_bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

[[noreturn]] void fail(const std::string& what, const fs::path& path) {
  throw InputError(fmt::format("cannot {} {}: {}", what, path.string(), std::strerror(errno)));
}

/// Tells the program from any other that was built from other sources.
std::string build_fingerprint() {
  return fingerprint(read_bytes("/proc/self/exe"));
}

std::string header_text(const Campaign& campaign) {
  Json header{{"campaign", campaign.name},
              {"version", VIGIA_VERSION},
              {"build", build_fingerprint()},
              {"arms", Json::array()}};
  for (const Arm& arm : campaign.arms)
    header["arms"].push_back(
        {{"name", arm.name}, {"mission", fingerprint(arm.setup.resolved_yaml)}});
  return header.dump(2) + "\n";
}

std::string mission_file(std::size_t arm) {
  return fmt::format("missions/{:03}.yaml", arm);
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

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

CampaignJournal::CampaignJournal(const fs::path& folder, const Campaign& campaign, bool restart)
    : folder_(folder), campaign_(campaign) {
  try {
    fs::create_directories(folder_);
    if (!is_ours(folder_))
      throw InputError("the folder " + folder_.string() + " holds no " + kHeader +
                       ", so it is not one of ours; choose another --out");
    lock();
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

void CampaignJournal::lock() {
  // The kernel drops the lock with the process, however that ends.
  lock_ = Descriptor(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock_.get() < 0) fail("open", folder_);
  if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0)
    throw InputError("another process is at work in " + folder_.string());
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
  journal_ = Descriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (journal_.get() < 0) fail("open", file);
  const std::string text = read_bytes(file);
  std::size_t begin = 0;
  for (int number = 1; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const auto object = end < text.size()
                            ? unchecked(std::string_view(text).substr(begin, end - begin))
                            : std::nullopt;
    if (!object) {
      if (end + 1 < text.size())
        throw InputError({file.string(), number, 1},
                         "this line is damaged, and it is not the last; mend or delete it");
      if (::ftruncate(journal_.get(), static_cast<off_t>(begin)) != 0) fail("mend", file);
      return;
    }
    const Json line = Json::parse(*object);
    const DriveScore score = score_from_json(line.at("score"));
    finished_[{line.at("arm").get<std::size_t>(), score.seed}] = score;
    begin = end + 1;
  }
}

void CampaignJournal::append(const CampaignTask& task, const DriveScore& score) {
  const std::string line =
      checked_line(fmt::format("{{\"arm\":{},\"score\":{}}}", task.arm, score_record(score)));
  // One call: lines of an interrupted process are whole or the last.
  std::string_view rest = line;
  while (!rest.empty()) {
    const ssize_t written = ::write(journal_.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", folder_ / kJournal);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  finished_[task] = score;
}

}  // namespace vigia::evaluation
