#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace vigia::sim {

/// Things on the walls and on the floor that a detector of discs must reject. A file cannot name
/// the disc: only the plate round it makes it no landmark.
enum class ClutterKind { blob, ellipse, ring, square, half_disc, disc };

/// What carries a mark.
enum class ClutterPlace { face, floor, ceiling };

/// One dark mark. size_m is half its greatest width.
struct Clutter {
  ClutterKind kind = ClutterKind::blob;
  Eigen::Vector3d centre_w = Eigen::Vector3d::Zero();
  ClutterPlace place = ClutterPlace::face;
  double normal_yaw = 0.0;  ///< of a face: outward normal in the floor plane, rad
  double size_m = 0.05;
  double turn = 0.0;  ///< about the normal, rad
  double grey = 60.0;
};

/// A straight line painted on the floor or the ceiling, from end to end.
struct Stripe {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< m
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double width_m = 0.05;
  double grey = 235.0;
  bool on_ceiling = false;
};

/// How the sheet round a disc is cut.
enum class PlateShape { square, disc };

/// Looks of the building. Grey levels are before the light's gain.
struct Appearance {
  std::uint64_t seed = 1;        ///< of textures and random clutter: the world's, not the mission's
  double contrast = 1.0;         ///< of every texture; 0 leaves plain surfaces
  double light = 1.0;            ///< gain of the whole picture
  double light_kelvin = 6500.0;  ///< colour of the lamp; the camera is white at 6500 K
  double wall_grey = 150.0;
  double floor_grey = 105.0;
  double ceiling_grey = 190.0;
  double obstacle_grey = 125.0;
  double disc_grey = 60.0;
  double plate_grey = 210.0;
  double plate_factor = 1.6;  ///< half the sheet's width over the disc's radius
  PlateShape plate_shape = PlateShape::square;
  double clutter_per_m2 = 0.25;   ///< marks scattered over walls and floor
  double carpet_grey = 88.0;      ///< of a field's carpet
  double line_grey = 232.0;       ///< of its lines
  int adverts = 0;                ///< boards in bright colours that stand round it
  int spectators = 0;             ///< people in bright clothes who do
  double patch_grey = 55.0;       ///< of a ceiling's patches
  double patches_missing = 0.0;   ///< share of them that have fallen off
  double patches_spurious = 0.0;  ///< share of the cells that have a second one, anywhere in them
  double lamp_pitch_m = 0.0;      ///< between lamps on such a ceiling; 0: none
  double lamp_grey = 252.0;
  double pipe_pitch_m = 0.0;  ///< between pipes along x that hang below it; 0: none
  double pipe_drop_m = 0.1;
  std::vector<Stripe> stripes;
  std::vector<Clutter> clutter;  ///< named in the file and drawn at random
};

}  // namespace vigia::sim
