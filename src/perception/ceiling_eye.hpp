#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vigia/core/ceiling_grid.hpp"
#include "vigia/perception/eye.hpp"
#include "vigia/tracking/patch_finder.hpp"
#include "vigia/tracking/plane_flow.hpp"

namespace vigia::perception {

/// Observes a patched ceiling in the picture of a camera that looks up: its patches, and how the
/// picture moved since the one before.
class CeilingEye : public Eye {
 public:
  explicit CeilingEye(const EyeParts& parts);

  std::string_view name() const override { return "ceiling"; }
  std::vector<Observation> observe(const Capture& capture, const Belief& then,
                                   const std::optional<GazeRequest>& request) override;
  std::vector<Observation> survey(const Capture& capture) override;

  std::vector<std::string> columns() const override;
  void append_cells(std::string& line) const override;
  imaging::Overlay overlay() const override;

 private:
  void look_through(const Shot& shot);
  bool looks_at_ceiling(const Shot& shot);
  PatchesObservation patches_in(const vpImage<unsigned char>& picture, const Shot& shot);
  std::optional<FlowObservation> flow_to(const vpImage<unsigned char>& picture, const Shot& shot);

  std::optional<CeilingGrid> grid_;
  RigOnGround on_ground_;
  std::optional<tracking::PatchFinder> finder_;  ///< of the camera whose captures come
  std::optional<tracking::FrameFlow> flow_;      ///< of the same
  std::optional<Stamp> before_;                  ///< exposure of the frame before
  double agreement_ = 0.0;                       ///< of the last flow
  tracking::PatchScan last_;
};

}  // namespace vigia::perception
