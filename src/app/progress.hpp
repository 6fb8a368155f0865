#pragma once

#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// A progress line on stderr, rewritten in place on a terminal and silent elsewhere.
class Progress : public mission::Listener {
 public:
  explicit Progress(bool quiet);

  void on_start(const mission::MissionStart& start) override;
  void on_tick(const mission::Tick& tick) override;
  void on_finish(mission::Outcome outcome, Stamp end) override;

 private:
  bool shown_;
  double length_m_ = 0.0;
  int percent_ = -1;
};

}  // namespace vigia::app
