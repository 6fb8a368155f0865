#include "ceiling_eye.hpp"

#include <utility>

#include <fmt/format.h>

#include "vigia/imaging/image_frame.hpp"

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
  flow_.emplace(*pinhole, on_ground_.rig.at(shot.camera).rMc(shot.head).linear());
}

bool CeilingEye::looks_at_ceiling(const Shot& shot) {
  if (!finder_) look_through(shot);
  return finder_.has_value();
}

PatchesObservation CeilingEye::patches_in(const vpImage<unsigned char>& picture, const Shot& shot) {
  last_ = finder_->find(imaging::ImageFrame(picture));
  return {shot, last_.patches};
}

/// The motion since the frame before that was observed.
std::optional<FlowObservation> CeilingEye::flow_to(const vpImage<unsigned char>& picture,
                                                   const Shot& shot) {
  const auto shift = flow_->next(picture);
  const std::optional<Stamp> before = std::exchange(before_, shot.stamp);
  agreement_ = shift ? flow_->agreement() : 0.0;
  if (!shift || !before) return std::nullopt;
  return FlowObservation{shot, *before, *shift};
}

std::vector<Observation> CeilingEye::observe(const Capture& capture, const Belief& /*then*/,
                                             const std::optional<GazeRequest>& /*request*/) {
  if (!looks_at_ceiling(capture.shot)) return {};
  const vpImage<unsigned char> picture = imaging::grey_image(capture.frame);
  std::vector<Observation> seen;
  if (const auto flow = flow_to(picture, capture.shot)) seen.emplace_back(*flow);
  seen.emplace_back(patches_in(picture, capture.shot));
  return seen;
}

std::vector<Observation> CeilingEye::survey(const Capture& capture) {
  if (!looks_at_ceiling(capture.shot)) return {};
  return {patches_in(imaging::grey_image(capture.frame), capture.shot)};
}

std::vector<std::string> CeilingEye::columns() const {
  return {"patches", "dark_spots", "flow_agreement"};
}

void CeilingEye::append_cells(std::string& line) const {
  line += fmt::format(",{},{},{:.2f}", last_.patches.size(), last_.rejected, agreement_);
}

imaging::Overlay CeilingEye::overlay() const {
  imaging::Overlay overlay;
  for (const PatchImage& patch : last_.patches) overlay.points.push_back(patch.uv);
  overlay.lines = {
      fmt::format("{} patches, {} other dark spots", last_.patches.size(), last_.rejected)};
  return overlay;
}

}  // namespace vigia::perception
