#pragma once

#include <tuple>

#include "vigia/core/rig.hpp"
#include "vigia/core/shot.hpp"

namespace vigia::localization {

/// Images that count as one where a localizer asks how often it was contradicted: those of a look
/// of the cameras on the head, which share the errors of its readings, and those that a fixed
/// camera, which no look directs, takes within a second.
struct ImageSpan {
  bool of_head = true;
  CameraId camera = 0;  ///< of a fixed one
  LookId number = 0;    ///< of the look, or the second

  friend bool operator==(const ImageSpan& a, const ImageSpan& b) {
    return a.of_head == b.of_head && a.camera == b.camera && a.number == b.number;
  }
  friend bool operator<(const ImageSpan& a, const ImageSpan& b) {
    return std::tie(a.of_head, a.camera, a.number) < std::tie(b.of_head, b.camera, b.number);
  }
};

inline ImageSpan span_of(const Shot& shot, const Rig& rig) {
  if (on_head(rig.at(shot.camera))) return {true, 0, shot.look};
  return {false, shot.camera, static_cast<LookId>(shot.stamp.seconds())};
}

}  // namespace vigia::localization
