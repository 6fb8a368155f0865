#include "recording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace vigia::app {
namespace {

/// "sigma_m" 0.012 as "sigma 0.012 m".
std::string in_words(const std::string& key, double value) {
  const auto cut = key.rfind('_');
  const std::string unit = cut == std::string::npos ? "" : key.substr(cut + 1);
  const bool known = unit == "m" || unit == "s" || unit == "px" || unit == "rad" || unit == "deg";
  std::string name = known ? key.substr(0, cut) : key;
  for (char& c : name)
    if (c == '_') c = ' ';
  return fmt::format("{} {:.4g}{}", name, value, known ? " " + unit : "");
}

}  // namespace

std::string in_words(const mission::Event& event) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  for (const auto& [key, value] : event.numbers) add(in_words(key, value));
  for (const auto& [key, value] : event.texts) add(value);
  return text;
}

Belief with_likeliest(Belief belief) {
  auto& all = belief.hypotheses;
  if (all.size() <= kShownHypotheses) return belief;
  const auto end = all.begin() + kShownHypotheses;
  std::partial_sort(
      all.begin(), end, all.end(),
      [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.weight > b.weight; });
  all.erase(end, all.end());
  return belief;
}

bool Schedule::due(double t_s) {
  constexpr double kRounding_s = 1e-6;
  if (t_s < due_s - kRounding_s) return false;
  due_s = t_s + period_s;
  return true;
}

Eigen::Isometry3d true_wMr(const mission::Tick& tick, const Ground& ground) {
  const auto& truth = tick.estimator.truth;
  return truth && truth->wMr ? *truth->wMr : ground.place(tick.truth.pose);
}

imaging::Overlay overlay_of(const mission::Tick& tick, const perception::Eye& eye) {
  imaging::Overlay overlay = eye.overlay();
  const double t_s = tick.estimator.now.seconds();
  if (!tick.attention) {
    overlay.lines.push_back(fmt::format("t = {:.2f} s", t_s));
    return overlay;
  }
  const mission::AttentionTick& attention = *tick.attention;
  overlay.lines.push_back(fmt::format("t = {:.2f} s   {}", t_s, to_string(attention.gaze)));
  if (attention.order)
    overlay.lines.push_back(fmt::format("landmark {}   look {}   zoom {:.1f} mm",
                                        attention.order->landmark, attention.look,
                                        tick.head.zoom_mm));
  if (attention.centring_px)
    overlay.lines.push_back(fmt::format("off centre {:.2f} px", *attention.centring_px));
  return overlay;
}

}  // namespace vigia::app
