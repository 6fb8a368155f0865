#include "vigia/mission/mission.hpp"

#include "loop.hpp"

namespace vigia::mission {

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::arrived:
      return "arrived";
    case Outcome::collided:
      return "collided";
    case Outcome::timeout:
      return "timeout";
    case Outcome::stuck:
      return "stuck";
    case Outcome::lost:
      return "lost";
  }
  return "";
}

Outcome run_mission(const MissionSetup& setup, std::uint64_t seed,
                    const std::vector<Listener*>& listeners) {
  return Loop(setup, seed, listeners).run();
}

}  // namespace vigia::mission
