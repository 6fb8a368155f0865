#include "progress.hpp"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace vigia::app {

Progress::Progress(bool quiet) : shown_(!quiet && ::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (percent_ >= 0) std::fprintf(stderr, "\r%60s\r", "");
}

void Progress::on_start(const mission::MissionStart& start) {
  length_m_ = start.setup.path.length();
}

void Progress::on_tick(const mission::Tick& tick) {
  if (!shown_ || length_m_ <= 0.0) return;
  const int percent = static_cast<int>(100.0 * tick.station_m / length_m_);
  if (percent == percent_) return;
  percent_ = percent;
  const double sigma = tick.estimator.primary_belief().position_sigma();
  fmt::print(stderr, "\r{:3} %  t = {:6.1f} s  σ = {:5.1f} cm  {:<8}", percent,
             tick.estimator.now.seconds(), 100.0 * sigma,
             tick.attention ? to_string(tick.attention->gaze) : std::string_view{});
  std::fflush(stderr);
}

}  // namespace vigia::app
