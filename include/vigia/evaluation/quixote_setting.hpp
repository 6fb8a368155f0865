#pragma once

#include <vector>

#include "vigia/core/random.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/evaluation/pattern_views.hpp"

namespace vigia::evaluation {

/// The setting of Adán §4: an EVI-D31 (768×576 pixels of 6.25 µm) at f = 25 mm in a room of 50 m²
/// with six patterns 2.15 m high. What the paper does not print is fixed here: the room's sides,
/// the patterns' places, the camera's height.
struct QuixoteSetting {
  Intrinsics camera{768, 576, 4000.0, 4000.0, 383.5, 287.5, 0.0};
  Eigen::Vector2d room_m{8.4, 6.0};
  double pattern_height_m = 2.15;
  double camera_height_m = 1.1;
  double wall_distance_m = 0.4;  ///< that the camera keeps
  double min_distance_m = 1.25;
  double max_distance_m = 8.0;
  double min_phi = 0.4363323129985824;  ///< 25°
  double centring_sigma_px = 0.5;       ///< of the servo, per axis
};

LandmarkMap quixote_patterns(const QuixoteSetting& setting);
FloorPlan quixote_room(const QuixoteSetting& setting);

/// A camera at @p p_w that looks at a pattern with its x axis level, the pattern's centre
/// @p off_px from the principal point. Dots cut by the border are not seen; each point has white
/// noise of @p sigma_px.
PatternView quixote_view(const QuixoteSetting& setting, const Landmark& pattern,
                         const Eigen::Vector3d& p_w, const Eigen::Vector2d& off_px, double sigma_px,
                         RandomStream& random);

/// Views from places drawn uniformly in the room of patterns drawn uniformly, of those that the
/// three criteria let pass.
std::vector<PatternView> random_views(const QuixoteSetting& setting, double sigma_px, int count,
                                      RandomStream& random);

/// The guided route: 30 places on a closed tour of the room, at each the nearest pattern that the
/// criteria let pass.
std::vector<PatternView> route_views(const QuixoteSetting& setting, double sigma_px,
                                     RandomStream& random);

}  // namespace vigia::evaluation
