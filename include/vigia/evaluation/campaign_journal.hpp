#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "vigia/evaluation/campaign.hpp"
#include "vigia/evaluation/descriptor.hpp"
#include "vigia/evaluation/drive_score.hpp"

namespace vigia::evaluation {

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
  void check_header(const std::string& header) const;
  void read();

  std::filesystem::path folder_;
  const Campaign& campaign_;
  Descriptor lock_;
  Descriptor journal_;
  std::map<CampaignTask, DriveScore> finished_;
};

}  // namespace vigia::evaluation
