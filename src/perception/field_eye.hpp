#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vigia/core/field_map.hpp"
#include "vigia/perception/eye.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia::perception {

/// Observes a field of play in the picture of a mirror camera: scans it along rays and lifts what
/// the scan finds to the floor, through the camera as the robot knows it.
class FieldEye : public Eye {
 public:
  explicit FieldEye(const EyeParts& parts);

  std::string_view name() const override { return "field"; }
  std::vector<Observation> observe(const Capture& capture, const Belief& then,
                                   const std::optional<GazeRequest>& request) override;
  std::vector<Observation> survey(const Capture& capture) override;

  std::vector<std::string> columns() const override;
  void append_cells(std::string& line) const override;
  imaging::Overlay overlay() const override;

 private:
  void look_through(const Shot& shot);

  std::optional<FieldMap> field_;
  RigOnGround on_ground_;
  EyeParts::Hull hull_;
  std::optional<tracking::FloorView> view_;  ///< of the camera whose captures come
  std::optional<tracking::RadialScanner> scanner_;
  tracking::RadialScan last_;
  FieldScan on_floor_;
};

/// A scan's line points, goals and posts on the floor in the robot's frame. The middle of a line is
/// that between its edges on the floor; errors along the ray are carried through the camera. Of
/// goals and posts those count whose width on the floor is that of the field's.
FieldScan on_floor(const tracking::RadialScan& scan, const tracking::FloorView& view,
                   const FieldMap& field, Stamp stamp);

}  // namespace vigia::perception
