#pragma once

#include "ellipse_shape.hpp"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <visp3/core/vpImage.h>

#include "vigia/imaging/frame.hpp"

namespace vigia::tracking {

/// A connected dark region and its moments.
struct Blob {
  imaging::Window box;
  double area = 0.0;      ///< px
  EllipseShape ellipse;   ///< the ellipse of the same second moments
  double fill = 0.0;      ///< area over that ellipse's area; 1 for a solid ellipse
  double solidity = 0.0;  ///< area over the area between each row's first and last pixel
  double outline = 0.0;   ///< rms distance of the runs' ends from the ellipse, px
  double disc = 0.0;      ///< grey level inside, near the seed
  double ground = 0.0;    ///< grey level beside it, near the seed
  bool cut = false;       ///< reaches the window's edge
  /// Points of the outline that is seen: of a cut blob, and where all outlines are kept.
  std::vector<Eigen::Vector2d> arc;
};

struct BlobFinderParameters {
  double min_axis_px = 3.0;
  double min_axis_ratio = 0.3;
  double min_contrast = 20.0;  ///< grey levels
  int row_step = 4;            ///< rows between scanned rows, at most twice min_axis_px
  bool keep_outlines = false;  ///< whether blobs that aren't cut have their outline, too
};

/// Finds compact dark blobs on lighter ground: falling and rising edges along every few rows give
/// chords; a chord whose crossing chord is of a like length seeds a flood fill at the level half
/// way between the chord's inside and outside. So the threshold is local, and clutter costs only
/// its edges. After WhyCon (Krajník et al., J. Intell. Robot. Syst. 76, 2014), which floods from a
/// global threshold.
class BlobFinder {
 public:
  explicit BlobFinder(const BlobFinderParameters& parameters = {}) : parameters_(parameters) {}

  /// Reads only pixels inside @p window, which lies inside the image.
  const std::vector<Blob>& find(const vpImage<unsigned char>& image, const imaging::Window& window);

  void set_min_axis_ratio(double ratio) { parameters_.min_axis_ratio = ratio; }

 private:
  struct Chord {
    int v;
    int first;
    int last;
  };
  struct Run {
    int v;
    int first;
    int last;
  };
  struct Seed {
    int u = 0;
    int v = 0;
    int threshold = 0;
    double disc = 0.0;
    double ground = 0.0;
    imaging::Window limit;  ///< the fill is no ellipse when it goes beyond
  };

  /// An upright chord: its column, its middle row and its length.
  struct Column {
    int u;
    int v;
    int height;
  };

  unsigned char at(int u, int v) const { return (*image_)[static_cast<unsigned>(v)][u]; }
  void scan_row(int v);
  void consider(const Chord& chord);
  std::optional<Seed> seed_of(const Chord& chord) const;
  std::optional<Seed> seed_levels(const Chord& chord) const;
  bool already_filled(const Seed& seed) const;
  int reach(int u, int v, int du, int dv, int threshold, int limit) const;
  bool chords_like_ellipse(const Column& column, int width, int threshold) const;
  void fill(const Seed& seed);
  bool flood(const Seed& seed);
  std::optional<Blob> describe(const Seed& seed) const;
  double solidity_of(const Blob& blob) const;
  bool add_run(int u, int v, const Seed& seed, const Run& from);
  bool add_touching(int first, int last, int v, const Seed& seed, const Run& from);
  std::vector<Eigen::Vector2d> visible_arc() const;
  double outline_distance(const EllipseShape& ellipse) const;

  BlobFinderParameters parameters_;
  const vpImage<unsigned char>* image_ = nullptr;
  imaging::Window window_;
  std::vector<Blob> blobs_;
  std::vector<unsigned char> falling_, rising_;

  // The number of the fill that took a pixel, and the threshold of each fill of this call.
  std::vector<std::uint32_t> taken_;
  std::uint32_t first_fill_ = 1;
  std::uint32_t fills_ = 0;
  std::vector<int> thresholds_;
  std::vector<std::pair<Run, Run>> open_;  ///< with the run that led to it
  std::vector<Run> runs_;
};

}  // namespace vigia::tracking
