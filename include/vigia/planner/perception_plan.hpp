#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vigia/planner/fuzzy_supervisors.hpp"
#include "vigia/planner/head_model.hpp"
#include "vigia/planner/path_model.hpp"

namespace vigia::planner {

struct PerceptionParams {
  PathModelParams path;
  double visible_share = 0.5;  ///< seen from this share of an area, a landmark counts as visible
  double usable_share =
      0.8;               ///< seen from this share of a control position's disc, as usable there
  double reject = 0.25;  ///< a landmark of less suitability is rejected
  /// In motion, the best preselected landmark is taken when its value (both supervisors' product)
  /// is at least this share of the best visible one's.
  double min_value = 0.9;
  /// Standing, landmarks along both axes are taken in turn while both axes' σ exceed this.
  double both_uncertain_m = 0.05;
  double zoom_cost_per_s = 0.2;  ///< suitability that a second of the zoom's travel outweighs
  /// The margin that needs no optics move at the area's zoom. Discs by their radius:
  double min_radius_px = 10.0;
  double max_radius_px = 80.0;
  double min_feature_px = 5.0;  ///< points by feature_width(); at most the image takes them
};

/// What the plan knows of a landmark in a control area.
struct LandmarkStudy {
  LandmarkId id = 0;
  double visible_share = 0.0;  ///< of the area's length
  bool kept = false;           ///< usable at every control position
  double suitability = 0.0;    ///< mean over the control positions; 0 where it is not usable
  double nearest_m = 0.0;      ///< over the control positions that see it
  double farthest_m = 0.0;
  double max_view_angle = 0.0;  ///< rad
  /// Zoom group that its distances belong to most; each kind and size of landmark has groups of its
  /// own.
  std::size_t group = 0;
  Eigen::Vector2d sight_w = Eigen::Vector2d::UnitX();  ///< mean direction robot → landmark, unit
};

/// What the plan has for one control area.
struct AreaPlan {
  ControlArea area;
  std::vector<LandmarkStudy> visible;   ///< in the order of the map
  std::optional<std::size_t> group;     ///< zoom group chosen; nothing without a candidate
  double zoom_mm = 0.0;                 ///< of that group
  std::optional<LandmarkId> chosen;     ///< the most suitable of the group
  std::vector<LandmarkId> preselected;  ///< chosen first, then the best along x and along y

  const LandmarkStudy* find(LandmarkId id) const;
};

/// The offline plan (Armingol §2).
struct PerceptionPlan {
  std::vector<double> turn_points;
  std::vector<AreaPlan> areas;

  const AreaPlan* at(double station_m) const;
};

/// Plans which landmarks to use in each control area of a path: those visible are studied at every
/// control position, the unsuitable rejected, the others grouped by distance. The sequence of zoom
/// groups is the one with the fewest changes and, among those, with the greatest suitability less
/// the cost of the zoom's travel, by dynamic programming over the areas: the zoom is the slowest
/// axis. At its group's distance a disc has the wanted size; a pattern or tag is so much smaller
/// that one nearer by the root of distance_ratio fills the image. Preselected are the most suitable
/// landmark of the group, and those most suitable to reduce the uncertainty along x and along y
/// that can be observed without an optics move.
PerceptionPlan plan_perception(const Path& path, const LandmarkMap& landmarks,
                               const Visibility& visibility, const HeadModel& head,
                               FuzzySupervisors& supervisors, const PerceptionParams& params);

}  // namespace vigia::planner
