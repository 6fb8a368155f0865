#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "vigia/localization/field_tracker.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/localization/mcl.hpp"
#include "vigia/localization/murea.hpp"

namespace vigia::localization {

/// What all localizers on scans of a field have in common: other observations are unsupported, a
/// scan without points is degenerate, and a late one is carried to the present by the odometry
/// since its exposure, whose error in so short a time is small beside the scan's.
class FieldLocalizer : public Localizer {
 public:
  void reset(Stamp stamp, const std::optional<Prior>& prior) final;
  void predict(const OdometryIncrement& increment) final;
  UpdateResult update(const Observation& observation) final;
  /// Forgets where it is; it can find itself.
  void lose() final;

 protected:
  virtual void start(Stamp stamp, const std::optional<Prior>& prior) = 0;
  virtual void move_by(const OdometryIncrement& increment) = 0;
  virtual void take(const FieldScan& scan) = 0;

 private:
  struct Place {
    Stamp stamp;
    Pose2 oMr;  ///< by odometry
  };
  std::deque<Place> places_;  ///< of the last second, in order of time
};

/// The field is copied; each localizer has its own.
std::unique_ptr<FieldLocalizer> make_field_tracker(const FieldMap& field,
                                                   const FieldTrackerParams& params);
std::unique_ptr<FieldLocalizer> make_mcl(const FieldMap& field, const MclParams& params,
                                         std::uint64_t seed);
std::unique_ptr<FieldLocalizer> make_murea(const FieldMap& field,
                                           const MureaLocalizerParams& params);

}  // namespace vigia::localization
