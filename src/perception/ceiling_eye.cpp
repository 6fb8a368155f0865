#include "ceiling_eye.hpp"

#include <fmt/format.h>

namespace vigia::perception {

CeilingEye::CeilingEye(const EyeParts& parts)
    : grid_(parts.ceiling != nullptr ? std::optional<CeilingGrid>(*parts.ceiling) : std::nullopt),
      on_ground_(parts.on_ground) {}

/// The camera is fixed and its optics do not change: one finder does.
void CeilingEye::look_through(const Shot& shot) {
  const auto* pinhole = std::get_if<Intrinsics>(&shot.model);
  if (pinhole == nullptr || !grid_) return;
  const double rise_m =
      grid_->height_m - on_ground_.rig.at(shot.camera).rMc(shot.head).translation().z();
  if (rise_m <= 0.0) return;
  tracking::PatchFinderParams params;
  params.length_px = grid_->length_m / rise_m * pinhole->px;
  params.width_px = grid_->width_m / rise_m * pinhole->px;
  params.polarity = grid_->polarity;
  finder_.emplace(params);
}

std::vector<Observation> CeilingEye::observe(const Capture& capture, const Belief& /*then*/,
                                             const std::optional<GazeRequest>& /*request*/) {
  return survey(capture);
}

std::vector<Observation> CeilingEye::survey(const Capture& capture) {
  if (!finder_) look_through(capture.shot);
  if (!finder_) return {};
  last_ = finder_->find(capture.frame);
  return {PatchesObservation{capture.shot, last_.patches}};
}

std::vector<std::string> CeilingEye::columns() const {
  return {"patches", "dark_spots"};
}

void CeilingEye::append_cells(std::string& line) const {
  line += fmt::format(",{},{}", last_.patches.size(), last_.rejected);
}

imaging::Overlay CeilingEye::overlay() const {
  imaging::Overlay overlay;
  for (const PatchImage& patch : last_.patches) overlay.points.push_back(patch.uv);
  overlay.lines = {
      fmt::format("{} patches, {} other dark spots", last_.patches.size(), last_.rejected)};
  return overlay;
}

}  // namespace vigia::perception
