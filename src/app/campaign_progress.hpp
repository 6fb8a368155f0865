#pragma once

#include <chrono>
#include <cstddef>
#include <ctime>
#include <string>

#include "vigia/evaluation/campaign_run.hpp"

namespace vigia::app {

/// Tells on stderr how far a campaign is: one line that is rewritten on a terminal, a line every
/// tenth of the missions elsewhere, nothing when quiet.
class CampaignLine {
 public:
  explicit CampaignLine(bool quiet);

  void operator()(const evaluation::CampaignProgress& progress);
  /// Ends the line with how many missions ran in a second on how many threads.
  void finish(int threads);

 private:
  double elapsed_s() const;

  bool quiet_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t cpu_start_ = 0;
  evaluation::CampaignProgress last_;
  std::size_t tenths_ = 0;
};

/// "4:05" or "1:04:05".
std::string clock_text(double seconds);

}  // namespace vigia::app
