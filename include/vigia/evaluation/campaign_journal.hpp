#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "vigia/evaluation/campaign.hpp"
#include "vigia/evaluation/drive_score.hpp"

namespace vigia::evaluation {

/// One mission of a campaign.
struct CampaignTask {
  std::size_t arm = 0;
  std::uint64_t seed = 0;
  bool operator<(const CampaignTask& other) const {
    return std::tie(seed, arm) < std::tie(other.seed, other.arm);
  }
};

/// An open file, closed with this.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  int get() const { return number_; }

 private:
  int number_;
};

/// The folder of a campaign in progress. A mission that is finished is one line at the end of
/// journal.jsonl, with a checksum: killed at any moment, what is lost is the missions that were
/// under way, and a torn last line is cut off. campaign.json says what the journal belongs to:
/// arms, their missions' fingerprints, version and build of the program; missions/ holds the
/// resolved missions. One process at a time works in a folder.
class CampaignJournal {
 public:
  /// Opens the folder or makes it. Throws InputError when it belongs to something else, when
  /// another process works in it, or when a line other than the last is damaged. @p restart
  /// forgets what an earlier campaign of any kind left in it.
  CampaignJournal(const std::filesystem::path& folder, const Campaign& campaign, bool restart);

  /// The missions that are finished, of this campaign's seeds or of others.
  const std::map<CampaignTask, DriveScore>& finished() const { return finished_; }
  /// Adds a finished mission. Not to be called by two threads at once.
  void append(const CampaignTask& task, const DriveScore& score);

  const std::filesystem::path& folder() const { return folder_; }

 private:
  void lock();
  void check_header(const std::string& header) const;
  void read();

  std::filesystem::path folder_;
  const Campaign& campaign_;
  Descriptor lock_;
  Descriptor journal_;
  std::map<CampaignTask, DriveScore> finished_;
};

}  // namespace vigia::evaluation
