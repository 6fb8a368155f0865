#pragma once

#include <map>
#include <string>
#include <vector>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/evaluation/metrics.hpp"

namespace vigia::evaluation {

/// One localizer over many seeds. Metres and radians; means over the seeds with 95 % intervals.
struct LocalizerStatistics {
  Estimate position_final;
  Estimate heading_final;
  Estimate position_rmse;  ///< mean over the seeds of each drive's RMS
  Estimate position_max;
  double bound_rms = 0.0;  ///< √ of the mean trace of the posterior Cramér–Rao bound
  Estimate pcrlb_ratio;
  double nees_per_dof = 0.0;        ///< mean over time and seeds
  double anees_in_band = 0.0;       ///< share of the looks at which ANEES lies in its 95 % band
  std::vector<double> anees;        ///< per dof, at the end of each look that every seed made
  LossScore loss;                   ///< of all drives together: sums, and means of what are means
  Interval right_recoveries_share;  ///< Clopper–Pearson, 95 %; [0, 1] without recoveries
};

/// What became of a localizer's getting lost (see LostEpisode), over all drives.
struct LossStatistics {
  int episodes = 0;
  int false_alarms = 0;           ///< episodes that were no losses
  Estimate false_alarms_per_km;   ///< exact Poisson interval; [0, ∞] of a robot that stood
  int drives_without = 0;         ///< a false alarm
  Interval drives_without_share;  ///< Clopper–Pearson, 95 %
  int losses = 0;                 ///< the other episodes
  int beyond = 0;                 ///< of these: the error did pass LostEpisode::kLost_m
  int announced = 0;              ///< of these: said before the error passed LostEpisode::kLost_m
  Interval announced_share;       ///< Clopper–Pearson, 95 %; [0, 1] without losses
  int ended = 0;                 ///< episodes after which it found itself before the drive was over
  Interval ended_share;          ///< as announced_share, of the episodes
  double mean_lost_s = 0.0;      ///< of those that ended
  double ambiguous_share = 0.0;  ///< of the time
};

struct SeedStatistics {
  int runs = 0;
  int arrived = 0;
  Interval arrived_share;  ///< Clopper–Pearson, 95 %
  int collided = 0;
  Interval collided_share;
  LossStatistics losses;  ///< of the primary localizer
  Estimate looks;
  Estimate centring_rms_px;
  std::map<std::string, LocalizerStatistics> localizers;
};

/// Statistics over the drives of one mission; at least two. Throws std::invalid_argument.
SeedStatistics summarise(const std::vector<DriveScore>& scores);

}  // namespace vigia::evaluation
