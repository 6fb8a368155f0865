#include "vigia/localization/field_match.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/localization/field_grid.hpp"
#include "vigia/localization/field_posterior.hpp"

namespace vigia::localization {
namespace {

constexpr double kScale = 200.0;   // 16 bits hold 300 points
constexpr double kReach_m = 10.0;  // a point farther off takes no part
constexpr std::size_t kFewestPoints = 6;
constexpr std::size_t kMostPoints = 300;
constexpr double kLikely = 0.05;  // suggestions of this weight get the moments of their posterior
constexpr double kSpreads_m[] = {0.10, 0.16, 0.25, 0.40};

bool same_pose(const Pose2& a, const Pose2& b, double metres, double radians) {
  const Eigen::Vector3d d = difference(a, b);
  return d.head<2>().norm() < metres && std::abs(d.z()) < radians;
}

/// Every n-th point, so that at most @p most are left.
std::vector<FieldPoint> thinned(const std::vector<FieldPoint>& points, std::size_t most) {
  if (points.size() <= most) return points;
  std::vector<FieldPoint> kept;
  for (std::size_t i = 0; i < most; ++i) kept.push_back(points[i * points.size() / most]);
  return kept;
}

/// Where both goals' places put the robot.
std::optional<Pose2> pose_by_goals(const FieldMap& map, const FieldScan& scan) {
  const ColourSighting* yellow = nullptr;
  const ColourSighting* blue = nullptr;
  for (const ColourSighting& seen : scan.goals) {
    if (seen.colour == FieldColour::yellow) yellow = &seen;
    if (seen.colour == FieldColour::blue) blue = &seen;
  }
  if (yellow == nullptr || blue == nullptr || map.goal(FieldColour::yellow) == nullptr ||
      map.goal(FieldColour::blue) == nullptr)
    return std::nullopt;
  const double heading = direction_by_places(map, *yellow, *blue);
  const ColourSighting& nearer = yellow->range_m < blue->range_m ? *yellow : *blue;
  const Eigen::Vector2d at =
      map.goal(nearer.colour)->centre() - nearer.range_m * unit_vector(heading + nearer.bearing);
  return Pose2{at.x(), at.y(), heading};
}

void weigh_suggestions(std::vector<FieldMatcher::Suggestion>& suggestions) {
  double sum = 0.0;
  for (auto& s : suggestions) {
    s.weight = std::exp(s.log_evidence - suggestions.front().log_evidence);
    sum += s.weight;
  }
  for (auto& s : suggestions) s.weight /= sum;
}

}  // namespace

FieldMatcher::FieldMatcher(const FieldModel& model, const FieldMatchParams& params)
    : model_(&model), params_(params) {
  const FieldMap& map = model.map();
  const double cell = params.cell_m;
  columns_ = static_cast<int>(std::ceil((map.length_m + 2.0 * params.beyond_m) / cell)) + 1;
  rows_ = static_cast<int>(std::ceil((map.width_m + 2.0 * params.beyond_m) / cell)) + 1;
  border_ = static_cast<int>(std::ceil(kReach_m / cell)) + 1;
  stride_ = columns_ + 2 * border_;
  const FieldDistance distance(map, 3.0 * kSpreads_m[3], 0.2);
  for (const double spread : kSpreads_m) {
    ScoreImage image{spread, {}};
    for (int row = -border_; row < rows_ + border_; ++row)
      for (int column = -border_; column < columns_ + border_; ++column) {
        const Eigen::Vector2d p(-0.5 * map.length_m - params.beyond_m + cell * column,
                                -0.5 * map.width_m - params.beyond_m + cell * row);
        const double d = distance.distance(p) / spread;
        image.scores.push_back(static_cast<std::uint16_t>(
            kScale * std::log1p(params.score_gain * 0.1 / spread * std::exp(-0.5 * d * d)) /
            std::log1p(params.score_gain)));
      }
    images_.push_back(std::move(image));
  }
}

const FieldMatcher::ScoreImage& FieldMatcher::image_for(const FieldPoint& point) const {
  // The point's own spread, half a cell and half a step of heading.
  const double own = 0.5 * point.covariance.trace();
  const double cell = params_.cell_m * params_.cell_m / 12.0;
  const double step = params_.heading_step * point.p_r.norm();
  const double sigma = std::sqrt(own + cell + step * step / 12.0);
  for (const ScoreImage& image : images_)
    if (sigma <= image.sigma_m) return image;
  return images_.back();
}

void FieldMatcher::correlate(const std::vector<FieldPoint>& points, double theta,
                             std::vector<std::uint16_t>& sums) const {
  std::fill(sums.begin(), sums.end(), std::uint16_t{0});
  const Eigen::Vector2d ahead = unit_vector(theta);
  for (const FieldPoint& point : points) {
    if (point.p_r.norm() > kReach_m) continue;
    const double x = ahead.x() * point.p_r.x() - ahead.y() * point.p_r.y();
    const double y = ahead.y() * point.p_r.x() + ahead.x() * point.p_r.y();
    const int shift_x = border_ + static_cast<int>(std::lround(x / params_.cell_m));
    const int shift_y = border_ + static_cast<int>(std::lround(y / params_.cell_m));
    const std::vector<std::uint16_t>& scores = image_for(point).scores;
    for (int row = 0; row < rows_; ++row) {
      const std::uint16_t* from = scores.data() + (row + shift_y) * stride_ + shift_x;
      std::uint16_t* to = sums.data() + row * columns_;
      for (int i = 0; i < columns_; ++i) to[i] = static_cast<std::uint16_t>(to[i] + from[i]);
    }
  }
}

void FieldMatcher::collect_peaks(const std::vector<std::uint16_t>& sums, double theta,
                                 std::vector<Peak>& peaks) const {
  for (int row = 1; row + 1 < rows_; ++row)
    for (int column = 1; column + 1 < columns_; ++column) {
      const std::uint16_t* at = sums.data() + row * columns_ + column;
      if (at[0] < at[-1] || at[0] <= at[1] || at[0] < at[-columns_] || at[0] <= at[columns_])
        continue;
      peaks.push_back({{-0.5 * model_->map().length_m - params_.beyond_m + params_.cell_m * column,
                        -0.5 * model_->map().width_m - params_.beyond_m + params_.cell_m * row,
                        wrap_angle(theta)},
                       at[0]});
    }
}

std::vector<FieldMatcher::Peak> FieldMatcher::best_peaks(const FieldScan& scan) const {
  const std::vector<FieldPoint> points = thinned(scan.points, kMostPoints);
  const double turn = model_->lines_symmetric() ? kPi : 2.0 * kPi;
  const int steps = static_cast<int>(std::ceil(turn / params_.heading_step));
  std::vector<std::uint16_t> sums(static_cast<std::size_t>(columns_ * rows_));
  std::vector<Peak> peaks;
  for (int i = 0; i < steps; ++i) {
    const double theta = turn * i / steps;
    correlate(points, theta, sums);
    collect_peaks(sums, theta, peaks);
  }
  const auto higher = [](const Peak& a, const Peak& b) { return a.score > b.score; };
  const std::size_t most =
      std::min(peaks.size(), static_cast<std::size_t>(20 * params_.candidates));
  std::partial_sort(peaks.begin(), peaks.begin() + static_cast<std::ptrdiff_t>(most), peaks.end(),
                    higher);
  std::vector<Peak> apart;
  for (std::size_t i = 0; i < most && apart.size() < static_cast<std::size_t>(params_.candidates);
       ++i) {
    const bool near_another = std::any_of(apart.begin(), apart.end(), [&](const Peak& other) {
      return same_pose(peaks[i].pose, other.pose, 1.6 * params_.cell_m, 2.1 * params_.heading_step);
    });
    if (!near_another) apart.push_back(peaks[i]);
  }
  return apart;
}

std::vector<FieldMatcher::Suggestion> FieldMatcher::match(const FieldScan& scan) const {
  std::vector<Suggestion> found;
  if (scan.points.size() < kFewestPoints) return found;
  FieldRefineParams rough;
  rough.spread_m = 0.15;
  rough.iterations = 12;
  rough.converged = 1e-3;
  const std::vector<StraightGroup> groups = model_->groups_of(scan);
  const auto add = [&](const FieldFix& fix) {
    const double log_evidence =
        log_evidence_of(*model_, scan, groups, fix, model_->params().clutter);
    for (Suggestion& other : found)
      if (same_pose(other.fix.pose, fix.pose, params_.same_m, params_.same_rad)) {
        if (log_evidence > other.log_evidence) other = {fix, log_evidence, 0.0};
        return;
      }
    found.push_back({fix, log_evidence, 0.0});
  };
  std::vector<Peak> starts = best_peaks(scan);
  if (const auto by_goals = pose_by_goals(model_->map(), scan)) starts.push_back({*by_goals, 0});
  for (const Peak& peak : starts) {
    FieldFix fix = refine_field_pose(*model_, scan.points, peak.pose, std::nullopt, rough);
    if (fix.status == FieldFixStatus::degenerate) continue;
    if (!model_->map().contains(fix.pose.position(), 2.0 * params_.beyond_m)) continue;
    add(fix);
    if (!model_->lines_symmetric()) continue;
    fix.pose = FieldModel::half_turned(fix.pose);
    fix.covariance = FieldModel::half_turned(fix.covariance);
    add(fix);
  }
  std::sort(found.begin(), found.end(), [](const Suggestion& a, const Suggestion& b) {
    return a.log_evidence > b.log_evidence;
  });
  if (found.size() > static_cast<std::size_t>(params_.hypotheses))
    found.resize(static_cast<std::size_t>(params_.hypotheses));
  if (found.empty()) return found;
  weigh_suggestions(found);
  for (Suggestion& suggestion : found) {
    if (suggestion.weight < kLikely) break;
    const FieldPosterior posterior = posterior_about(*model_, scan.points, groups, suggestion.fix);
    suggestion.fix.pose = posterior.mean;
    suggestion.fix.covariance = posterior.covariance;
  }
  return found;
}

std::vector<FieldMatcher::Suggestion> without_twins(
    const std::vector<FieldMatcher::Suggestion>& suggestions) {
  constexpr double kTwin_m = 0.3;
  constexpr double kTwinTurn = 0.3;
  std::vector<FieldMatcher::Suggestion> kept;
  for (const auto& suggestion : suggestions) {
    const Pose2 twin = FieldModel::half_turned(suggestion.fix.pose);
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const auto& other) {
      return same_pose(other.fix.pose, twin, kTwin_m, kTwinTurn);
    });
    if (!known) kept.push_back(suggestion);
  }
  return kept;
}

}  // namespace vigia::localization
