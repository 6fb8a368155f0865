#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vigia/core/odometry.hpp"
#include "vigia/localization/ceiling_filter.hpp"

namespace vigia::evaluation {

/// What takes the patches from a camera for a while.
enum class CeilingOutage {
  ten_frames,     ///< are lost, whole
  thirty_frames,  ///< …
  glare,          ///< a lamp's, for two seconds: the middle of the picture is saturated
};
std::string to_string(CeilingOutage outage);

/// A robot under a ceiling with spurious patches, and what it has beside them.
struct CeilingCondition {
  CeilingOutage outage = CeilingOutage::ten_frames;
  double speed_mps = 0.3;
  double rate_hz = 25.0;
  bool odometry = false;
  bool flow = false;
};
/// Every outage at three speeds and two rates, with and without odometry and flow.
std::vector<CeilingCondition> ceiling_conditions();

struct CeilingOutageParams {
  OdometryNoise odometry{0.05, 0.02, 0.05};  ///< as the robot drives and as it believes
  double spurious = 0.05;                    ///< share of the cells with a patch too many
  double missing = 0.02;
  double placement_m = 0.005;
  double placement_turn = 0.0227;
  double max_over_speed = 1.2;  ///< the robot's greatest speed, which it knows, over its speed
  double max_turn = 0.26;       ///< rad/s, of the true motion
};

/// What became of one outage. An instant is wrong in another cell than the true one or turned by
/// more than a right angle.
struct CeilingOutageTrial {
  double blind_m = 0.0;       ///< driven without a patch
  int instants = 0;           ///< from the outage's begin on
  int wrong_unflagged = 0;    ///< wrong, and status `tracking`
  int right_after = 0;        ///< instants after the outage in the right cell
  int right_flagged = 0;      ///< … with another status than `tracking`
  bool recovered = false;     ///< right and `tracking` again
  double recovery_s = 0.0;    ///< … after that time
  double last_error_m = 0.0;  ///< at the end
};
/// Three quarters of a second with patches, the outage, two seconds with patches; all pictures
/// rendered. @p seed draws hall, way and noise.
CeilingOutageTrial try_outage(const CeilingCondition& condition, const CeilingOutageParams& params,
                              std::uint64_t seed);

/// @p each trials of every condition, in its order, seeds from @p first on.
std::vector<CeilingOutageTrial> try_outages(const std::vector<CeilingCondition>& conditions,
                                            int each, const CeilingOutageParams& params,
                                            std::uint64_t first, int threads);

/// A robot that is lifted, turned and put down anywhere.
struct CeilingKidnapping {
  int wrong_unflagged = 0;     ///< frames until the belief is no longer `tracking`; at most all
  int frames = 0;              ///< after it was put down
  double in_cell_m = 0.0;      ///< at the end, error modulo the pitch
  double heading_error = 0.0;  ///< rad
  bool flagged = false;        ///< at the end
};
/// Two seconds of frames after it, at 25 Hz and 0.3 m/s, with odometry that saw nothing of it.
CeilingKidnapping try_kidnapping(const CeilingOutageParams& params, std::uint64_t seed);
std::vector<CeilingKidnapping> try_kidnappings(int count, const CeilingOutageParams& params,
                                               std::uint64_t first, int threads);

/// What became of the hypotheses that an outage left.
struct CeilingSettling {
  bool ambiguous = false;   ///< after the outage
  bool settled = false;     ///< `tracking` again
  bool right = false;       ///< … in the true cell
  double way_m = 0.0;       ///< driven until then, or to the end
  int wrong_unflagged = 0;  ///< frames
};
/// Three quarters of a second with patches, 30 frames without a picture at 0.5 m/s, then six
/// metres with patches, at 25 Hz, with neither odometry nor flow. @p gaps: the ceiling lacks
/// patches in rectangles, one to three patches long and wide, about one for every 16, which
/// the map has.
CeilingSettling try_settling(bool gaps, const CeilingOutageParams& params, std::uint64_t seed);
std::vector<CeilingSettling> try_settlings(int count, bool gaps, const CeilingOutageParams& params,
                                           std::uint64_t first, int threads);

}  // namespace vigia::evaluation
