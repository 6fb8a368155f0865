#pragma once

#include <cstdint>
#include <vector>

#include "vigia/localization/field_model.hpp"
#include "vigia/localization/field_refine.hpp"

namespace vigia::localization {

struct FieldMatchParams {
  double cell_m = 0.2;          ///< of the positions tried
  double heading_step = 0.052;  ///< of the headings tried, rad
  double beyond_m = 0.5;        ///< how far outside the lines the robot may be
  int candidates = 40;          ///< peaks of the correlation that are refined
  double score_gain = 12.0;     ///< a point's score is log(1 + gain · exp(−d²/2σ²))
  double same_m = 0.25;         ///< refined poses nearer than this are one
  double same_rad = 0.1;
  int hypotheses = 8;  ///< of the answer, at most
};

/// Poses that a single scan suggests, without prior: every position and heading is scored by the
/// correlation of the points with the blurred lines (rows of 16-bit sums, several at a time), the
/// highest peaks are refined on the exact model, goals and posts weigh them. Where half a turn
/// changes no line, only half the headings are tried and each answer gets its twin.
class FieldMatcher {
 public:
  explicit FieldMatcher(const FieldModel& model, const FieldMatchParams& params = {});

  /// A pose that the scan suggests: weight by Laplace evidence with the sightings, of all.
  struct Suggestion {
    FieldFix fix;
    double log_evidence = 0.0;  ///< of points and sightings, the pose's prior density 1
    double weight = 0.0;
  };
  /// The best first; none from fewer than six points.
  std::vector<Suggestion> match(const FieldScan& scan) const;

 private:
  struct Peak {
    Pose2 pose;
    std::uint16_t score;
  };
  /// Per-cell scores of a point whose spread is sigma.
  struct ScoreImage {
    double sigma_m = 0.0;
    std::vector<std::uint16_t> scores;
  };
  const ScoreImage& image_for(const FieldPoint& point) const;
  void correlate(const std::vector<FieldPoint>& points, double theta,
                 std::vector<std::uint16_t>& sums) const;
  void collect_peaks(const std::vector<std::uint16_t>& sums, double theta,
                     std::vector<Peak>& peaks) const;
  std::vector<Peak> best_peaks(const FieldScan& scan) const;

  const FieldModel* model_;
  FieldMatchParams params_;
  int columns_ = 0;  ///< of the positions
  int rows_ = 0;
  int border_ = 0;  ///< cells of the score images round about the positions
  int stride_ = 0;
  std::vector<ScoreImage> images_;
};

/// The suggestions, of two that are half a turn apart the better.
std::vector<FieldMatcher::Suggestion> without_twins(
    const std::vector<FieldMatcher::Suggestion>& suggestions);

}  // namespace vigia::localization
