#include "papers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/evaluation/quixote_setting.hpp"
#include "vigia/evaluation/rendered_views.hpp"
#include "vigia/report/curve_chart.hpp"

namespace vigia::app {
namespace {

using evaluation::kViewQuantities;
using evaluation::LimitErrors;
using evaluation::MethodErrors;
using evaluation::PatternView;
using evaluation::QuixoteSetting;
using evaluation::ViewMethod;

constexpr int kRandomViews = 2000;
constexpr int kRenderedViews = 1000;
constexpr int kSweepViews = 400;
constexpr std::uint64_t kSeed = 1;
constexpr std::array<double, 3> kNoise_px{0.1, 0.5, 1.0};

/// A column of the paper's Table 1 (absolute errors), and the scale of its percentages.
struct TableQuantity {
  const char* name;
  const char* unit;
  double factor;  ///< from rad or m to the unit
  double mean;
  double greatest;
  double full_scale;  ///< in the unit
};

constexpr std::array<TableQuantity, kViewQuantities> kTable1{
    TableQuantity{"φ", "°", 180.0 / kPi, 0.44, 2.10, 90.0},
    TableQuantity{"θ", "°", 180.0 / kPi, 0.83, 3.74, 90.0},
    TableQuantity{"D", "cm", 100.0, 2.89, 11.30, 800.0},
    TableQuantity{"x", "cm", 100.0, 3.01, 7.90, 600.0},
    TableQuantity{"y", "cm", 100.0, 2.95, 11.79, 600.0},
    TableQuantity{"z", "cm", 100.0, 3.09, 8.16, 250.0}};

/// Every method on the same views.
struct Judged {
  std::string where;  ///< and under which noise
  int views;
  MethodErrors printed;
  MethodErrors as_published;
  MethodErrors exact;
  MethodErrors refined;
  LimitErrors limit;
};

Judged judge(const std::vector<PatternView>& views, std::string where) {
  return {std::move(where),
          static_cast<int>(views.size()),
          judge_views(views, ViewMethod::printed),
          judge_views(views, ViewMethod::as_published),
          judge_views(views, ViewMethod::exact),
          judge_views(views, ViewMethod::refined),
          limit_of_views(views)};
}

void add_rows(const Judged& judged, evaluation::PaperTable& table) {
  for (std::size_t i = 0; i < kViewQuantities; ++i) {
    const TableQuantity& q = kTable1[i];
    const auto name = [&](const char* what) {
      return fmt::format("{}: {} {}", judged.where, q.name, what);
    };
    const auto published = judged.as_published.quantities[i];
    const auto exact = judged.exact.quantities[i];
    const auto refined = judged.refined.quantities[i];
    evaluation::PaperRow mean{name("mean"), q.unit, q.mean};
    mean.as_published = q.factor * published.mean;
    mean.best = q.factor * refined.mean;
    mean.limit = q.factor * judged.limit.mean[i];
    mean.n = judged.views;
    evaluation::PaperRow greatest{name("greatest"), q.unit, q.greatest};
    greatest.as_published = q.factor * published.greatest;
    greatest.best = q.factor * refined.greatest;
    greatest.n = judged.views;
    evaluation::PaperRow closed{name("mean, exact closed form"), q.unit};
    closed.best = q.factor * exact.mean;
    closed.limit = q.factor * judged.limit.mean[i];
    closed.n = judged.exact.views;
    evaluation::PaperRow rms{name("rms"), q.unit};
    rms.as_published = q.factor * published.rms;
    rms.best = q.factor * refined.rms;
    rms.limit = q.factor * judged.limit.rms[i];
    rms.n = judged.views;
    for (auto& row : {mean, closed, rms, greatest}) table.rows.push_back(row);
  }
  evaluation::PaperRow printed{fmt::format("{}: θ mean, signs as printed", judged.where), "°"};
  printed.as_published = to_deg(judged.printed.quantities[1].mean);
  printed.n = judged.printed.views;
  table.rows.push_back(printed);
}

/// The room once more, from pixels.
void add_rendered(const QuixoteSetting& setting, int count, evaluation::PaperTable& table) {
  constexpr sim::ImagingParams kImaging{4.0, 0.7, true};
  RandomStream random(kSeed, "random views");
  const auto views = random_views(setting, 0.1, std::min(count, kRenderedViews), random);
  const auto rendered = evaluation::render_views(setting, views, kImaging, kSeed);
  add_rows(judge(rendered.read, "room, rendered"), table);
  const auto row = [&](const char* what, int number) {
    evaluation::PaperRow r{fmt::format("room, rendered: {}", what), "views"};
    r.best = number;
    r.n = static_cast<int>(views.size());
    table.rows.push_back(r);
  };
  row("rejected", rendered.rejected);
  row("wrong codes", rendered.wrong);
  table.noise.emplace_back("rendered_noise_sigma", kImaging.noise_sigma);
  table.noise.emplace_back("rendered_blur_px", kImaging.blur_px);
}

/// Mean errors of position in cm at one distance off the centre.
struct Price {
  double off_px = 0.0;
  double published = 0.0;  ///< the pattern taken to lie on the axis
  double uncentred = 0.0;
  double corrected = 0.0;
  double refined = 0.0;
};

double mean_position_cm(const std::vector<PatternView>& views, ViewMethod method) {
  double sum = 0.0;
  int count = 0;
  for (const PatternView& view : views) {
    const auto e = view_errors(view, method);
    if (!e) continue;
    sum += 100.0 * std::sqrt((*e)[3] * (*e)[3] + (*e)[4] * (*e)[4] + (*e)[5] * (*e)[5]);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

/// The same views, turned so that the pattern lies @p off_px off the centre in a random direction.
Price price_at(const QuixoteSetting& setting, const std::vector<PatternView>& views,
               double off_px) {
  RandomStream random(kSeed, "off-centring");  // the same noise at every distance
  QuixoteSetting wide = setting;  // the question is the assumption, not the image's border
  wide.camera.width *= 4;
  wide.camera.height *= 4;
  wide.camera.u0 += 1.5 * setting.camera.width;
  wide.camera.v0 += 1.5 * setting.camera.height;
  std::vector<PatternView> off;
  for (const PatternView& view : views) {
    const double turn = random.uniform(0.0, 2.0 * kPi);
    const Eigen::Vector2d by = off_px * unit_vector(turn);
    off.push_back(quixote_view(wide, view.landmark, view.wMc.translation(), by, 0.1, random));
  }
  return {off_px, mean_position_cm(off, ViewMethod::as_published),
          mean_position_cm(off, ViewMethod::uncentred), mean_position_cm(off, ViewMethod::exact),
          mean_position_cm(off, ViewMethod::refined)};
}

std::vector<PatternView> near_views(const QuixoteSetting& setting) {
  QuixoteSetting near = setting;
  near.max_distance_m = 2.5;
  RandomStream random(kSeed, "near views");
  return random_views(near, 0.1, kSweepViews, random);
}

void sweep_off_centre(const QuixoteSetting& setting, const std::filesystem::path& out,
                      evaluation::PaperTable& table) {
  report::CurveChart chart{"The price of the assumption: 1.25–2.5 m, 0.1 px",
                           "pattern off the image's centre, px",
                           "mean position error, cm",
                           {{"as published", {}},
                            {"exact, not turned", {}},
                            {"turned by homography", {}},
                            {"refined", {}, report::Curve::Look::dashed}}};
  chart.from_zero = false;
  chart.decades = true;
  const std::vector<PatternView> views = near_views(setting);
  for (double off = 0.0; off <= 200.0; off += 10.0) {
    const Price price = price_at(setting, views, off);
    chart.curves[0].points.emplace_back(off, price.published);
    chart.curves[1].points.emplace_back(off, price.uncentred);
    chart.curves[2].points.emplace_back(off, price.corrected);
    chart.curves[3].points.emplace_back(off, price.refined);
    if (std::fmod(off, 50.0) != 0.0) continue;
    evaluation::PaperRow row{
        fmt::format("{} px off the centre, 1.25–2.5 m, 0.1 px: position, no homography", off),
        "cm"};
    row.as_published = price.published;
    row.best = price.uncentred;
    row.n = kSweepViews;
    table.rows.push_back(row);
    row.quantity = fmt::format("{} px off the centre, homography", off);
    row.as_published.reset();
    row.best = price.corrected;
    table.rows.push_back(row);
  }
  write_curve_chart(out / "off-centring.png", chart);
}

/// The paper's Figure 7: true and computed places in the room, and relative errors along the path.
void draw_route(const QuixoteSetting& setting, const std::vector<PatternView>& route,
                const std::filesystem::path& out) {
  const double w = setting.room_m.x();
  const double d = setting.room_m.y();
  report::CurveChart plan{"The guided route, 0.5 px", "x, m", "y, m", {}, true};
  report::Curve truth{"true", {}};
  report::Curve published{"as published", {}, report::Curve::Look::marks};
  report::Curve refined{"refined", {}, report::Curve::Look::marks};
  report::CurveChart errors{
      "Errors along the route, as published, 0.5 px", "view", "error, % of full scale", {}};
  for (const TableQuantity& q : kTable1) errors.curves.push_back({q.name, {}});
  for (std::size_t k = 0; k < route.size(); ++k) {
    const Eigen::Vector2d at = route[k].wMc.translation().head<2>();
    truth.points.push_back(at);
    const auto theirs = view_errors(route[k], ViewMethod::as_published);
    if (const auto ours = view_errors(route[k], ViewMethod::refined))
      refined.points.push_back(at + Eigen::Vector2d((*ours)[3], (*ours)[4]));
    if (!theirs) continue;
    published.points.push_back(at + Eigen::Vector2d((*theirs)[3], (*theirs)[4]));
    for (std::size_t i = 0; i < kViewQuantities; ++i)
      errors.curves[i].points.emplace_back(
          static_cast<double>(k + 1),
          100.0 * kTable1[i].factor * std::abs((*theirs)[i]) / kTable1[i].full_scale);
  }
  const report::Curve room{"room", {{0.0, 0.0}, {w, 0.0}, {w, d}, {0.0, d}, {0.0, 0.0}}};
  plan.curves = {truth, published, refined, room};
  write_curve_chart(out / "route.png", plan);
  write_curve_chart(out / "route-errors.png", errors);
}

}  // namespace

evaluation::PaperTable reproduce_quixote(const PaperOptions& options) {
  const QuixoteSetting setting;
  const int count = options.seeds > 0 ? options.seeds : kRandomViews;
  evaluation::PaperTable table{"quixote", {}, {}, {}};
  table.noise = {{"focal_px", setting.camera.px},
                 {"centring_sigma_px", setting.centring_sigma_px},
                 {"camera_height_m", setting.camera_height_m}};
  for (const double sigma : kNoise_px) {
    RandomStream random(kSeed, "random views");  // the same views at every noise
    add_rows(judge(random_views(setting, sigma, count, random), fmt::format("room, {} px", sigma)),
             table);
  }
  RandomStream random(kSeed, "route");
  const std::vector<PatternView> route = route_views(setting, 0.5, random);
  add_rows(judge(route, "route, 0.5 px"), table);
  add_rendered(setting, count, table);
  draw_route(setting, route, options.out);
  sweep_off_centre(setting, options.out, table);
  table.remarks = {"noise in px is that of each dot's centre; best is the refined pose",
                   "limit: mean of √(2/π) σ by the Cramér–Rao bound, for rms rows its rms",
                   "published: Table 1 of the paper, over its own images"};
  return table;
}

}  // namespace vigia::app
