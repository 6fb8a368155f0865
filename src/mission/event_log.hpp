#pragma once

#include <vector>

#include "vigia/mission/listener.hpp"

namespace vigia::mission {

/// Where the parts of a mission record what happens: stamps it and hands it to the listeners.
class EventLog {
 public:
  explicit EventLog(const std::vector<Listener*>& listeners) : listeners_(listeners) {}

  void set_time(Stamp now) { now_ = now; }
  void record(EventKind kind, Event::Numbers numbers = {}, Event::Texts texts = {}) const {
    const Event event{now_, kind, std::move(numbers), std::move(texts)};
    for (Listener* listener : listeners_) listener->on_event(event);
  }

 private:
  const std::vector<Listener*>& listeners_;
  Stamp now_;
};

}  // namespace vigia::mission
