#include "replay_json.hpp"

#include "base64.hpp"
#include "outlines.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vigia::report {
namespace {

using Json = nlohmann::ordered_json;

/// To a tenth of a millimetre or of a milliradian; null what is not finite.
Json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e4) / 1e4;
}

/// To three significant digits; null what is not finite.
Json significant(double value) {
  constexpr double kNothing = 1e-30;
  if (!std::isfinite(value)) return nullptr;
  if (std::abs(value) < kNothing) return 0.0;
  return std::stod(fmt::format("{:.3g}", value));
}

Json point(const Eigen::Vector2d& p) {
  return Json::array({rounded(p.x()), rounded(p.y())});
}

Json points(const std::vector<Eigen::Vector2d>& corners) {
  Json list = Json::array();
  for (const auto& corner : corners) list.push_back(point(corner));
  return list;
}

/// Which ticks are kept.
class Ticks {
 public:
  Ticks(std::size_t size, int max_ticks) {
    const std::size_t most = static_cast<std::size_t>(max_ticks);
    const std::size_t step = std::max<std::size_t>(1, (size + most - 1) / most);
    for (std::size_t i = 0; i < size; i += step) kept_.push_back(i);
    if (kept_.back() != size - 1) kept_.push_back(size - 1);
  }

  /// What @p value makes of each kept tick's row; [] of an empty column.
  template <typename Column, typename Value>
  Json column(const Column& rows, const Value& value) const {
    Json list = Json::array();
    if (rows.empty()) return list;
    for (const std::size_t i : kept_) list.push_back(value(rows[i]));
    return list;
  }
  const std::vector<std::size_t>& kept() const { return kept_; }

 private:
  std::vector<std::size_t> kept_;
};

// ---- the world ----------------------------------------------------------------------------------

std::string_view kind_of(const Landmark& landmark) {
  struct Name {
    std::string_view operator()(const DiscShape& /*disc*/) const { return "disc"; }
    std::string_view operator()(const PatternShape& /*pattern*/) const { return "pattern"; }
    std::string_view operator()(const TagShape& /*tag*/) const { return "tag"; }
  };
  return std::visit(Name{}, landmark.shape);
}

Json landmarks_json(const WorldMap& world) {
  Json list = Json::array();
  for (const auto& landmark : world.landmarks.all()) {
    const Eigen::Vector2d centre = world.in_plan(landmark);
    const Eigen::Vector3d normal = landmark.normal_w();
    list.push_back({{"id", landmark.id},
                    {"kind", kind_of(landmark)},
                    {"x", rounded(centre.x())},
                    {"y", rounded(centre.y())},
                    {"nx", rounded(normal.x())},
                    {"ny", rounded(normal.y())}});
  }
  return list;
}

Json line_json(const FieldLine& line) {
  return {{"width", rounded(line.width_m)}, {"points", points(line_points(line))}};
}

Json goal_json(const FieldGoal& goal) {
  const Eigen::Vector2d behind = (goal.centre().normalized() * goal.depth_m);
  return {{"colour", to_string(goal.colour)},
          {"points", points({goal.from, goal.to, goal.to + behind, goal.from + behind})}};
}

Json field_json(const FieldMap& field) {
  Json lines = Json::array();
  Json goals = Json::array();
  Json posts = Json::array();
  for (const auto& line : field.lines) lines.push_back(line_json(line));
  for (const auto& goal : field.goals) goals.push_back(goal_json(goal));
  for (const auto& post : field.posts)
    posts.push_back({{"colour", to_string(post.outer)},
                     {"x", rounded(post.at.x())},
                     {"y", rounded(post.at.y())},
                     {"radius", rounded(post.radius_m)}});
  const double x = 0.5 * field.length_m + field.margin_m;
  const double y = 0.5 * field.width_m + field.margin_m;
  return {{"carpet", points({{-x, -y}, {x, -y}, {x, y}, {-x, y}})},
          {"lines", lines},
          {"goals", goals},
          {"posts", posts}};
}

Json world_json(const WorldMap& world) {
  Json walls = Json::array();
  Json obstacles = Json::array();
  for (const auto& wall : world.plan.partitions())
    walls.push_back(
        {rounded(wall.a.x()), rounded(wall.a.y()), rounded(wall.b.x()), rounded(wall.b.y())});
  for (const auto& obstacle : world.plan.obstacles()) obstacles.push_back(points(obstacle.polygon));
  return {{"outline", points(world.plan.outline())},
          {"walls", walls},
          {"obstacles", obstacles},
          {"landmarks", landmarks_json(world)},
          {"field", world.field ? field_json(*world.field) : Json(nullptr)}};
}

// ---- localizers ---------------------------------------------------------------------------------

Json hypotheses_json(const std::vector<Belief>& beliefs, const Ticks& ticks) {
  Json list = Json::array();
  for (std::size_t k = 0; k < ticks.kept().size(); ++k) {
    const auto& hypotheses = beliefs[ticks.kept()[k]].hypotheses;
    if (hypotheses.empty()) continue;
    Json entries = Json::array();
    for (const auto& h : hypotheses)
      entries.push_back(
          {rounded(h.pose.x), rounded(h.pose.y), rounded(h.pose.theta), significant(h.weight)});
    list.push_back({k, entries});
  }
  return list;
}

Json errors_json(const ReplayRun& run, const std::vector<Belief>& beliefs, const Ticks& ticks,
                 double (*error)(const Eigen::Vector3d&)) {
  Json list = Json::array();
  for (const std::size_t i : ticks.kept())
    list.push_back(rounded(error(difference(beliefs[i].pose, run.truth[i]))));
  return list;
}

Json localizer_json(const ReplayRun& run, const ReplayLocalizer& localizer, const Ticks& ticks) {
  const auto& beliefs = localizer.beliefs;
  const auto variance = [&](int row, int column) {
    return ticks.column(beliefs,
                        [=](const Belief& b) { return significant(b.covariance(row, column)); });
  };
  return {
      {"name", localizer.name},
      {"primary", localizer.primary},
      {"x", ticks.column(beliefs, [](const Belief& b) { return rounded(b.pose.x); })},
      {"y", ticks.column(beliefs, [](const Belief& b) { return rounded(b.pose.y); })},
      {"vx", variance(0, 0)},
      {"vy", variance(1, 1)},
      {"cxy", variance(0, 1)},
      {"sigma",
       ticks.column(beliefs, [](const Belief& b) { return significant(b.position_sigma()); })},
      {"error", errors_json(run, beliefs, ticks,
                            [](const Eigen::Vector3d& e) { return e.head<2>().norm(); })},
      {"turn", errors_json(run, beliefs, ticks, [](const Eigen::Vector3d& e) { return e.z(); })},
      {"lost",
       ticks.column(beliefs, [](const Belief& b) { return significant(b.lost_probability); })},
      {"bound", ticks.column(localizer.bound_m, significant)},
      {"hypotheses", hypotheses_json(beliefs, ticks)}};
}

// ---- cameras ------------------------------------------------------------------------------------

Json ellipse_json(const std::optional<Ellipse>& ellipse) {
  if (!ellipse) return nullptr;
  return {rounded(ellipse->u), rounded(ellipse->v), rounded(ellipse->a), rounded(ellipse->b),
          rounded(ellipse->psi)};
}

/// To a tenth of a pixel: a scan of a field has hundreds in every picture.
Json pixels(const std::vector<Eigen::Vector2d>& places) {
  Json list = Json::array();
  for (const auto& p : places)
    list.push_back({std::round(10.0 * p.x()) / 10.0, std::round(10.0 * p.y()) / 10.0});
  return list;
}

Json overlay_json(const imaging::Overlay& overlay) {
  return {{"predicted", ellipse_json(overlay.predicted)},
          {"measured", ellipse_json(overlay.measured)},
          {"points", pixels(overlay.points)},
          {"principal", overlay.principal_point ? point(*overlay.principal_point) : Json(nullptr)},
          {"lines", overlay.lines}};
}

Json camera_json(const ReplayCamera& camera, const Ticks& ticks) {
  Json images = Json::array();
  for (const auto& image : camera.images)
    images.push_back({{"t", rounded(image.t_s)},
                      {"overlay", overlay_json(image.overlay)},
                      {"jpeg", base64(image.jpeg)}});
  return {{"name", camera.name},
          {"width", camera.width},
          {"height", camera.height},
          {"left", ticks.column(camera.left, rounded)},
          {"right", ticks.column(camera.right, rounded)},
          {"images", images}};
}

// ---- a run --------------------------------------------------------------------------------------

Json truth_json(const ReplayRun& run, const Ticks& ticks) {
  return {{"x", ticks.column(run.truth, [](const Pose2& p) { return rounded(p.x); })},
          {"y", ticks.column(run.truth, [](const Pose2& p) { return rounded(p.y); })},
          {"th", ticks.column(run.truth, [](const Pose2& p) { return rounded(p.theta); })}};
}

Json suitability_json(const ReplaySuitability& suitability) {
  Json times = Json::array();
  Json landmarks = Json::array();
  for (const double t_s : suitability.t_s) times.push_back(rounded(t_s));
  for (const auto& [id, values] : suitability.landmarks) {
    Json list = Json::array();
    for (const double value : values)
      list.push_back(std::isfinite(value) ? Json(std::round(value * 100.0) / 100.0)
                                          : Json(nullptr));
    landmarks.push_back({{"id", id}, {"values", list}});
  }
  return {{"t", times}, {"landmarks", landmarks}};
}

Json events_json(const std::vector<ReplayEvent>& events) {
  Json list = Json::array();
  for (const auto& event : events)
    list.push_back({{"t", rounded(event.t_s)}, {"kind", event.kind}, {"text", event.text}});
  return list;
}

Json run_json(const ReplayRun& run, int max_ticks) {
  const Ticks ticks(run.t_s.size(), max_ticks);
  Json localizers = Json::array();
  Json cameras = Json::array();
  for (const auto& localizer : run.localizers)
    localizers.push_back(localizer_json(run, localizer, ticks));
  for (const auto& camera : run.cameras) cameras.push_back(camera_json(camera, ticks));
  const auto target = [](const std::optional<LandmarkId>& id) {
    return id ? Json(*id) : Json(nullptr);
  };
  return {{"name", run.name},
          {"seed", run.seed},
          {"version", run.version},
          {"command", run.command},
          {"note", run.note},
          {"summary", Json::parse(run.summary_json, nullptr, false)},
          {"world", world_json(run.world)},
          {"planned", points(run.planned.points())},
          {"radius", rounded(run.robot_radius_m)},
          {"limits", run.limits_m ? point(*run.limits_m) : Json(nullptr)},
          {"t", ticks.column(run.t_s, rounded)},
          {"truth", truth_json(run, ticks)},
          {"speed", ticks.column(run.speed_mps, rounded)},
          {"pan", ticks.column(run.pan, rounded)},
          {"tilt", ticks.column(run.tilt, rounded)},
          {"zoom", ticks.column(run.zoom_mm, rounded)},
          {"target", ticks.column(run.target, target)},
          {"suitability", suitability_json(run.suitability)},
          {"localizers", localizers},
          {"cameras", cameras},
          {"events", events_json(run.events)}};
}

std::string subtitle_of(const std::vector<ReplayRun>& runs) {
  const ReplayRun& run = runs.front();
  const Json summary = Json::parse(run.summary_json, nullptr, false);
  if (runs.size() > 1 || !summary.is_object()) return "";
  return fmt::format("{} after {:.1f} s", summary.value("outcome", ""),
                     summary.value("sim_s", 0.0));
}

}  // namespace

std::string replay_json(const std::vector<ReplayRun>& runs, const std::string& title,
                        int max_ticks) {
  Json list = Json::array();
  for (const auto& run : runs) list.push_back(run_json(run, max_ticks));
  const Json data = {{"title", title}, {"subtitle", subtitle_of(runs)}, {"runs", list}};
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace vigia::report
