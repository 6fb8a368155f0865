#include "tables.hpp"

#include "tum.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vigia::mission {
namespace {

using Buffer = fmt::memory_buffer;

template <typename... Args>
void put(Buffer& buffer, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(buffer), format, std::forward<Args>(args)...);
}

std::string_view view(const Buffer& buffer) {
  return {buffer.data(), buffer.size()};
}

/// The columns of the first eye stand beside those of the attention, without a prefix; those of
/// the others are named after their place in the rig.
std::string eye_header(const std::vector<const perception::Eye*>& eyes, std::size_t i) {
  std::string text;
  for (const auto& column : eyes[i]->columns())
    text += i == 0 ? "," + column : fmt::format(",eye{}_{}", i, column);
  return text;
}

std::string header(const MissionStart& start) {
  std::string text =
      "stamp_s,x_true_m,y_true_m,theta_true_rad,v_mps,w_radps,pan_true_rad,tilt_true_rad,"
      "zoom_mm,pan_rad,tilt_rad,rot1_rad,trans_m,rot2_rad,v_command_mps,w_command_radps,station_m,"
      "gaze,landmark,look,stopped";
  if (!start.eyes.empty()) text += eye_header(start.eyes, 0);
  text += ",centring_px";
  for (const auto& name : start.setup.localizers)
    for (const char* column : {"x_m", "y_m", "theta_rad", "var_x", "var_y", "var_theta", "cov_xy",
                               "cov_xtheta", "cov_ytheta", "status", "update", "nis"})
      text += "," + name + "_" + column;
  text += ",activation_follow,activation_avoid,activation_hold";
  for (std::size_t i = 1; i < start.eyes.size(); ++i) text += eye_header(start.eyes, i);
  for (const auto& name : start.setup.localizers)
    for (const char* column : {"lost_probability", "hypotheses"}) text += "," + name + "_" + column;
  return text + "\n";
}

void put_state(Buffer& line, const Tick& tick) {
  const auto& truth = tick.truth;
  put(line, "{:.3f},{:.6f},{:.6f},{:.7f},{:.5f},{:.5f},{:.7f},{:.7f},{:.4f},{:.7f},{:.7f}",
      tick.estimator.now.seconds(), truth.pose.x, truth.pose.y, truth.pose.theta, truth.base.v,
      truth.base.w, truth.head.pan, truth.head.tilt, truth.zoom_mm, tick.head.angles.pan,
      tick.head.angles.tilt);
  put(line, ",{:.8f},{:.8f},{:.8f},{:.5f},{:.5f},{:.4f}", tick.estimator.odometry.rot1,
      tick.estimator.odometry.trans, tick.estimator.odometry.rot2, tick.base_command.v,
      tick.base_command.w, tick.station_m);
}

void put_attention(Buffer& line, const AttentionTick& attention) {
  put(line, ",{},", to_string(attention.gaze));
  if (attention.order) put(line, "{}", attention.order->landmark);
  put(line, ",{},{}", attention.look, attention.stopped_to_look ? 1 : 0);
}

/// The cells of an eye, empty where its camera has not delivered.
void put_eye(Buffer& line, const perception::Eye& eye, const std::vector<EyeTick>& ticks) {
  std::string cells;
  const auto tick =
      std::find_if(ticks.begin(), ticks.end(), [&](const EyeTick& one) { return one.eye == &eye; });
  if (tick != ticks.end() && tick->observed)
    eye.append_cells(cells);
  else
    cells.assign(eye.columns().size(), ',');
  put(line, "{}", cells);
}

void put_belief(Buffer& line, const LocalizerTick& localizer) {
  const Belief& b = *localizer.belief;
  const auto& p = b.covariance;
  put(line, ",{:.6f},{:.6f},{:.7f},{:.4e},{:.4e},{:.4e},{:.4e},{:.4e},{:.4e},{},", b.pose.x,
      b.pose.y, b.pose.theta, p(0, 0), p(1, 1), p(2, 2), p(0, 1), p(0, 2), p(1, 2),
      to_string(b.status));
  if (localizer.updates.empty()) {
    put(line, ",");
    return;
  }
  const localization::UpdateResult& update = localizer.updates.back();
  put(line, "{},{:.4f}", localization::to_string(update.status), update.nis);
}

void put_activations(Buffer& line, const std::optional<pilot::Activations>& activations) {
  if (activations)
    put(line, ",{:.4f},{:.4f},{:.4f}", activations->follow, activations->avoid, activations->hold);
  else
    put(line, ",,,");
}

/// The median and the 99th percentile of one part of the ticks.
nlohmann::json percentiles(const std::vector<TickTiming>& timings, double TickTiming::*part) {
  std::vector<double> values;
  values.reserve(timings.size());
  for (const auto& timing : timings) values.push_back(timing.*part);
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) {
    if (values.empty()) return 0.0;
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  };
  return {{"p50", at(0.5)}, {"p99", at(0.99)}};
}

}  // namespace

Tables::Tables(const std::filesystem::path& folder, const MissionStart& start)
    : eyes_(start.eyes),
      ground_(start.setup.world.ground),
      ticks_(folder / "ticks.csv"),
      events_(folder / "events.jsonl"),
      timing_(folder / "timing.csv"),
      truth_(folder / "truth.tum") {
  for (const auto& name : start.setup.localizers)
    localizers_.emplace_back(folder / (name + ".tum"));
  ticks_.write(header(start));
  timing_.write("stamp_s,step_ms,render_ms,track_ms,localize_ms,plan_ms,servo_ms\n");
  events_.write(nlohmann::json{{"t_s", 0.0}, {"event", "start"}, {"seed", start.seed}}.dump() +
                "\n");
}

void Tables::tick(const Tick& tick) {
  const EstimatorTick& estimator = tick.estimator;
  Buffer line;
  put_state(line, tick);
  put_attention(line, tick.attention.value_or(AttentionTick{}));
  if (!eyes_.empty()) put_eye(line, *eyes_.front(), tick.eyes);
  line.push_back(',');
  if (tick.attention && tick.attention->centring_px)
    put(line, "{:.4f}", *tick.attention->centring_px);
  for (const auto& localizer : estimator.localizers) put_belief(line, localizer);
  put_activations(line, tick.activations);
  for (std::size_t i = 1; i < eyes_.size(); ++i) put_eye(line, *eyes_[i], tick.eyes);
  for (const auto& localizer : estimator.localizers)
    put(line, ",{:.4g},{}", localizer.belief->lost_probability,
        localizer.belief->hypotheses.size());
  line.push_back('\n');
  ticks_.write(view(line));

  const bool in_space = estimator.truth && estimator.truth->wMr;
  truth_.write(in_space ? tum_line(estimator.now, *estimator.truth->wMr)
                        : tum_line(estimator.now, tick.truth.pose, ground_));
  for (std::size_t i = 0; i < localizers_.size(); ++i) {
    const Belief& belief = *estimator.localizers[i].belief;
    localizers_[i].write(in_space && belief.in_space
                             ? tum_line(estimator.now, belief.in_space->wMr)
                             : tum_line(estimator.now, belief.pose, ground_));
  }

  const TickTiming& t = tick.timing;
  timings_.push_back(t);
  Buffer timing;
  put(timing, "{:.3f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", tick.estimator.now.seconds(),
      t.step, t.render, t.track, t.localize, t.plan, t.servo);
  timing_.write(view(timing));
}

void Tables::event(const Event& event) {
  nlohmann::ordered_json line;
  line["t_s"] = event.stamp.seconds();
  line["event"] = to_string(event.kind);
  for (const auto& [key, value] : event.numbers) {
    // Counts and ids are whole numbers and read as such.
    if (value == std::floor(value) && std::abs(value) < 1e15)
      line[key] = static_cast<std::int64_t>(value);
    else
      line[key] = value;
  }
  for (const auto& [key, value] : event.texts) line[key] = value;
  events_.write(line.dump() + "\n");
}

void Tables::close() {
  ticks_.close();
  events_.close();
  timing_.close();
  truth_.close();
  for (auto& file : localizers_) file.close();
}

std::string Tables::timing_json(double wall_s, double sim_s) const {
  nlohmann::ordered_json timing;
  timing["wall_s"] = wall_s;
  timing["real_time_factor"] = wall_s > 0.0 ? sim_s / wall_s : 0.0;
  timing["step_ms"] = percentiles(timings_, &TickTiming::step);
  timing["render_ms"] = percentiles(timings_, &TickTiming::render);
  timing["track_ms"] = percentiles(timings_, &TickTiming::track);
  timing["localize_ms"] = percentiles(timings_, &TickTiming::localize);
  timing["plan_ms"] = percentiles(timings_, &TickTiming::plan);
  timing["servo_ms"] = percentiles(timings_, &TickTiming::servo);
  return timing.dump(2) + "\n";
}

}  // namespace vigia::mission
