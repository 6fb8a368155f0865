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
  int announced = 0;         ///< said before the error passed LostEpisode::kLost_m, if it ever did
  Interval announced_share;  ///< Clopper–Pearson, 95 %; [0, 1] without episodes
  int ended = 0;             ///< it found itself again before the drive was over
  Interval ended_share;      ///< as announced_share
  double mean_lost_s = 0.0;  ///< of those that ended
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
