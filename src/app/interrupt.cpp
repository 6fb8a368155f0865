#include "interrupt.hpp"

#include <csignal>

namespace vigia::app {
namespace {

volatile std::sig_atomic_t came = 0;

extern "C" void note_interrupt(int /*signal*/) {
  came = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() {
  return came != 0;
}

void Interruption::on_tick(const mission::Tick& tick) {
  if (interrupted()) throw Interrupted{tick.estimator.now};
}

}  // namespace vigia::app
