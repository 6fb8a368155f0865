#pragma once

#include "vigia/core/belief.hpp"
#include "vigia/core/ground.hpp"

namespace vigia {

/// wMr of a robot that is believed somewhere: on ground that is not flat as its localizer measures
/// it in space, if it does; else on the ground where the belief has it.
inline Eigen::Isometry3d believed_wMr(const Belief& belief, const Ground& ground) {
  return belief.in_space && !ground.flat() ? belief.in_space->wMr : ground.place(belief.pose);
}

}  // namespace vigia
