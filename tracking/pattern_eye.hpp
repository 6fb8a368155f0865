#pragma once

#include "code_reader.hpp"
#include "colour_block.hpp"
#include "dot_fit.hpp"
#include "pattern_assembly.hpp"

#include <optional>
#include <vector>

#include "vigia/tracking/pattern_tracker.hpp"

namespace vigia::tracking {

/// A pattern in one frame: the feature, and what the next frame is predicted from.
struct PatternSight {
  PointsFeature feature;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< image of the centre-point
  PatternShape shape;                                ///< with the code, when it was read
  PlaneMap map;                                      ///< of labels, when the code was read
  std::array<DotFit, kPatternDots> dots;             ///< by label, when the code was read
  ChromaticShift chromatic;                          ///< of the channels against green
};

/// Sees patterns in single frames.
class PatternEye {
 public:
  PatternEye(const KnownCodes& known, const PatternTrackerParams& parameters);

  /// Every pattern in a window, read or not.
  std::vector<PatternSight> find(const imaging::Frame& frame, const imaging::Window& window);

  /// The pattern of @p last in the next frame, moved by about @p motion. Nothing when too few dots
  /// are where they should be or one has another colour.
  std::optional<PatternSight> follow(const imaging::Frame& frame, const PatternSight& last,
                                     const Eigen::Vector2d& motion);

  /// Whether several dots, as the last find() saw them, lie at @p points.
  bool dots_near(const std::vector<LabelledPoint>& points) const;

 private:
  using Dots = std::array<DotFit, kPatternDots>;

  void detect(bool halved);
  void add_sights(std::vector<PatternSight>& sights, const imaging::Window& frame);
  PatternSight measure(const PatternCandidate& candidate, const imaging::Window& frame);
  std::optional<PlaneMap> fit_dots(const PatternCandidate& candidate, const imaging::Window& frame,
                                   Dots& dots);
  void hide_misfits(PatternSight& sight) const;
  void hide_odd_ones(PatternSight& sight) const;
  static void move_to_green(PatternSight& sight);
  bool is_whole_pattern(const PatternSight& sight) const;
  void read(PatternSight& sight);
  void turn_to_labels(PatternSight& sight, int first) const;
  void list_points(PatternSight& sight) const;
  PlaneMap predict(const imaging::Frame& frame, const PatternSight& last,
                   const Eigen::Vector2d& motion);
  PatternSight refit(const imaging::Frame& frame, const PatternSight& last,
                     const PlaneMap& predicted);
  bool has_its_colours(const PatternSight& sight) const;
  bool fits(const DotFit& dot, const PlaneMap& map, const Eigen::Vector2d& p_l,
            double radius) const;

  KnownCodes known_;
  PatternTrackerParams parameters_;
  PatternAssembly assembly_;
  BlobFinder finder_;
  DotFitter fitter_;
  ColourBlock block_;
  vpImage<unsigned char> luma_;
  vpImage<unsigned char> halved_;
  std::vector<Blob> blobs_;
};

}  // namespace vigia::tracking
