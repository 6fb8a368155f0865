#include "vigia/evaluation/campaign_shard.hpp"

#include "checked_line.hpp"
#include "mission_line.hpp"
#include "provenance_json.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"

namespace vigia::evaluation {
namespace {

namespace fs = std::filesystem;

/// The first line of a shard's files: whose they are.
std::string shard_header(const CampaignPlan& plan, int shard) {
  Json json = provenance_json(plan.provenance);
  json["version"] = VIGIA_VERSION;
  json["build"] = build_fingerprint();
  json["command"] = fmt::format("vigia campaign run-shard . {}", shard);
  json["shard"] = shard;
  json["of"] = plan.shards;
  return checked_line(json.dump());
}

/// The last line of a shard that is finished.
std::string shard_end(std::size_t missions, std::string_view before) {
  const Json json{
      {"missions", missions}, {"bytes", before.size()}, {"checksum", fingerprint(before)}};
  return checked_line(json.dump());
}

std::string_view without_line_feed(std::string_view line) {
  return line.substr(0, line.size() - (line.empty() || line.back() != '\n' ? 0 : 1));
}

Json checked_json(std::string_view line) {
  const auto object = unchecked(without_line_feed(line));
  return object ? Json::parse(*object) : Json();
}

/// What makes a shard's file another one than the plan asks for, "" for nothing.
std::string header_difference(const Json& header, const CampaignPlan& plan, int shard,
                              bool any_version) {
  std::string text = difference(plan.provenance, provenance_from(header), any_version);
  if (!text.empty()) return text;
  const int number = header.value("shard", 0);
  const int of = header.value("of", 0);
  if (number == shard && of == plan.shards) return "";
  return fmt::format("it is shard {} of {}, the plan's is {} of {}", number, of, shard,
                     plan.shards);
}

/// First and last line of a file.
struct Ends {
  std::string first;
  std::string last;
  std::size_t last_begins = 0;
};

Ends ends_of(const fs::path& file) {
  constexpr std::streamoff kTail = 512;  // longer than a last line
  Ends ends;
  std::ifstream stream(file, std::ios::binary);
  std::getline(stream, ends.first);
  stream.clear();
  stream.seekg(0, std::ios::end);
  const std::streamoff size = stream.tellg();
  const std::streamoff from = std::max<std::streamoff>(0, size - kTail);
  stream.seekg(from);
  std::string tail(static_cast<std::size_t>(size - from), '\0');
  stream.read(tail.data(), size - from);
  if (tail.size() < 2 || tail.back() != '\n') return ends;
  const std::size_t before = tail.rfind('\n', tail.size() - 2);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  ends.last = tail.substr(begin);
  ends.last_begins = static_cast<std::size_t>(from) + begin;
  return ends;
}

/// The files in which missions of a shard were collected, of living processes and killed ones.
std::vector<fs::path> parts_of(const fs::path& folder, int shard) {
  const std::string prefix = shard_file(folder, shard).filename().string() + ".part-";
  std::vector<fs::path> parts;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(folder / "shards", gone))
    if (entry.path().filename().string().compare(0, prefix.size(), prefix) == 0)
      parts.push_back(entry.path());
  return parts;
}

using Finished = std::map<CampaignTask, DriveScore>;

/// What the parts of a shard hold of its missions. A line that is not whole is left out.
Finished collected(const fs::path& folder, const CampaignPlan& plan, int shard) {
  Finished finished;
  const std::string header = shard_header(plan, shard);
  for (const fs::path& part : parts_of(folder, shard)) {
    std::ifstream stream(part, std::ios::binary);
    std::string line;
    if (!std::getline(stream, line) || line + "\n" != header) continue;
    while (std::getline(stream, line))
      if (auto mission = read_mission_line(line)) finished[mission->task] = mission->score;
  }
  return finished;
}

std::string shard_text(const CampaignPlan& plan, int shard, const Finished& finished) {
  std::string text = shard_header(plan, shard);
  for (const auto& [task, score] : finished) text += mission_line(task, score);
  return text + shard_end(finished.size(), text);
}

void remove_parts(const fs::path& folder, int shard) {
  std::error_code ignored;
  for (const fs::path& part : parts_of(folder, shard)) fs::remove(part, ignored);
}

/// Collects the missions that are left in a file of this process's own, and gives all of them.
Finished collect(const fs::path& folder, const CampaignPlan& plan, const Campaign& campaign,
                 int shard, int threads, const std::function<void(const CampaignProgress&)>& told) {
  Finished finished = collected(folder, plan, shard);
  const auto range = plan.of_shard(shard);
  std::vector<CampaignTask> tasks;
  for (std::size_t number = range.first; number < range.last; ++number)
    if (finished.count(campaign.task(number)) == 0) tasks.push_back(campaign.task(number));
  const fs::path part = shard_file(folder, shard).string() + own_part_suffix();
  const Descriptor file = open_to_append(part);
  append_line(file, shard_header(plan, shard), part);
  CampaignProgress progress{range.count(), finished.size(), finished.size()};
  if (told) told(progress);
  run_missions(campaign, tasks, threads, [&](const CampaignTask& task, const DriveScore& score) {
    append_line(file, mission_line(task, score), part);
    finished[task] = score;
    ++progress.done;
    if (told) told(progress);
  });
  return finished;
}

[[noreturn]] void report_damage(const fs::path& file, int line, const std::string& what) {
  throw InputError({file.string(), line, 1}, what + "; delete the file and run the shard again");
}

/// Adds the missions of a shard whose state is whole.
void read_shard(const fs::path& folder, const CampaignPlan& plan, const Campaign& campaign,
                int shard, MergedShards& merged) {
  const fs::path file = shard_file(folder, shard);
  const std::string text = read_bytes(file);
  const std::size_t end = text.rfind('\n', text.size() - 2) + 1;
  std::size_t begin = text.find('\n') + 1;
  const Provenance by = provenance_from(checked_json(std::string_view(text).substr(0, begin)));
  merged.programs.insert(fmt::format("{} (build {})", by.version, by.build));
  auto range = plan.of_shard(shard);
  for (int line = 2; begin < end; ++line) {
    const std::size_t next = text.find('\n', begin);
    auto mission = read_mission_line(std::string_view(text).substr(begin, next - begin));
    if (!mission) report_damage(file, line, "this line is damaged");
    const CampaignTask expected =
        range.first < range.last ? campaign.task(range.first++) : CampaignTask{};
    if (mission->task < expected || expected < mission->task)
      report_damage(
          file, line,
          fmt::format("found seed {} of arm {}, must be seed {} of arm {}", mission->task.seed,
                      mission->task.arm, expected.seed, expected.arm));
    merged.finished[mission->task] = std::move(mission->score);
    begin = next + 1;
  }
  if (range.first != range.last) report_damage(file, 1, "missions are missing");
  if (shard_end(plan.of_shard(shard).count(), std::string_view(text).substr(0, end)) !=
      text.substr(end))
    report_damage(file, 1, "its checksum is not that of its last line");
}

/// "3, 7–12"
std::string ranges(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", numbers[i]);
    if (last > i) text += fmt::format("–{}", numbers[last]);
    i = last + 1;
  }
  return text;
}

void require_whole(const fs::path& folder, const CampaignPlan& plan, bool any_version) {
  std::vector<int> absent;
  std::string refused;
  for (const ShardState& state : shard_states(folder, plan, any_version)) {
    if (state.status == ShardStatus::missing || state.status == ShardStatus::begun)
      absent.push_back(state.shard);
    else if (state.status != ShardStatus::whole)
      refused += fmt::format("\n  {}: {}", shard_file(folder, state.shard).string(), state.why);
  }
  if (absent.empty() && refused.empty()) return;
  std::string text = folder.string() + " cannot be merged:";
  if (!absent.empty())
    text += fmt::format("\n  missing of {} shards: {} (`vigia campaign run-shard` drives them)",
                        plan.shards, ranges(absent));
  throw InputError(text + refused);
}

}  // namespace

std::string_view to_string(ShardStatus status) {
  switch (status) {
    case ShardStatus::whole:
      return "whole";
    case ShardStatus::begun:
      return "begun";
    case ShardStatus::missing:
      return "missing";
    case ShardStatus::stale:
      return "stale";
    case ShardStatus::damaged:
      return "damaged";
  }
  return "";
}

fs::path shard_file(const fs::path& folder, int shard) {
  return folder / "shards" / fmt::format("{:05}.jsonl", shard);
}

ShardState shard_state(const fs::path& folder, const CampaignPlan& plan, int shard,
                       bool any_version) {
  ShardState state;
  state.shard = shard;
  if (!fs::exists(shard_file(folder, shard))) {
    state.finished = collected(folder, plan, shard).size();
    state.status = state.finished > 0 ? ShardStatus::begun : ShardStatus::missing;
    return state;
  }
  const Ends ends = ends_of(shard_file(folder, shard));
  const Json header = checked_json(ends.first);
  const Json end = checked_json(ends.last);
  state.status = ShardStatus::damaged;
  if (!header.is_object()) {
    state.why = "its first line is damaged";
    return state;
  }
  state.why = header_difference(header, plan, shard, any_version);
  if (!state.why.empty()) {
    state.status = ShardStatus::stale;
  } else if (!end.is_object() || !end.contains("bytes")) {
    state.why = "it is cut off: its last line is missing or damaged";
  } else if (end["bytes"] != ends.last_begins) {
    state.why = fmt::format("it has {} bytes before its last line, which says {}", ends.last_begins,
                            end["bytes"].get<std::size_t>());
  } else {
    state.status = ShardStatus::whole;
    state.finished = plan.of_shard(shard).count();
  }
  return state;
}

std::vector<ShardState> shard_states(const fs::path& folder, const CampaignPlan& plan,
                                     bool any_version) {
  std::vector<ShardState> states;
  for (int shard = 1; shard <= plan.shards; ++shard)
    states.push_back(shard_state(folder, plan, shard, any_version));
  return states;
}

void run_shard(const fs::path& folder, const CampaignPlan& plan, const Campaign& campaign,
               int shard, int threads, bool any_version,
               const std::function<void(const CampaignProgress&)>& told) {
  const auto whole = [&] {
    return shard_state(folder, plan, shard, any_version).status == ShardStatus::whole;
  };
  if (whole()) return;
  try {
    const Finished finished = collect(folder, plan, campaign, shard, threads, told);
    write_shared_file(shard_file(folder, shard), shard_text(plan, shard, finished));
  } catch (const InputError&) {
    // Another process that finished the shard has taken this one's file away.
    if (!whole()) throw;
  }
  remove_parts(folder, shard);
}

MergedShards read_shards(const fs::path& folder, const CampaignPlan& plan, const Campaign& campaign,
                         bool any_version) {
  require_whole(folder, plan, any_version);
  MergedShards merged;
  for (int shard = 1; shard <= plan.shards; ++shard)
    read_shard(folder, plan, campaign, shard, merged);
  return merged;
}

}  // namespace vigia::evaluation
