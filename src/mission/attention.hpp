#pragma once

#include "late_frames.hpp"
#include "readings.hpp"

#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/gaze.hpp"
#include "vigia/core/path.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/mission/listener.hpp"

namespace vigia::mission {

/// What the attention asks of the rest of the robot.
struct Demand {
  bool stop = false;      ///< stand still while it looks
  bool new_look = false;  ///< a look begins: the readings' constant errors are others from now on
  /// What the belief predicts is not there: whatever the localizer says, it is lost.
  bool contradicted = false;
};

/// Decides where an eye that can move looks next, and moves it there. In every tick: request(),
/// judge() for each observation, plan(), steer().
class Attention {
 public:
  virtual ~Attention() = default;

  /// The robot follows this path from now on; it stays where it is.
  virtual void follow(const Path& path) = 0;
  /// What is asked of the eye with the present capture.
  virtual std::optional<GazeRequest> request() const = 0;
  /// What the primary localizer made of an observation.
  virtual void judge(const Observation& observation, const localization::UpdateResult& result,
                     const Readings& readings) = 0;
  /// @p belief: after the updates; @p station_m: reached on the path. @p next_look: the number of
  /// the look that begins, if one does.
  virtual Demand plan(const Readings& readings, const Belief& belief, double station_m,
                      LookId next_look) = 0;
  /// Rates for the head. @p base: what the base is asked for; @p observations: of this tick;
  /// @p motion: takes the belief back to their exposure.
  virtual HeadRates steer(const Readings& readings, const Belief& belief, const BaseRates& base,
                          const std::vector<Observation>& observations,
                          const RecentMotion& motion) = 0;
  /// Drops what it is about: the robot is lost.
  virtual void cancel() = 0;
  /// Of the tick that ends; nothing where nothing moves. @p look: the present one.
  virtual std::optional<AttentionTick> tick(const Readings& readings,
                                            const std::vector<Observation>& observations,
                                            LookId look) const = 0;
};

/// Of eyes that don't move.
class NoAttention : public Attention {
 public:
  void follow(const Path& /*path*/) override {}
  std::optional<GazeRequest> request() const override { return std::nullopt; }
  void judge(const Observation& /*observation*/, const localization::UpdateResult& /*result*/,
             const Readings& /*readings*/) override {}
  Demand plan(const Readings& /*readings*/, const Belief& /*belief*/, double /*station_m*/,
              LookId /*next_look*/) override {
    return {};
  }
  HeadRates steer(const Readings& /*readings*/, const Belief& /*belief*/, const BaseRates& /*base*/,
                  const std::vector<Observation>& /*observations*/,
                  const RecentMotion& /*motion*/) override {
    return {};
  }
  void cancel() override {}
  std::optional<AttentionTick> tick(const Readings& /*readings*/,
                                    const std::vector<Observation>& /*observations*/,
                                    LookId /*look*/) const override {
    return std::nullopt;
  }
};

}  // namespace vigia::mission
