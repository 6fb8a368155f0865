#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vigia/core/stamp.hpp"

namespace vigia::mission {

/// What an event says. to_string() gives the word in events.jsonl.
enum class EventKind {
  plan,           ///< the route is planned, the mission begins
  look,           ///< a gaze order is given
  acquired,       ///< its landmark is tracked
  released,       ///< … was, for the dwell time
  target_lost,    ///< … was, and is seen no more
  expired,        ///< the order passed its expiry without a feature
  dropped,        ///< the look is given up
  rejected,       ///< the primary localizer rejects what is tracked
  limit_1,        ///< the uncertainty is above the first limit
  stop,           ///< the robot stops to look
  restart,        ///< … and goes on
  lost,           ///< the primary localizer's belief is lost
  looked_around,  ///< a lost robot has finished a sweep
  exploration,    ///< … and goes to another place to look around from
  recovered,      ///< a lost robot knows again where it is
  ambiguous,      ///< it may be at several places, and would drive into the building from one
  settled,        ///< … and knows again which
  wait,           ///< the pilot waits for something to go away
  evade,          ///< the pilot goes round something
  rejoined,       ///< … and is back on the path
  blocked,        ///< the path stays blocked
  replan,         ///< another route is followed
  refused,        ///< a passage is too narrow for what is known of the robot's place
  via_missed,     ///< a point to pass lies behind, and the robot believes not to have passed it
  ground_off,     ///< patterns contradict the map's ground
  kidnapped,      ///< the world has put the robot elsewhere
  arrived,        ///< this and what follows: how the mission ended
  collided,
  timeout,
  stuck,
  still_lost,  ///< the robot has looked around in vain
};

std::string_view to_string(EventKind kind);

/// An entry of the event log. Whole numbers are written as such.
struct Event {
  using Numbers = std::vector<std::pair<std::string, double>>;
  using Texts = std::vector<std::pair<std::string, std::string>>;

  Stamp stamp;
  EventKind kind = EventKind::plan;
  Numbers numbers;
  Texts texts;
};

}  // namespace vigia::mission
