#include "vigia/tracking/point_picture_run.hpp"

#include "assignment.hpp"
#include "csv_text.hpp"
#include "label_places.hpp"
#include "lost_feature.hpp"
#include "overlay_pen.hpp"
#include "target_motion.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "vigia/core/error.hpp"

namespace vigia::tracking {
namespace {

constexpr int kTagCorners = 4;

Eigen::Vector2d mean_point(const PointsFeature& feature) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const LabelledPoint& point : feature.points) sum += point.uv;
  return sum / static_cast<double>(feature.points.size());
}

bool is_found(const PointsFeature& feature) {
  return feature.status == FeatureStatus::found;
}

bool same_landmark(const PointsFeature& a, const PointsFeature& b) {
  constexpr double kSame = 4.0;  // px
  return a.code && b.code && *a.code == *b.code && !a.points.empty() && !b.points.empty() &&
         (mean_point(a) - mean_point(b)).norm() < kSame;
}

cv::Rect box_of(const PointsFeature& feature) {
  std::vector<cv::Point> points;
  for (const LabelledPoint& point : feature.points)
    points.emplace_back(static_cast<int>(std::lround(point.uv.x())),
                        static_cast<int>(std::lround(point.uv.y())));
  return cv::boundingRect(points);
}

void draw_points(const PointsFeature& feature, const OverlayPen& pen) {
  constexpr int kRoomy = 60;  // px: smaller, the labels would bury the landmark
  const auto& points = feature.points;
  const bool tag = std::holds_alternative<int>(*feature.code);
  for (std::size_t i = 0; tag && points.size() == kTagCorners && i < points.size(); ++i)
    pen.line(points[i].uv, points[(i + 1) % points.size()].uv);
  const cv::Rect box = box_of(feature);
  const bool roomy = std::min(box.width, box.height) >= kRoomy;
  for (const LabelledPoint& point : points) {
    pen.cross(point.uv, roomy ? 4.0 : 2.0);
    if (roomy)
      pen.text(std::to_string(point.label),
               {static_cast<int>(point.uv.x()) + 5, static_cast<int>(point.uv.y()) - 4}, 0.35);
  }
}

}  // namespace

class PointPictureRun::State {
  struct Target {
    int number;
    std::unique_ptr<PointTracker> tracker;
    LandmarkCode code;
    TargetMotion motion;
  };

 public:
  explicit State(const PointPictureRunParams& params);

  std::vector<PointPictureRow> next(const imaging::Frame& picture);

 private:
  bool search_is_due() const;
  bool is_known(const LandmarkCode& code) const;
  PointsFeature within_limits(PointsFeature feature) const;
  std::vector<PointsFeature> search(const imaging::Frame& picture) const;
  std::vector<PointsFeature> claim(const imaging::Frame& picture, std::vector<PointsFeature>& seen);
  void track_unclaimed(const imaging::Frame& picture, std::vector<PointsFeature>& features);
  void adopt(const imaging::Frame& picture, const std::vector<PointsFeature>& seen,
             std::vector<PointsFeature>& features);
  int number_for(const LandmarkCode& code);
  std::vector<PointPictureRow> conclude(const std::vector<PointsFeature>& features,
                                        const std::vector<PointsFeature>& seen);

  PointPictureRunParams params_;
  std::unique_ptr<PointTracker> finder_;
  std::vector<Target> targets_;
  /// The code of each number, from 1: a code that comes back has its number again.
  std::vector<LandmarkCode> codes_;
  int pictures_ = 0;
  int held_ = 0;  ///< targets that were found in the last picture
  int width_ = 0;
  int height_ = 0;
};

PointPictureRun::State::State(const PointPictureRunParams& params)
    : params_(params), finder_(make_point_tracker(params.tracker, {})) {
  if (!finder_)
    throw InputError("there is no tracker '" + params.tracker + "'; known are 'pattern' and 'tag'");
}

std::vector<PointPictureRow> PointPictureRun::State::next(const imaging::Frame& picture) {
  if (picture.width() != width_ || picture.height() != height_) targets_.clear();
  width_ = picture.width();
  height_ = picture.height();
  for (Target& target : targets_) target.motion.pass();

  std::vector<PointsFeature> seen;
  if (search_is_due()) seen = search(picture);
  ++pictures_;
  std::vector<PointsFeature> features = claim(picture, seen);
  track_unclaimed(picture, features);
  adopt(picture, seen, features);
  return conclude(features, seen);
}

bool PointPictureRun::State::search_is_due() const {
  if (targets_.empty()) return true;
  if (params_.expected > 0 && held_ >= params_.expected) return false;
  return pictures_ % std::max(1, params_.every) == 0;
}

bool PointPictureRun::State::is_known(const LandmarkCode& code) const {
  return params_.known.empty() ||
         std::find(params_.known.begin(), params_.known.end(), code) != params_.known.end();
}

PointsFeature PointPictureRun::State::within_limits(PointsFeature feature) const {
  if (!is_found(feature)) return feature;
  if (!is_known(*feature.code))
    feature.status = FeatureStatus::unknown_code;
  else if (feature.confidence < params_.min_confidence)
    feature.status = FeatureStatus::unreadable;
  return feature;
}

std::vector<PointsFeature> PointPictureRun::State::search(const imaging::Frame& picture) const {
  std::vector<PointsFeature> seen;
  for (const PointsFeature& feature : finder_->find_all(picture))
    seen.push_back(within_limits(feature));
  return seen;
}

// Gives each target the landmark that says its code; the others stay in @p seen.
std::vector<PointsFeature> PointPictureRun::State::claim(const imaging::Frame& picture,
                                                         std::vector<PointsFeature>& seen) {
  const auto away = [&](std::size_t i, std::size_t j) -> std::optional<double> {
    if (!is_found(seen[j]) || !(*seen[j].code == targets_[i].code)) return std::nullopt;
    return (mean_point(seen[j]) - targets_[i].motion.predicted()).norm();
  };
  const auto seen_of = assign_nearest(targets_.size(), seen.size(), away);
  std::vector<PointsFeature> features(targets_.size());
  std::vector<bool> claimed(seen.size(), false);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (!seen_of[i]) continue;
    features[i] = seen[*seen_of[i]];
    claimed[*seen_of[i]] = true;
    targets_[i].tracker->start(picture, features[i]);
  }
  std::vector<PointsFeature> unclaimed;
  for (std::size_t j = 0; j < seen.size(); ++j)
    if (!claimed[j]) unclaimed.push_back(seen[j]);
  seen = std::move(unclaimed);
  return features;
}

void PointPictureRun::State::track_unclaimed(const imaging::Frame& picture,
                                             std::vector<PointsFeature>& features) {
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (is_found(features[i])) continue;
    targets_[i].tracker->expect_motion(targets_[i].motion.velocity());
    PointsFeature tracked = within_limits(targets_[i].tracker->track(picture));
    const bool taken = std::any_of(features.begin(), features.end(), [&](const auto& other) {
      return is_found(other) && same_landmark(other, tracked);
    });
    features[i] = taken ? lost_points(FeatureStatus::wrong_object) : std::move(tracked);
  }
}

// The number that the code had when no target of it is followed; otherwise the next.
int PointPictureRun::State::number_for(const LandmarkCode& code) {
  for (std::size_t k = 0; k < codes_.size(); ++k) {
    const int number = static_cast<int>(k) + 1;
    const bool in_use = std::any_of(targets_.begin(), targets_.end(),
                                    [&](const Target& t) { return t.number == number; });
    if (codes_[k] == code && !in_use) return number;
  }
  codes_.push_back(code);
  return static_cast<int>(codes_.size());
}

// Makes targets of the landmarks that are nobody's.
void PointPictureRun::State::adopt(const imaging::Frame& picture,
                                   const std::vector<PointsFeature>& seen,
                                   std::vector<PointsFeature>& features) {
  for (const PointsFeature& feature : seen) {
    const bool known = std::any_of(features.begin(), features.end(), [&](const auto& other) {
      return is_found(other) && same_landmark(feature, other);
    });
    if (!is_found(feature) || known) continue;
    targets_.push_back({number_for(*feature.code), make_point_tracker(params_.tracker, {}),
                        *feature.code, TargetMotion(mean_point(feature))});
    targets_.back().tracker->start(picture, feature);
    features.push_back(feature);
  }
}

std::vector<PointPictureRow> PointPictureRun::State::conclude(
    const std::vector<PointsFeature>& features, const std::vector<PointsFeature>& seen) {
  std::vector<PointPictureRow> rows;
  std::vector<Target> kept;
  held_ = 0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    Target& target = targets_[i];
    PointsFeature feature = features[i];
    if (!feature.code) feature.code = target.code;
    rows.push_back({target.number, feature});
    if (is_found(feature)) {
      target.motion.see(mean_point(feature));
      ++held_;
    }
    if (target.motion.unseen() <= params_.remember) kept.push_back(std::move(target));
  }
  targets_ = std::move(kept);
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return a.target < b.target; });
  for (const PointsFeature& feature : seen)
    if (!is_found(feature)) rows.push_back({0, feature});
  return rows;
}

PointPictureRun::PointPictureRun(const PointPictureRunParams& params)
    : state_(std::make_unique<State>(params)) {}
PointPictureRun::~PointPictureRun() = default;
PointPictureRun::PointPictureRun(PointPictureRun&&) noexcept = default;

std::vector<PointPictureRow> PointPictureRun::next(const imaging::Frame& picture) {
  return state_->next(picture);
}

std::string to_string(const LandmarkCode& code) {
  if (const int* tag = std::get_if<int>(&code)) return std::to_string(*tag);
  const auto& pattern = std::get<PatternCode>(code);
  return std::to_string(pattern.floor) + '-' + std::to_string(pattern.room) + '-' +
         std::to_string(pattern.pattern);
}

std::string points_csv_header() {
  return "status,code,confidence,label,u,v,sigma_u,sigma_v,correlation";
}

std::string points_csv_lines(const PointsFeature& feature, const std::string& start) {
  const std::string landmark = start + std::string(to_string(feature.status)) + ',' +
                               (feature.code ? to_string(*feature.code) : "");
  if (!is_found(feature)) return landmark + std::string(7, ',') + '\n';
  std::string lines;
  for (const LabelledPoint& point : feature.points) {
    const double sigma_u = std::sqrt(point.covariance(0, 0));
    const double sigma_v = std::sqrt(point.covariance(1, 1));
    lines += landmark + ',' + csv_number(feature.confidence, 6) + ',' + std::to_string(point.label);
    for (const double value : {point.uv.x(), point.uv.y(), sigma_u, sigma_v})
      lines += ',' + csv_number(value, 4);
    lines += ',' + csv_number(point.covariance(0, 1) / (sigma_u * sigma_v), 3) + '\n';
  }
  return lines;
}

void draw_overlay(const std::vector<PointPictureRow>& rows, vpImage<vpRGBa>& picture) {
  LabelPlaces places(static_cast<int>(picture.getWidth()), static_cast<int>(picture.getHeight()));
  const auto drawn = [](const PointPictureRow& row) {
    return row.feature.code && !row.feature.points.empty();
  };
  for (const PointPictureRow& row : rows)
    if (drawn(row)) places.keep_free(box_of(row.feature));
  struct Label {
    std::string words;
    cv::Point at;
  };
  constexpr double kScale = 0.5;
  std::vector<Label> labels;
  for (const PointPictureRow& row : rows) {
    if (!drawn(row)) continue;
    const std::string number = row.target > 0 ? " (" + std::to_string(row.target) + ')' : "";
    const std::string words = to_string(*row.feature.code) + number;
    labels.push_back({words, places.place(box_of(row.feature), words, kScale)});
  }
  draw_twice(picture, [&](const OverlayPen& pen) {
    for (const PointPictureRow& row : rows)
      if (drawn(row)) draw_points(row.feature, pen);
    for (const Label& label : labels) pen.text(label.words, label.at, kScale);
  });
}

}  // namespace vigia::tracking
