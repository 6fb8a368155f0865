#include "undirected_rejections.hpp"

#include <string>

namespace vigia::mission {
namespace {

using localization::UpdateResult;
using localization::UpdateStatus;

/// Of what has no identity an ambiguous fix is one all the same.
bool is_rejection(const Observation& observation, UpdateStatus status) {
  switch (status) {
    case UpdateStatus::gated:
    case UpdateStatus::too_late:
      return true;
    case UpdateStatus::ambiguous:
      return shows_landmark(observation);
    case UpdateStatus::fused:
    case UpdateStatus::degenerate:
    case UpdateStatus::unsupported:
    case UpdateStatus::no_prior:
      return false;
  }
  return false;
}

struct Frame {
  bool fused = false;
  const UpdateResult* rejected = nullptr;
};

}  // namespace

UndirectedRejections::UndirectedRejections(const EventLog& log, const Rig& rig) : log_(log) {
  if (const Camera* camera = directed_camera(rig)) directed_ = camera->id;
}

void UndirectedRejections::judge(const std::vector<Observation>& observations,
                                 const std::vector<UpdateResult>& results) {
  std::map<CameraId, Frame> frames;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const CameraId camera = shot_of(observations[k]).camera;
    if (camera == directed_ || std::holds_alternative<FlowObservation>(observations[k])) continue;
    Frame& frame = frames[camera];
    frame.fused = frame.fused || results[k].status == UpdateStatus::fused;
    if (is_rejection(observations[k], results[k].status)) frame.rejected = &results[k];
  }
  for (const auto& [camera, frame] : frames) {
    if (frame.fused) in_a_row_[camera] = 0;
    if (frame.fused || frame.rejected == nullptr) continue;
    if (in_a_row_[camera]++ > 0) continue;
    log_.record(EventKind::rejected,
                {{"camera", static_cast<double>(camera)}, {"nis", frame.rejected->nis}},
                {{"reason", std::string(to_string(frame.rejected->status))}});
  }
}

}  // namespace vigia::mission
