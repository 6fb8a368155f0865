#pragma once

#include <cstdint>

#include "vigia/core/random.hpp"
#include "vigia/sim/disturbances.hpp"

namespace vigia::sim {

/// A motion along an arc: length (m, forward positive), turn (rad) and, of an omnidirectional base,
/// the length to its left (m).
struct ArcMotion {
  double distance = 0.0;
  double turn = 0.0;
  double side = 0.0;
};

/// What the base does when its wheels say something else: scale errors that stay, and slips that
/// begin at random, last some decimetres and cost a share of the distance and some heading.
class WheelSlip {
 public:
  WheelSlip(const WheelSlipParams& params, std::uint64_t seed);

  /// The base's motion over the ground for a short motion of the wheels.
  ArcMotion over_ground(const ArcMotion& wheels);
  bool slipping() const { return slip_left_m_ > 0.0; }

 private:
  void begin_slip();
  double draw_gap();

  WheelSlipParams params_;
  RandomStream random_;
  double diameter_;  ///< relative errors, constant
  double base_;
  double gap_left_m_ = 0.0;  ///< driven until the next slip begins
  double slip_left_m_ = 0.0;
  double loss_ = 0.0;
  double skew_per_m_ = 0.0;
};

}  // namespace vigia::sim
