#include <nlohmann/json.hpp>

#include "vigia/evaluation/drive_score.hpp"

namespace vigia::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json localizer_json(const LocalizerScore& s) {
  return {{"position_final_m", s.position_final_m},
          {"position_rmse_m", s.position_rmse_m},
          {"position_max_m", s.position_max_m},
          {"heading_final_rad", s.heading_final_rad},
          {"heading_rmse_rad", s.heading_rmse_rad},
          {"nees_mean", s.nees_mean},
          {"pcrlb_position_rms_m", s.pcrlb_position_rms_m},
          {"updates", s.updates},
          {"rejected", s.rejected},
          {"unsupported", s.unsupported},
          {"lost_s", s.lost_s}};
}

Json perception_json(const PerceptionScore& s) {
  return {{"looks", s.looks},
          {"stops", s.stops},
          {"stopped_s", s.stopped_s},
          {"over_limit_1", s.over_limit_1},
          {"over_limit_2", s.over_limit_2},
          {"zoom_changes", s.zoom_changes},
          {"pan_travel_rad", s.pan_travel_rad},
          {"centring_rms_px", s.centring_rms_px},
          {"centring_max_px", s.centring_max_px},
          {"target_losses", s.target_losses}};
}

}  // namespace

std::string summary_json(const DriveScore& score) {
  Json summary;
  summary["mission"] = score.mission;
  summary["seed"] = score.seed;
  summary["version"] = VIGIA_VERSION;
  summary["outcome"] = mission::to_string(score.outcome);
  summary["sim_s"] = score.sim_s;
  summary["localizers"] = Json::object();
  for (const auto& [name, localizer] : score.localizers)
    summary["localizers"][name] = localizer_json(localizer);
  summary["perception"] = perception_json(score.perception);
  return summary.dump(2) + "\n";
}

}  // namespace vigia::evaluation
