#include "campaign_progress.hpp"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace vigia::app {

std::string clock_text(double seconds) {
  const auto s = std::lround(seconds);
  if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
  return fmt::format("{}:{:02}", s / 60, s % 60);
}

CampaignLine::CampaignLine(bool quiet)
    : quiet_(quiet), terminal_(!quiet && ::isatty(STDERR_FILENO) != 0) {}

double CampaignLine::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void CampaignLine::operator()(const evaluation::CampaignProgress& progress) {
  if (last_.total == 0) {
    start_ = std::chrono::steady_clock::now();
    cpu_start_ = std::clock();
  }
  last_ = progress;
  if (quiet_) return;
  const std::size_t now = progress.done - progress.before;
  std::string text = fmt::format("{} of {} missions", progress.done, progress.total);
  if (now > 0) {
    const double rate = static_cast<double>(now) / elapsed_s();
    const double left = static_cast<double>(progress.total - progress.done) / rate;
    text += fmt::format(", {:.1f}/s, {} left", rate, clock_text(left));
  } else if (progress.before > 0) {
    text += ", from an earlier run";
  }
  if (terminal_) {
    fmt::print(stderr, "\r{:<60}", text);
    std::fflush(stderr);
    return;
  }
  const std::size_t tenths = 10 * progress.done / progress.total;
  if (tenths == tenths_ && now > 0) return;
  if (now > 0 || progress.before > 0) fmt::print(stderr, "{}\n", text);
  tenths_ = tenths;
}

void CampaignLine::finish(int threads) {
  if (quiet_) return;
  if (terminal_) fmt::print(stderr, "\r{:60}\r", "");
  const std::size_t now = last_.done - last_.before;
  if (now == 0) return;
  const double missions = static_cast<double>(now);
  const double cpu_s = static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC;
  // On a busy machine the second figure says what the first would be on a quiet one.
  fmt::print(stderr,
             "{:.1f} missions/s on {} threads ({} missions in {:.1f} s), {:.1f} for each second of "
             "a core\n",
             missions / elapsed_s(), threads, now, elapsed_s(), missions / cpu_s);
}

}  // namespace vigia::app
