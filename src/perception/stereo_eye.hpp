#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vigia/core/field_map.hpp"
#include "vigia/perception/eye.hpp"
#include "vigia/tracking/goal_corner_finder.hpp"

namespace vigia::perception {

/// Observes the corners of a field's goals by a stereo pair. That of the left camera finds them and
/// keeps what it found; that of the right camera, exposed together with the left, looks for the
/// same corners, and observes.
class StereoEye : public Eye {
 public:
  explicit StereoEye(const EyeParts& parts);

  std::string_view name() const override { return "stereo"; }
  std::vector<Observation> observe(const Capture& capture, const Belief& then,
                                   const std::optional<GazeRequest>& request) override;
  std::vector<Observation> survey(const Capture& capture) override;

  std::vector<std::string> columns() const override;
  void append_cells(std::string& line) const override;
  imaging::Overlay overlay() const override;

 private:
  bool plausible(const tracking::GoalCornerImage& corner, double disparity_px) const;

  std::optional<StereoCameras> cameras_;
  std::optional<FieldMap> field_;
  const StereoEye* left_ = nullptr;  ///< where this is the right camera's
  tracking::GoalCornerFinder finder_;
  tracking::DisparityRange disparities_;
  std::optional<Shot> shot_;       ///< of the capture that was looked through last
  tracking::GoalCornerScan scan_;  ///< what it shows: of the right camera, matches alone
  int unmatched_ = 0;              ///< of the left image's corners
};

}  // namespace vigia::perception
