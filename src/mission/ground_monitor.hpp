#pragma once

#include "event_log.hpp"

#include <map>
#include <optional>
#include <set>

#include "vigia/core/ground.hpp"
#include "vigia/mission/estimator_tick.hpp"

namespace vigia::mission {

/// Compares what patterns alone say of the robot's height and upright with the map's ground, patch
/// by patch, and tells of a patch whose looks contradict the map: the mean of their differences,
/// one of each look, against its covariance. Looks across a fold do not count.
class GroundMonitor {
 public:
  GroundMonitor(const EventLog& log, const Ground& ground) : log_(log), ground_(ground) {}

  /// Reads the first localizer that measures its pose in space.
  void judge(const EstimatorTick& tick);

 private:
  /// (z, and the upright's components along world x and y): what is seen less what the map says.
  struct Difference {
    std::size_t patch = 0;
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  };
  struct Sum {
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    int looks = 0;
  };

  std::optional<Difference> difference(const Belief& belief) const;
  void settle(const Difference& of_look);

  const EventLog& log_;
  Ground ground_;
  LookId look_ = 0;
  std::optional<Difference> last_;  ///< of the present look
  std::map<std::size_t, Sum> sums_;
  std::set<std::size_t> told_;
};

}  // namespace vigia::mission
