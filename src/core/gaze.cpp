#include "vigia/core/gaze.hpp"

namespace vigia {

std::string_view to_string(GazeState state) {
  switch (state) {
    case GazeState::idle:
      return "idle";
    case GazeState::slew:
      return "slew";
    case GazeState::acquire:
      return "acquire";
    case GazeState::track:
      return "track";
    case GazeState::lost:
      return "lost";
    case GazeState::search:
      return "search";
  }
  return "";
}

}  // namespace vigia
