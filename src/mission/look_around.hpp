#pragma once

#include <optional>
#include <vector>

#include "vigia/core/actuation.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {

/// The sweep of a lost robot that stands still and turns its head: one stop after another, from
/// the present side of the pan range to the other, zoomed out. From a place that it could not leave
/// the next sweeps look farther, with a longer lens.
class LookAround {
 public:
  explicit LookAround(const MissionSetup& setup) : setup_(setup) {}

  /// Plans a sweep from where the head points now; @p again: from the same place as the last.
  void begin(const HeadReading& head, bool again = false);

  /// Rates for the head, towards the present stop.
  HeadRates step(const HeadReading& head) const;
  /// Whether the head had stood at the present stop long enough when the picture at hand was
  /// exposed. To be asked in every tick.
  bool ready(Stamp now, const HeadReading& head, Stamp exposed);
  /// A picture was taken: on to the next stop. False when that was the last.
  bool next();
  /// How many sweeps were begun since the robot last knew where it was.
  int sweeps() const { return sweeps_; }
  void found() { sweeps_ = 0; }

 private:
  const MissionSetup& setup_;
  std::vector<HeadAngles> stops_;
  std::size_t stop_ = 0;
  std::optional<Stamp> settled_since_;
  int sweeps_ = 0;
  int repeats_ = 0;  ///< of the sweeps, without a change of place
  double zoom_mm_ = 0.0;
};

}  // namespace vigia::mission
