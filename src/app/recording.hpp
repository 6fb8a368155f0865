#pragma once

#include <string>

#include <Eigen/Geometry>

#include "vigia/core/belief.hpp"
#include "vigia/core/ground.hpp"
#include "vigia/imaging/overlay.hpp"
#include "vigia/mission/event.hpp"
#include "vigia/mission/listener.hpp"

/// What those who record a drive for viewers have in common.
namespace vigia::app {

/// What an event says beside its kind.
std::string in_words(const mission::Event& event);

inline constexpr std::size_t kShownHypotheses = 50;
/// Of many hypotheses the likeliest kShownHypotheses: a viewer shows no more.
Belief with_likeliest(Belief belief);

/// When the next of something that is recorded at most so often is due.
struct Schedule {
  double period_s = 0.2;
  double due_s = 0.0;

  /// Whether it is due now; if so, the next is due a period later.
  bool due(double t_s);
};

/// Where the robot truly stands.
Eigen::Isometry3d true_wMr(const mission::Tick& tick, const Ground& ground);

/// What an eye made of the tick's frame, and what its attention was about.
imaging::Overlay overlay_of(const mission::Tick& tick, const perception::Eye& eye);

}  // namespace vigia::app
