#include "score_json.hpp"

namespace vigia::evaluation {
namespace {

Json seconds(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json episode_json(const LostEpisode& episode) {
  return {
      {"said_s", seconds(episode.said_s)},    {"passed_half_metre_s", seconds(episode.passed_s)},
      {"ended_s", seconds(episode.ended_s)},  {"groundless", episode.groundless},
      {"false_alarm", episode.false_alarm()}, {"announced", episode.announced()}};
}

Json calibration_json(const LossScore& s) {
  Json bins = Json::array();
  for (std::size_t i = 0; i < s.calibration.size(); ++i) {
    const CalibrationBin& bin = s.calibration[i];
    if (bin.ticks == 0) continue;
    bins.push_back({{"bin", i},
                    {"mean_probability", bin.mean_probability},
                    {"ticks", bin.ticks},
                    {"astray", bin.astray}});
  }
  return bins;
}

Json attitude_json(const AttitudeScore& s) {
  return {{"looks", s.looks},
          {"z_rms_m", s.z_rms_m},
          {"z_max_m", s.z_max_m},
          {"pitch_rms_rad", s.pitch_rms_rad},
          {"pitch_max_rad", s.pitch_max_rad},
          {"roll_rms_rad", s.roll_rms_rad},
          {"roll_max_rad", s.roll_max_rad},
          {"nees_mean", s.nees_mean}};
}

}  // namespace

Json loss_json(const LossScore& s) {
  return {{"false_alarms", s.false_alarms},
          {"driven_m", s.driven_m},
          {"false_alarms_per_km", s.false_alarms_per_km()},
          {"misses", s.misses},
          {"misses_over_half_metre", s.misses_over_half_metre},
          {"unsaid_s", s.unsaid_s},
          {"said", s.said},
          {"delay_mean_s", s.delay_mean_s},
          {"delay_max_s", s.delay_max_s},
          {"right_recoveries", s.right_recoveries},
          {"wrong_recoveries", s.wrong_recoveries},
          {"ambiguous_s", s.ambiguous_s},
          {"brier", s.brier},
          {"calibration", calibration_json(s)}};
}

Json localizer_json(const LocalizerScore& s) {
  Json json{{"position_final_m", s.position_final_m},
            {"position_rmse_m", s.position_rmse_m},
            {"position_max_m", s.position_max_m},
            {"heading_final_rad", s.heading_final_rad},
            {"heading_rmse_rad", s.heading_rmse_rad},
            {"nees_mean", s.nees_mean},
            {"pcrlb_position_rms_m", s.pcrlb_position_rms_m},
            {"updates", s.updates},
            {"rejected", s.rejected},
            {"unsupported", s.unsupported},
            {"lost_s", s.lost_s},
            {"pcrlb_position_final_m", s.pcrlb_position_final_m},
            {"pcrlb_heading_final_rad", s.pcrlb_heading_final_rad},
            {"lost", Json::array()},
            {"loss", loss_json(s.loss)}};
  if (s.in_space)
    json["in_space"] = {{"level", attitude_json(s.in_space->level)},
                        {"ramps", attitude_json(s.in_space->ramps)}};
  for (const auto& episode : s.lost) json["lost"].push_back(episode_json(episode));
  return json;
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

Json recovery_json(const RecoveryScore& s) {
  return {{"lost", s.lost}, {"recovered", s.recovered}, {"recovering_s", s.recovering_s}};
}

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
  summary["recovery"] = recovery_json(score.recovery);
  return summary.dump(2) + "\n";
}

}  // namespace vigia::evaluation
