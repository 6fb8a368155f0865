#include "vigia/mission/event.hpp"

namespace vigia::mission {

std::string_view to_string(EventKind kind) {
  switch (kind) {
    case EventKind::plan:
      return "plan";
    case EventKind::look:
      return "look";
    case EventKind::acquired:
      return "acquired";
    case EventKind::released:
      return "released";
    case EventKind::target_lost:
      return "target_lost";
    case EventKind::expired:
      return "expired";
    case EventKind::dropped:
      return "dropped";
    case EventKind::rejected:
      return "rejected";
    case EventKind::limit_1:
      return "limit_1";
    case EventKind::stop:
      return "stop";
    case EventKind::restart:
      return "restart";
    case EventKind::lost:
      return "lost";
    case EventKind::looked_around:
      return "looked_around";
    case EventKind::exploration:
      return "exploration";
    case EventKind::recovered:
      return "recovered";
    case EventKind::ambiguous:
      return "ambiguous";
    case EventKind::settled:
      return "settled";
    case EventKind::wait:
      return "wait";
    case EventKind::evade:
      return "evade";
    case EventKind::rejoined:
      return "rejoined";
    case EventKind::blocked:
      return "blocked";
    case EventKind::replan:
      return "replan";
    case EventKind::refused:
      return "refused";
    case EventKind::via_missed:
      return "via_missed";
    case EventKind::ground_off:
      return "ground_off";
    case EventKind::kidnapped:
      return "kidnapped";
    case EventKind::arrived:
      return "arrived";
    case EventKind::collided:
      return "collided";
    case EventKind::timeout:
      return "timeout";
    case EventKind::stuck:
      return "stuck";
    case EventKind::still_lost:
      return "still_lost";
  }
  return "";
}

}  // namespace vigia::mission
