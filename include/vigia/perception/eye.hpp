#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/ceiling_grid.hpp"
#include "vigia/core/field_map.hpp"
#include "vigia/core/gaze.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/name_table.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/imaging/overlay.hpp"

namespace vigia::perception {

/// An image as it is delivered.
struct Capture {
  const imaging::Frame& frame;
  const Shot& shot;  ///< what was read when it was exposed
};

/// Turns what one camera shows into observations. It also says what a run's table and pictures show
/// of that.
class Eye {
 public:
  virtual ~Eye() = default;
  virtual std::string_view name() const = 0;

  /// What @p capture shows. @p then: the belief at its exposure. @p request: what an attention asks
  /// for; an eye that is directed by one observes nothing without.
  virtual std::vector<Observation> observe(const Capture& capture, const Belief& then,
                                           const std::optional<GazeRequest>& request) = 0;
  /// The belief at the exposure of the capture that was observed last, once the localizers have
  /// processed it: what the eye expects of the next capture counts from there.
  virtual void settle(const Belief& /*then*/) {}
  /// Everything that a capture shows to somebody who does not know where he is: no belief helps,
  /// nothing is expected.
  virtual std::vector<Observation> survey(const Capture& capture) = 0;

  /// Names of the eye's columns in a run's table.
  virtual std::vector<std::string> columns() const = 0;
  /// Adds a cell, after a comma, for each column: what the last observe() made of its capture.
  virtual void append_cells(std::string& line) const = 0;
  /// What a picture of that capture shows.
  virtual imaging::Overlay overlay() const = 0;
};

/// What eyes are made from.
struct EyeParts {
  const LandmarkMap& landmarks;  ///< outlives the eye
  RigOnGround on_ground = {};
  SensorNoise noise = {};        ///< of the readings
  std::string tracker = "disc";  ///< of discs; see tracking::make_ellipse_tracker
  /// By an attention; otherwise the eye observes all that every capture shows.
  bool directed = false;
  const FieldMap* field = nullptr;  ///< of the world, where it has one
  /// What the robot's own cameras see of it: a cylinder about the base's centre.
  struct Hull {
    double radius_m = 0.0;
    double height_m = 0.0;  ///< 0: nothing
  };
  Hull hull = {};
  const CeilingGrid* ceiling = nullptr;  ///< of the world, where it has one
  /// Of the pair's left camera, where this is the right one's; outlives the eye.
  const Eye* partner = nullptr;
};

struct EyeEntry : NameEntry {
  std::unique_ptr<Eye> (*make)(const EyeParts& parts);
};

/// Every eye.
const std::vector<EyeEntry>& eyes();

}  // namespace vigia::perception
