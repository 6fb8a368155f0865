#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vigia/core/camera.hpp"
#include "vigia/core/random.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/sim/scene.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::tracking::testing {

/// A hall of 10 × 16 m, 2.8 m high, with one landmark (id 1) 2.15 m high in the middle of the wall
/// x = 0, as a camera sees it.
class LandmarkHall {
 public:
  /// @p keys are those of the appearance.
  explicit LandmarkHall(const decltype(Landmark::shape)& shape, const std::string& keys = "");

  const WorldMap& world() const { return world_; }
  const Landmark& landmark() const { return world_.landmarks.all().front(); }
  const sim::Scene& scene() const { return *scene_; }

  vpImage<vpRGBa> picture(const Eigen::Isometry3d& wMc, const Intrinsics& intrinsics,
                          const sim::ImagingParams& params, std::int64_t stamp = 0) const;

 private:
  WorldMap world_;
  std::unique_ptr<sim::Scene> scene_;
};

/// A camera at @p distance from the landmark, whose line of sight makes @p angle with the
/// landmark's normal to the side @p turn (0: to the viewer's right, π/2: up), looking at it with
/// @p roll about its axis and the landmark's centre at @p offset px from the image's.
Eigen::Isometry3d look_at(const Landmark& landmark, double distance, double angle, double turn,
                          double roll, const Eigen::Vector2d& offset, const Intrinsics& intrinsics);

/// Adán's setting: 1.25–8 m away, 25–65° from the normal or within 5° of it, at heights of
/// 0.3–2.6 m, with the zoom (720–8640 px for 640 columns: 5.4–64.8 mm of the EVI-D31) filling 50–95
/// % of the image's height.
struct PatternView {
  Eigen::Isometry3d wMc;
  Intrinsics intrinsics;
};
PatternView random_view(const Landmark& landmark, RandomStream& random);

PatternShape pattern_of(const PatternCode& code);
PatternCode random_code(RandomStream& random);
sim::ImagingParams colour_params(double noise = 4.0, double blur = 0.7);

/// Centre of the ellipse that a dot's outline makes: the centroid of its projected outline.
Eigen::Vector2d dot_image(const Landmark& landmark, const PatternDot& dot, const PatternView& view);

/// Covers a spot of an image: a dark, light or coloured patch with noise, as large as @p reach px.
void cover(vpImage<vpRGBa>& image, const Eigen::Vector2d& spot, double reach, double noise,
           RandomStream& random);

/// How a number of views were read.
struct ReadingRates {
  int views = 0;
  int right = 0;
  int wrong = 0;
};

/// Clean views (noise 4, blur 0.7 px), and hard ones: lamps of 3000–9000 K, blur 0.7–3 px, noise 8,
/// up to two dots covered. The tracker knows no map, so that any code that is read counts.
ReadingRates read_clean_views(int views, std::uint64_t seed);
ReadingRates read_hard_views(int views, std::uint64_t seed);

}  // namespace vigia::tracking::testing
