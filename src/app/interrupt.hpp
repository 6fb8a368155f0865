#pragma once

#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// Exit status of a program that was interrupted, as a shell says of SIGINT.
inline constexpr int kInterrupted = 130;

/// From the first call on, SIGINT and SIGTERM ask the program to come to its end, once; a second
/// one ends it at once. Blocking reads return early.
void catch_interrupts();
/// Whether one came.
bool interrupted();

/// Ends a mission by this exception at the tick after an interrupt.
struct Interrupted {
  Stamp at;
};

/// Hears whether one came, in every tick of a mission.
class Interruption : public mission::Listener {
 public:
  Interruption() { catch_interrupts(); }
  void on_tick(const mission::Tick& tick) override;
};

}  // namespace vigia::app
