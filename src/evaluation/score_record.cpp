#include "score_json.hpp"

#include <array>
#include <stdexcept>

namespace vigia::evaluation {
namespace {

constexpr std::array<mission::Outcome, 5> kOutcomes{
    mission::Outcome::arrived, mission::Outcome::collided, mission::Outcome::timeout,
    mission::Outcome::stuck, mission::Outcome::lost};

mission::Outcome outcome_from(const std::string& text) {
  for (const auto outcome : kOutcomes)
    if (to_string(outcome) == text) return outcome;
  throw std::invalid_argument("no outcome is called " + text);
}

std::optional<double> seconds_from(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

LossScore loss_from(const Json& json) {
  LossScore s;
  json.at("false_alarms").get_to(s.false_alarms);
  json.at("driven_m").get_to(s.driven_m);
  json.at("misses").get_to(s.misses);
  json.at("misses_over_half_metre").get_to(s.misses_over_half_metre);
  json.at("unsaid_s").get_to(s.unsaid_s);
  json.at("said").get_to(s.said);
  json.at("delay_mean_s").get_to(s.delay_mean_s);
  json.at("delay_max_s").get_to(s.delay_max_s);
  json.at("right_recoveries").get_to(s.right_recoveries);
  json.at("wrong_recoveries").get_to(s.wrong_recoveries);
  json.at("ambiguous_s").get_to(s.ambiguous_s);
  json.at("brier").get_to(s.brier);
  for (const auto& b : json.at("calibration")) {
    CalibrationBin& bin = s.calibration.at(b.at("bin").get<std::size_t>());
    b.at("mean_probability").get_to(bin.mean_probability);
    b.at("ticks").get_to(bin.ticks);
    b.at("astray").get_to(bin.astray);
  }
  return s;
}

AttitudeScore attitude_from(const Json& json) {
  AttitudeScore s;
  json.at("looks").get_to(s.looks);
  json.at("z_rms_m").get_to(s.z_rms_m);
  json.at("z_max_m").get_to(s.z_max_m);
  json.at("pitch_rms_rad").get_to(s.pitch_rms_rad);
  json.at("pitch_max_rad").get_to(s.pitch_max_rad);
  json.at("roll_rms_rad").get_to(s.roll_rms_rad);
  json.at("roll_max_rad").get_to(s.roll_max_rad);
  json.at("nees_mean").get_to(s.nees_mean);
  return s;
}

LocalizerScore localizer_from(const Json& json) {
  LocalizerScore s;
  json.at("position_final_m").get_to(s.position_final_m);
  json.at("position_rmse_m").get_to(s.position_rmse_m);
  json.at("position_max_m").get_to(s.position_max_m);
  json.at("heading_final_rad").get_to(s.heading_final_rad);
  json.at("heading_rmse_rad").get_to(s.heading_rmse_rad);
  json.at("nees_mean").get_to(s.nees_mean);
  json.at("pcrlb_position_rms_m").get_to(s.pcrlb_position_rms_m);
  json.at("pcrlb_position_final_m").get_to(s.pcrlb_position_final_m);
  json.at("pcrlb_heading_final_rad").get_to(s.pcrlb_heading_final_rad);
  json.at("updates").get_to(s.updates);
  json.at("rejected").get_to(s.rejected);
  json.at("unsupported").get_to(s.unsupported);
  json.at("lost_s").get_to(s.lost_s);
  for (const auto& e : json.at("lost"))
    s.lost.push_back({seconds_from(e.at("said_s")), seconds_from(e.at("passed_half_metre_s")),
                      seconds_from(e.at("ended_s")), e.at("groundless").get<bool>()});
  s.loss = loss_from(json.at("loss"));
  if (json.contains("in_space"))
    s.in_space = SpaceScore{attitude_from(json.at("in_space").at("level")),
                            attitude_from(json.at("in_space").at("ramps"))};
  for (const auto& l : json.at("looks"))
    s.looks.push_back({l.at(0).get<LookId>(), l.at(1), l.at(2), l.at(3)});
  return s;
}

PerceptionScore perception_from(const Json& json) {
  PerceptionScore s;
  json.at("looks").get_to(s.looks);
  json.at("stops").get_to(s.stops);
  json.at("stopped_s").get_to(s.stopped_s);
  json.at("over_limit_1").get_to(s.over_limit_1);
  json.at("over_limit_2").get_to(s.over_limit_2);
  json.at("zoom_changes").get_to(s.zoom_changes);
  json.at("pan_travel_rad").get_to(s.pan_travel_rad);
  json.at("centring_rms_px").get_to(s.centring_rms_px);
  json.at("centring_max_px").get_to(s.centring_max_px);
  json.at("target_losses").get_to(s.target_losses);
  return s;
}

}  // namespace

std::string score_record(const DriveScore& score) {
  Json json{
      {"mission", score.mission}, {"seed", score.seed},       {"outcome", to_string(score.outcome)},
      {"sim_s", score.sim_s},     {"primary", score.primary}, {"localizers", Json::object()}};
  for (const auto& [name, s] : score.localizers) {
    Json& localizer = json["localizers"][name] = localizer_json(s);
    localizer["looks"] = Json::array();
    for (const auto& look : s.looks)
      localizer["looks"].push_back({look.look, look.nees, look.squared_error_m2, look.bound_m2});
  }
  json["perception"] = perception_json(score.perception);
  json["recovery"] = recovery_json(score.recovery);
  return json.dump();
}

DriveScore score_from_record(const std::string& record) {
  return score_from_json(Json::parse(record));
}

DriveScore score_from_json(const Json& json) {
  DriveScore score;
  json.at("mission").get_to(score.mission);
  json.at("seed").get_to(score.seed);
  score.outcome = outcome_from(json.at("outcome"));
  json.at("sim_s").get_to(score.sim_s);
  json.at("primary").get_to(score.primary);
  for (const auto& [name, s] : json.at("localizers").items())
    score.localizers[name] = localizer_from(s);
  score.perception = perception_from(json.at("perception"));
  const Json& recovery = json.at("recovery");
  recovery.at("lost").get_to(score.recovery.lost);
  recovery.at("recovered").get_to(score.recovery.recovered);
  recovery.at("recovering_s").get_to(score.recovery.recovering_s);
  return score;
}

}  // namespace vigia::evaluation
