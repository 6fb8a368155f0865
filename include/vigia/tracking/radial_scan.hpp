#pragma once

#include <array>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/field_map.hpp"
#include "vigia/imaging/frame.hpp"
#include "vigia/tracking/field_palette.hpp"

namespace vigia::tracking {

/// Where a picture shows a mirror: the middle from which rays go, and the radii between which it
/// shows the field.
struct MirrorImage {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double inner_px = 0.0;  ///< within it the robot sees itself
  double outer_px = 0.0;  ///< the mirror's edge; 0: rays go to the picture's border
};

/// A calibrated mirror above a floor: what tells how wide a line of the field is in the image.
struct FloorView {
  UnifiedOmni mirror;
  Eigen::Isometry3d rMc = Eigen::Isometry3d::Identity();  ///< its frame in the robot's; floor z = 0
  double inner_px = 0.0;                                  ///< within it the robot sees itself
};

/// The point of the floor that a pixel shows, in the robot's frame, or nothing: beyond the mirror's
/// edge or above the horizon.
std::optional<Eigen::Vector2d> floor_point(const FloorView& view, const Eigen::Vector2d& uv);

struct RadialScanParams {
  double ray_step = from_deg(3.0);  ///< rad in the image, from one ray to the next
  int min_run_px = 4;               ///< pixels on a ray that a goal or a post takes at least
  int min_green_px = 2;             ///< of green on both sides of a line
  double min_contrast = 0.12;     ///< of a line on green; 1: from the palette's green to its white
  double min_significance = 5.0;  ///< the same in standard deviations of a pixel's noise
  double min_whiteness = 0.85;    ///< cosine between a line's excess over green and white's
  double max_line_px = 40.0;      ///< widest line along a ray
  double blur_px = 0.8;           ///< σ of the camera's blur, where the fit begins
  double line_width_m = 0.125;    ///< of the field's lines; counts where the floor is known
  double max_misfit = 4.0;        ///< χ² per degree of freedom of a line's profile, at most
};

/// A ray's crossing of a painted line. inner and outer are where the ray crosses the line's two
/// edges; who knows the floor maps both and takes the middle. The error lies along the ray: across
/// it there is none.
struct LinePoint {
  int ray = 0;
  double inner_px = 0.0;  ///< from the mirror's middle
  double outer_px = 0.0;
  double sigma_px = 0.1;  ///< of the middle of the two, along the ray
  double contrast = 0.0;  ///< of the line on green; 1: from the palette's green to its white
  double centre_px() const { return 0.5 * (inner_px + outer_px); }
};

/// The nearest point of a coloured run on a ray: where a goal or a post begins.
struct ColourFoot {
  int ray = 0;
  double foot_px = 0.0;   ///< from the mirror's middle
  double sigma_px = 0.5;  ///< along the ray
};

/// Neighbouring rays that meet one coloured thing: a goal or a corner post.
struct ColourSpan {
  FieldColour colour = FieldColour::yellow;  ///< of the goal; of the post's lowest band
  std::vector<ColourFoot> feet;              ///< in the order of the rays; round the last to ray 0
  double first_angle = 0.0;                  ///< rad in the image, of its rims: from
  double last_angle = 0.0;                   ///< to, at least first_angle
  double angle_sigma = 0.01;                 ///< of either rim
};

/// Whether the colours are those of the palette.
enum class LightStatus {
  in_range,
  too_dark,    ///< much of what is scanned is black
  no_green,    ///< hardly anything is green
  off_colour,  ///< green lies at the rim of its range
};
std::string_view to_string(LightStatus status);

/// Bright runs that are no lines, and why.
enum class RunFault { no_green, wrong_width, wrong_colour, misfit };
constexpr std::size_t kRunFaults = 4;

/// What one picture shows along the rays.
struct RadialScan {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< from which the rays go
  int rays = 0;
  std::vector<LinePoint> points;  ///< in the order of the rays, along each outwards
  std::vector<ColourSpan> goals;
  std::vector<ColourSpan> posts;
  double noise = 0.0;    ///< σ of a pixel, in contrasts of the palette's white on its green
  double blur_px = 0.0;  ///< median σ of the lines' edges
  std::array<int, kRunFaults> refused{};
  std::array<double, kFieldClasses> shares{};  ///< of each class among the pixels of the rays
  Eigen::Vector3d green_mean = Eigen::Vector3d::Zero();  ///< R G B levels
  LightStatus light = LightStatus::in_range;

  /// Angle of a ray in the image, rad from u towards v.
  double angle(int ray) const { return 2.0 * kPi * ray / rays; }
  /// The pixel at that distance from the middle on a ray.
  Eigen::Vector2d pixel(int ray, double radius_px) const;
};

/// Scans pictures of a mirror camera along rays from the mirror's middle, after Minho §III A and B:
/// classes of colour, runs, lines, goals, and corner posts, which are yellow and blue on one ray. A
/// line is a bright run with green on both sides whose excess over green has the colour of white
/// and, where the floor is known, the width of a line. Its edges are fitted to sub-pixel as those
/// of a blurred stripe, with the variance that follows from the picture's noise. Only the pixels of
/// the rays are read: at each whole step along a ray's major axis the two next to it, so that
/// samples share no pixel and have independent noise.
class RadialScanner {
 public:
  RadialScanner(const MirrorImage& mirror, const FieldPalette& palette,
                const RadialScanParams& params = {});
  RadialScanner(const FloorView& view, const FieldPalette& palette,
                const RadialScanParams& params = {});
  ~RadialScanner();
  RadialScanner(RadialScanner&&) noexcept;

  RadialScan scan(const imaging::Frame& frame);

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace vigia::tracking
