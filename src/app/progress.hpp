#pragma once

#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// A progress line on stderr, rewritten in place on a terminal and silent elsewhere. It is
/// wiped out in the end.
class Progress : public mission::Listener {
 public:
  explicit Progress(bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() override;

  void on_start(const mission::MissionStart& start) override;
  void on_tick(const mission::Tick& tick) override;

 private:
  bool shown_;
  double length_m_ = 0.0;
  int percent_ = -1;  ///< that is shown; −1: none
};

}  // namespace vigia::app
