#include "vigia/tracking/picture_run.hpp"

#include "assignment.hpp"
#include "csv_text.hpp"
#include "label_places.hpp"
#include "lost_feature.hpp"
#include "overlay_pen.hpp"
#include "target_motion.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/error.hpp"
#include "vigia/tracking/correlation_tracker.hpp"
#include "vigia/tracking/moving_edge_tracker.hpp"

namespace vigia::tracking {
namespace {

Eigen::Vector2d centre_of(const Ellipse& ellipse) {
  return {ellipse.u, ellipse.v};
}

double log_size_step(const Ellipse& a, const Ellipse& b) {
  return 0.5 * std::log(a.a * a.b / (b.a * b.b));
}

bool same_disc(const EllipseFeature& a, const EllipseFeature& b) {
  return a.status == FeatureStatus::found && b.status == FeatureStatus::found &&
         (centre_of(a.ellipse) - centre_of(b.ellipse)).norm() <
             0.5 * std::min(a.ellipse.b, b.ellipse.b);
}

}  // namespace

std::unique_ptr<EllipseTracker> make_picture_tracker(const PictureRunParams& params) {
  DiscTrackerParameters disc;
  disc.polarity = params.polarity;
  disc.min_axis_px = std::clamp(params.min_radius_px, 3.0, 20.0);
  disc.search_margin_px = 20.0;
  // Prints and prints' edges are less perfect than the landmarks of a mission.
  disc.max_outline_px = 0.6;
  disc.max_raggedness_px = 0.35;
  disc.min_agreement = 0.8;
  disc.robust = true;
  if (params.tracker == "disc") return std::make_unique<DiscTracker>(disc);
  if (params.tracker == "ellipse") {
    MovingEdgeTrackerParameters parameters;
    parameters.min_visible = 0.35;
    parameters.finder = disc;
    return std::make_unique<MovingEdgeTracker>(parameters);
  }
  if (params.tracker == "correlation") {
    CorrelationTrackerParameters parameters;
    parameters.finder = disc;
    parameters.search_margin_px = disc.search_margin_px;
    return std::make_unique<CorrelationTracker>(parameters);
  }
  return nullptr;
}

class PictureRun::State {
  struct Target {
    int number;
    std::unique_ptr<EllipseTracker> tracker;
    Ellipse last;  ///< as it was last found
    bool dark;
    TargetMotion motion;
  };

 public:
  explicit State(const PictureRunParams& params);

  std::vector<PictureRow> next(const imaging::Frame& picture);

 private:
  static std::optional<double> distance(const Target& target, const EllipseFeature& disc);
  bool search_is_due() const;
  EllipseFeature within_limits(const EllipseFeature& feature, double slack) const;
  std::vector<EllipseFeature> search(imaging::Canvas& canvas);
  std::vector<EllipseFeature> claim(imaging::Canvas& canvas, std::vector<EllipseFeature>& discs);
  void track_unclaimed(imaging::Canvas& canvas, std::vector<EllipseFeature>& features);
  void give_up_doubles(std::vector<EllipseFeature>& features) const;
  bool is_another_scene(const std::vector<EllipseFeature>& features,
                        const std::vector<EllipseFeature>& newcomers) const;
  void forget_lost(std::vector<EllipseFeature>& features);
  void adopt(imaging::Canvas& canvas, const std::vector<EllipseFeature>& discs,
             std::vector<EllipseFeature>& features);
  std::vector<PictureRow> conclude(const std::vector<EllipseFeature>& features);

  PictureRunParams params_;
  std::unique_ptr<EllipseTracker> finder_;
  std::vector<Target> targets_;
  int numbers_ = 0;
  int pictures_ = 0;
  int held_ = 0;  ///< targets that were found in the last picture
  int width_ = 0;
  int height_ = 0;
};

PictureRun::State::State(const PictureRunParams& params)
    : params_(params), finder_(make_picture_tracker(params)) {
  if (!finder_)
    throw InputError("there is no tracker '" + params.tracker +
                     "'; known are 'disc', 'ellipse' and 'correlation'");
}

std::vector<PictureRow> PictureRun::State::next(const imaging::Frame& picture) {
  imaging::Canvas canvas;
  canvas.attach(picture);
  if (picture.width() != width_ || picture.height() != height_) targets_.clear();
  width_ = picture.width();
  height_ = picture.height();
  for (Target& target : targets_) target.motion.pass();

  std::vector<EllipseFeature> discs;
  if (search_is_due()) discs = search(canvas);
  ++pictures_;
  std::vector<EllipseFeature> features = claim(canvas, discs);
  track_unclaimed(canvas, features);
  give_up_doubles(features);
  if (is_another_scene(features, discs)) forget_lost(features);
  adopt(canvas, discs, features);
  return conclude(features);
}

// How far a disc lies from where the target is predicted; nothing when it can't be the target.
std::optional<double> PictureRun::State::distance(const Target& target,
                                                  const EllipseFeature& disc) {
  constexpr double kScaleStep = 0.3;
  constexpr double kScaleAging = 0.03;
  const double size_step = kScaleStep + kScaleAging * target.motion.unseen();
  const double away = (centre_of(disc.ellipse) - target.motion.predicted()).norm();
  if ((disc.contrast > 0.0) != target.dark || away > target.motion.reach(target.last.a) ||
      std::abs(log_size_step(disc.ellipse, target.last)) > size_step)
    return std::nullopt;
  return away;
}

bool PictureRun::State::search_is_due() const {
  if (targets_.empty()) return true;
  if (params_.expected > 0 && held_ >= params_.expected) return false;
  return pictures_ % std::max(1, params_.every) == 0;
}

// The radii may be off their range by the factor @p slack.
EllipseFeature PictureRun::State::within_limits(const EllipseFeature& feature, double slack) const {
  if (feature.status != FeatureStatus::found) return feature;
  if (feature.score < params_.min_score)
    return lost_ellipse(FeatureStatus::not_found, feature.score);
  if (slack * feature.ellipse.b < params_.min_radius_px ||
      feature.ellipse.a > slack * params_.max_radius_px)
    return lost_ellipse(FeatureStatus::wrong_object, feature.score);
  return feature;
}

std::vector<EllipseFeature> PictureRun::State::search(imaging::Canvas& canvas) {
  std::vector<EllipseFeature> discs;
  for (const EllipseFeature& disc : finder_->find_all(canvas))
    if (within_limits(disc, 1.0).status == FeatureStatus::found) discs.push_back(disc);
  return discs;
}

// Gives each target the disc that is its own; the others stay in @p discs.
std::vector<EllipseFeature> PictureRun::State::claim(imaging::Canvas& canvas,
                                                     std::vector<EllipseFeature>& discs) {
  const auto disc_of =
      assign_nearest(targets_.size(), discs.size(),
                     [&](std::size_t i, std::size_t j) { return distance(targets_[i], discs[j]); });
  std::vector<EllipseFeature> features(targets_.size());
  std::vector<bool> claimed(discs.size(), false);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (!disc_of[i]) continue;
    features[i] = discs[*disc_of[i]];
    claimed[*disc_of[i]] = true;
    targets_[i].tracker->start(canvas, features[i].ellipse);
  }
  std::vector<EllipseFeature> unclaimed;
  for (std::size_t j = 0; j < discs.size(); ++j)
    if (!claimed[j]) unclaimed.push_back(discs[j]);
  discs = std::move(unclaimed);
  return features;
}

void PictureRun::State::track_unclaimed(imaging::Canvas& canvas,
                                        std::vector<EllipseFeature>& features) {
  constexpr double kHeldSlack = 1.25;  // a disc that is held may go a little beyond the limits
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (features[i].status == FeatureStatus::found) continue;
    targets_[i].tracker->expect_motion(targets_[i].motion.velocity());
    features[i] = within_limits(targets_[i].tracker->track(canvas), kHeldSlack);
  }
}

void PictureRun::State::give_up_doubles(std::vector<EllipseFeature>& features) const {
  // Of equal distances the first target's counts as the shorter.
  const auto nearer = [&](std::size_t i, std::size_t j) {
    const double away_i = (centre_of(features[i].ellipse) - targets_[i].motion.predicted()).norm();
    const double away_j = (centre_of(features[j].ellipse) - targets_[j].motion.predicted()).norm();
    return away_i < away_j || (away_i == away_j && i < j);
  };
  std::vector<bool> double_of_another(features.size(), false);
  for (std::size_t i = 0; i < features.size(); ++i)
    for (std::size_t j = 0; j < features.size(); ++j)
      if (i != j && same_disc(features[i], features[j]) && nearer(j, i))
        double_of_another[i] = true;
  for (std::size_t i = 0; i < features.size(); ++i)
    if (double_of_another[i]) features[i] = lost_ellipse(FeatureStatus::wrong_object);
}

// Whether most of several targets have gone at once and as many others have come.
bool PictureRun::State::is_another_scene(const std::vector<EllipseFeature>& features,
                                         const std::vector<EllipseFeature>& newcomers) const {
  constexpr int kSeveral = 4;
  const auto found = std::count_if(features.begin(), features.end(), [](const auto& feature) {
    return feature.status == FeatureStatus::found;
  });
  return held_ >= kSeveral && 2 * found < held_ &&
         2 * newcomers.size() >= static_cast<std::size_t>(held_);
}

void PictureRun::State::forget_lost(std::vector<EllipseFeature>& features) {
  std::vector<Target> kept;
  std::vector<EllipseFeature> found;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (features[i].status != FeatureStatus::found) continue;
    kept.push_back(std::move(targets_[i]));
    found.push_back(features[i]);
  }
  targets_ = std::move(kept);
  features = std::move(found);
}

// Makes targets of the discs that are nobody's.
void PictureRun::State::adopt(imaging::Canvas& canvas, const std::vector<EllipseFeature>& discs,
                              std::vector<EllipseFeature>& features) {
  for (const EllipseFeature& disc : discs) {
    const bool known = std::any_of(features.begin(), features.end(),
                                   [&](const auto& other) { return same_disc(disc, other); });
    if (known) continue;
    targets_.push_back({++numbers_, make_picture_tracker(params_), disc.ellipse,
                        disc.contrast > 0.0, TargetMotion(centre_of(disc.ellipse))});
    targets_.back().tracker->start(canvas, disc.ellipse);
    features.push_back(disc);
  }
}

std::vector<PictureRow> PictureRun::State::conclude(const std::vector<EllipseFeature>& features) {
  std::vector<PictureRow> rows;
  std::vector<Target> kept;
  held_ = 0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    Target& target = targets_[i];
    rows.push_back({target.number, features[i]});
    if (features[i].status == FeatureStatus::found) {
      target.last = features[i].ellipse;
      target.motion.see(centre_of(target.last));
      ++held_;
    }
    if (target.motion.unseen() <= params_.remember) kept.push_back(std::move(target));
  }
  targets_ = std::move(kept);
  return rows;
}

PictureRun::PictureRun(const PictureRunParams& params) : state_(std::make_unique<State>(params)) {}
PictureRun::~PictureRun() = default;
PictureRun::PictureRun(PictureRun&&) noexcept = default;

std::vector<PictureRow> PictureRun::next(const imaging::Frame& picture) {
  return state_->next(picture);
}

std::string ellipse_csv_header() {
  return "status,u,v,a,b,psi_deg,sigma_u,sigma_v,sigma_a,sigma_b,sigma_psi_deg,score,contrast,"
         "visible,clipped,"
         "r_uv,r_ua,r_ub,r_upsi,r_va,r_vb,r_vpsi,r_ab,r_apsi,r_bpsi";
}

std::string ellipse_csv_fields(const EllipseFeature& feature) {
  constexpr int kNumbers = 24;
  std::string fields(to_string(feature.status));
  if (feature.status != FeatureStatus::found) return fields + std::string(kNumbers, ',');
  const Ellipse& e = feature.ellipse;
  const Eigen::Matrix<double, 5, 1> sigma = feature.covariance.diagonal().cwiseSqrt();
  for (const double value : {e.u, e.v, e.a, e.b}) fields += ',' + csv_number(value, 4);
  fields += ',' + csv_number(to_deg(e.psi), 3);
  for (int i = 0; i < 4; ++i) fields += ',' + csv_number(sigma[i], 4);
  fields += ',' + csv_number(to_deg(sigma[4]), 3);
  fields += ',' + csv_number(feature.score, 3) + ',' + csv_number(feature.contrast, 1);
  fields += ',' + csv_number(feature.visible, 2) + ',' + csv_number(feature.clipped, 2);
  for (int i = 0; i < 5; ++i)
    for (int j = i + 1; j < 5; ++j)
      fields += ',' + csv_number(feature.covariance(i, j) / (sigma[i] * sigma[j]), 4);
  return fields;
}

void draw_overlay(const std::vector<PictureRow>& rows, vpImage<vpRGBa>& picture) {
  LabelPlaces places(static_cast<int>(picture.getWidth()), static_cast<int>(picture.getHeight()));
  for (const PictureRow& row : rows)
    if (row.feature.status == FeatureStatus::found) places.keep_free(box_of(row.feature.ellipse));
  struct Label {
    std::string words;
    cv::Point at;
  };
  constexpr double kScale = 0.4;
  std::vector<Label> labels;
  for (const PictureRow& row : rows) {
    if (row.feature.status != FeatureStatus::found) continue;
    const std::string words = std::to_string(row.target);
    labels.push_back({words, places.place(box_of(row.feature.ellipse), words, kScale)});
  }
  draw_twice(picture, [&](const OverlayPen& pen) {
    for (const PictureRow& row : rows) {
      if (row.feature.status != FeatureStatus::found) continue;
      const Ellipse& e = row.feature.ellipse;
      pen.ellipse(e);
      pen.cross({e.u, e.v}, std::clamp(0.3 * e.b, 2.0, 8.0));
    }
    for (const Label& label : labels) pen.text(label.words, label.at, kScale);
  });
}

}  // namespace vigia::tracking
