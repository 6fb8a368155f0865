#include "pattern_eye.hpp"

#include "bare_dots.hpp"
#include "pixel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace vigia::tracking {
namespace {

using imaging::Frame;
using imaging::Window;

constexpr double kSmallDot = 2.0;   // px, least semi-minor axis of a blob
constexpr double kFlattest = 0.25;  // b/a of a dot
constexpr int kRowStep = 3;         // rows from one that the blob finder scans to the next
constexpr double kMaxGrowth = 0.3;  // of log size, of a dot against its prediction
// The unit by which dots are compared with each other, px: blur and a camera's response move all
// rims about alike.
constexpr double kUnitFloor = 0.1;
constexpr double kUnitByBlur = 0.15;  // of the blur
constexpr double kUnitBySize = 0.02;  // of the dot's size
constexpr double kUnitBySigma = 4.0;  // of the stated error of its centre, an axis
// How far a dot's rim may lie out or in against the median of all, units. The centre-point is
// larger and has no twin: blur draws it in, and only a sticker makes it larger or moves it.
constexpr double kMaxGrowthUnits = 1.0;
constexpr double kMaxCentreOut = 0.3;
constexpr double kMaxCentreIn = 1.3;
constexpr double kMaxCentreOff = 0.6;
constexpr double kMaxCentreOddness = 1.2;
constexpr double kMaxLoneOddness = 1.0;  // of a dot whose twin isn't seen
constexpr double kMaxStretch = 1.4;      // of a dot along one axis against the other
// By how much the channels may move against each other from frame to frame (px): at rest, by focus
// and temperature, and with each pixel that the pattern moves over the image.
constexpr double kShiftDrift = 0.002;
constexpr double kShiftSlope = 0.001;
constexpr int kMaxMissing = 4;          // dots in sight of the camera that are not seen
constexpr double kSheetRim = 1.5;       // radii of a dot beyond the outer ring, all white
constexpr double kCentreMargin = 12.0;  // px by which the centre-point may jump between frames
constexpr int kEnoughNear = 4;          // dots that betray a hidden pattern

bool same_geometry(const PatternShape& a, const PatternShape& b) {
  return a.outer_radius_m == b.outer_radius_m && a.inner_radius_m == b.inner_radius_m &&
         a.dot_radius_m == b.dot_radius_m && a.centre_radius_m == b.centre_radius_m;
}

std::vector<PatternShape> geometries_of(const KnownCodes& known) {
  std::vector<PatternShape> geometries;
  if (known.any) geometries.emplace_back();
  for (const Landmark& landmark : known.map.all()) {
    const auto* pattern = std::get_if<PatternShape>(&landmark.shape);
    if (pattern == nullptr) continue;
    const bool seen = std::any_of(geometries.begin(), geometries.end(), [&](const auto& other) {
      return same_geometry(other, *pattern);
    });
    if (!seen) geometries.push_back(*pattern);
  }
  return geometries;
}

BlobFinderParameters finder_parameters(double min_contrast) {
  BlobFinderParameters parameters;
  parameters.min_axis_px = kSmallDot;
  parameters.min_axis_ratio = kFlattest;
  parameters.min_contrast = min_contrast;
  parameters.row_step = kRowStep;
  return parameters;
}

bool cut_by(const Window& frame, const EllipseShape& shape) {
  return !contains(frame, window_round(shape, 1.0));
}

/// The window grown so that it begins on the full frame's grid of halved pixels and scanned rows:
/// in a window the same is found as in the full frame.
Window on_grid(const Window& window, const Window& frame) {
  constexpr int kGrid = 2 * kRowStep;
  const int u = window.u / kGrid * kGrid;
  const int v = window.v / kGrid * kGrid;
  return intersect({u, v, window.right() + 1 - u, window.bottom() + 1 - v}, frame);
}

/// Whether a dot's growth against the median and its offset from the plane, in units, are those of
/// a bare dot.
bool is_bare(double growth, double offset, bool centre) {
  if (!centre) return std::abs(growth) < kMaxGrowthUnits;
  return growth < kMaxCentreOut && growth > -kMaxCentreIn && offset < kMaxCentreOff;
}

/// The other ring's dot of the same place.
std::size_t twin_of(std::size_t place) {
  return place <= kDotsPerRing ? place + kDotsPerRing : place - kDotsPerRing;
}

std::vector<DotPulls> pulls_of(const PatternSight& sight) {
  std::vector<DotPulls> pulls;
  for (const DotFit& dot : sight.dots)
    if (dot.status == DotStatus::whole) pulls.push_back(dot.pulls);
  return pulls;
}

/// Why dots that are missed are not seen.
FeatureStatus status_of(const std::array<DotFit, kPatternDots>& dots) {
  const auto count = [&](DotStatus status) {
    return std::count_if(dots.begin(), dots.end(),
                         [&](const DotFit& dot) { return dot.status == status; });
  };
  if (count(DotStatus::cut) > 0) return FeatureStatus::cut_by_border;
  return 2 * count(DotStatus::faint) > kPatternDots ? FeatureStatus::low_contrast
                                                    : FeatureStatus::occluded;
}

/// The landmark of the map that shows a code with this geometry.
const Landmark* find_code(const LandmarkMap& map, const PatternShape& shape) {
  for (const Landmark& landmark : map.all()) {
    const auto* pattern = std::get_if<PatternShape>(&landmark.shape);
    if (pattern != nullptr && pattern->code == shape.code && same_geometry(*pattern, shape))
      return &landmark;
  }
  return nullptr;
}

}  // namespace

PatternEye::PatternEye(const KnownCodes& known, const PatternTrackerParams& parameters)
    : known_(known),
      parameters_(parameters),
      assembly_(geometries_of(known)),
      finder_(finder_parameters(parameters.min_contrast)),
      fitter_(parameters.min_agreement) {}

// Blobs of the block's luma or of its halved one, in coordinates of the frame.
void PatternEye::detect(bool halved) {
  vpImage<unsigned char>& image = halved ? halved_ : luma_;
  if (halved) halve(luma_, halved_);
  const Window whole{0, 0, static_cast<int>(image.getWidth()), static_cast<int>(image.getHeight())};
  blobs_ = finder_.find(image, whole);
  const double scale = halved ? 2.0 : 1.0;
  const Eigen::Vector2d origin(block_.window().u, block_.window().v);
  for (Blob& blob : blobs_) {
    blob.ellipse.centre =
        scale * blob.ellipse.centre + origin + Eigen::Vector2d::Constant(0.5 * (scale - 1.0));
    blob.ellipse.sigma *= scale * scale;
  }
}

std::vector<PatternSight> PatternEye::find(const Frame& frame, const Window& window) {
  std::vector<PatternSight> sights;
  if (std::min(window.width, window.height) < 16) return sights;
  block_.read(frame, on_grid(window, frame.full()));
  block_.luma(luma_);
  // The halved picture shows large dots through the noise; small ones need all pixels.
  for (const bool halved : {true, false}) {
    detect(halved);
    add_sights(sights, frame.full());
  }
  return sights;
}

// Measures what the blobs show; where a pattern has been seen before, the one that is read counts.
void PatternEye::add_sights(std::vector<PatternSight>& sights, const Window& frame) {
  for (const PatternCandidate& candidate : assembly_.find(blobs_)) {
    const Eigen::Vector2d centre = candidate.dots[0]->centre;
    const auto known = std::find_if(sights.begin(), sights.end(), [&](const PatternSight& sight) {
      return (sight.centre - centre).norm() <
             size_of(sight.map.circle(Eigen::Vector2d::Zero(), sight.shape.outer_radius_m));
    });
    if (known == sights.end()) {
      sights.push_back(measure(candidate, frame));
    } else if (!known->feature.code) {
      PatternSight again = measure(candidate, frame);
      if (again.feature.code) *known = std::move(again);
    }
  }
}

// Whether a fitted dot is where and as large as the plane has it.
bool PatternEye::fits(const DotFit& dot, const PlaneMap& map, const Eigen::Vector2d& p_l,
                      double radius) const {
  const Eigen::Matrix2d to_plane = map.jacobian(p_l).inverse();
  const Eigen::Vector2d off = to_plane * (dot.shape.centre - map(p_l));
  if (off.norm() > parameters_.max_offset_ratio * radius) return false;
  // The dot, which is round in the plane unless motion has drawn it out.
  const Eigen::Matrix2d round = to_plane * dot.shape.sigma * to_plane.transpose();
  const Eigen::Vector2d squares = round.selfadjointView<Eigen::Lower>().eigenvalues();
  const double growth = 0.25 * std::log(squares.prod()) - std::log(radius);
  return std::abs(growth) < kMaxGrowth &&
         squares.maxCoeff() < kMaxStretch * kMaxStretch * squares.minCoeff();
}

std::optional<PlaneMap> PatternEye::fit_dots(const PatternCandidate& candidate, const Window& frame,
                                             Dots& dots) {
  const DotPlaces places = dot_places(candidate.shape);
  std::vector<PlanePoint> points;
  double blur = kStartBlur;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!candidate.dots[i]) continue;
    dots[i] = fitter_.fit(block_, *candidate.dots[i], blur);
    if (dots[i].status != DotStatus::whole) continue;
    blur = dots[i].blur;
    points.push_back({places[i], dots[i].shape.centre});
  }
  auto map = fit_plane_map(points);
  if (!map) return std::nullopt;
  // Where the blob finder saw nothing, the plane says where to look.
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (dots[i].status == DotStatus::whole) continue;
    const EllipseShape start =
        map->circle(places[i], dot_radius(candidate.shape, static_cast<int>(i)));
    if (cut_by(frame, start))
      dots[i].status = DotStatus::cut;
    else
      dots[i] = fitter_.fit(block_, start, blur);
  }
  return map;
}

PatternSight PatternEye::measure(const PatternCandidate& candidate, const Window& frame) {
  PatternSight sight;
  sight.shape = candidate.shape;
  sight.map = candidate.map;
  sight.centre = candidate.dots[0]->centre;
  const auto map = fit_dots(candidate, frame, sight.dots);
  sight.feature.status = status_of(sight.dots);
  if (!map) return sight;
  sight.map = *map;
  hide_misfits(sight);
  sight.chromatic = shrunk(estimate_shift(pulls_of(sight), {}));
  hide_odd_ones(sight);
  move_to_green(sight);
  if (is_whole_pattern(sight)) read(sight);
  return sight;
}

void PatternEye::hide_misfits(PatternSight& sight) const {
  const DotPlaces places = dot_places(sight.shape);
  std::array<double, kPatternDots> growths{};
  std::vector<double> whole;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const DotFit& dot = sight.dots[i];
    if (dot.status != DotStatus::whole) continue;
    growths[i] = growth_of(
        dot.shape, sight.map.circle(places[i], dot_radius(sight.shape, static_cast<int>(i))));
    whole.push_back(growths[i]);
  }
  if (whole.empty()) return;
  const auto middle = whole.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2);
  std::nth_element(whole.begin(), middle, whole.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    DotFit& dot = sight.dots[i];
    if (dot.status != DotStatus::whole) continue;
    const double unit = kUnitFloor + kUnitByBlur * dot.blur + kUnitBySize * size_of(dot.shape) +
                        kUnitBySigma * std::sqrt(0.5 * dot.centre_covariance.trace());
    const double offset = (dot.shape.centre - sight.map(places[i])).norm();
    if (!is_bare((growths[i] - *middle) / unit, offset / unit, i == 0) ||
        !fits(dot, sight.map, places[i], dot_radius(sight.shape, static_cast<int>(i))))
      dot.status = DotStatus::hidden;
  }
}

// Dots that nothing else bears out must look like the others.
void PatternEye::hide_odd_ones(PatternSight& sight) const {
  const DotPlaces places = dot_places(sight.shape);
  std::array<EllipseShape, kPatternDots> expected;
  for (std::size_t i = 0; i < places.size(); ++i)
    expected[i] = sight.map.circle(places[i], dot_radius(sight.shape, static_cast<int>(i)));
  const auto oddness = oddness_of(sight.dots, expected, sight.chromatic);
  const Dots before = sight.dots;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool lone = i > 0 && before[twin_of(i)].status != DotStatus::whole;
    if ((i == 0 && oddness[i] > kMaxCentreOddness) || (lone && oddness[i] > kMaxLoneOddness))
      sight.dots[i].status = DotStatus::hidden;
  }
}

// The centres where green has them: the lens may move the channels against each other.
void PatternEye::move_to_green(PatternSight& sight) {
  for (DotFit& dot : sight.dots) {
    dot.shape.centre -= sight.chromatic.of_centre(dot.pulls.share);
    dot.centre_covariance += sight.chromatic.covariance_of(dot.pulls.share);
  }
}

// Whether what is in sight shows both rings, and nothing like a dot where the sheet is white.
bool PatternEye::is_whole_pattern(const PatternSight& sight) const {
  int missing = 0;
  for (const DotFit& dot : sight.dots)
    missing += dot.status == DotStatus::hidden || dot.status == DotStatus::faint ? 1 : 0;
  if (missing > kMaxMissing) return false;
  const PatternShape& shape = sight.shape;
  const DotPlaces places = dot_places(shape);
  return std::none_of(blobs_.begin(), blobs_.end(), [&](const Blob& blob) {
    const Eigen::Vector2d p = sight.map.inverse(blob.ellipse.centre);
    const double size = size_of(blob.ellipse) / size_of(sight.map.circle(p, shape.dot_radius_m));
    if (blob.cut || p.norm() > shape.outer_radius_m + kSheetRim * shape.dot_radius_m ||
        size < 0.5 || size > 2.5)
      return false;
    return std::none_of(places.begin(), places.end(), [&](const Eigen::Vector2d& place) {
      return (p - place).norm() < shape.centre_radius_m;
    });
  });
}

// The code, and by it labels, landmark and status.
void PatternEye::read(PatternSight& sight) {
  DotLevels levels;
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (sight.dots[i].status == DotStatus::whole) levels[i] = sight.dots[i].levels;
  const CodeReading reading = read_code(levels, parameters_.min_confidence);
  PointsFeature& feature = sight.feature;
  feature.confidence = reading.confidence;
  if (reading.status != ReadStatus::read) {
    if (reading.status == ReadStatus::doubtful) feature.status = FeatureStatus::unreadable;
    return;
  }
  sight.shape.code = reading.code;
  turn_to_labels(sight, reading.first);
  list_points(sight);
  feature.code = reading.code;
  const Landmark* landmark = find_code(known_.map, sight.shape);
  if (landmark != nullptr) feature.landmark = landmark->id;
  feature.status =
      landmark != nullptr || known_.any ? FeatureStatus::found : FeatureStatus::unknown_code;
}

// Turns places to labels: the black point becomes the first.
void PatternEye::turn_to_labels(PatternSight& sight, int first) const {
  const std::array<DotFit, kPatternDots> places = sight.dots;
  for (std::size_t ring = 1; ring < kPatternDots; ring += kDotsPerRing)
    for (std::size_t i = 0; i < kDotsPerRing; ++i)
      sight.dots[ring + i] = places[ring + (i + static_cast<std::size_t>(first)) % kDotsPerRing];
  const DotPlaces labels = dot_places(sight.shape);
  std::vector<PlanePoint> points;
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (sight.dots[i].status == DotStatus::whole)
      points.push_back({labels[i], sight.dots[i].shape.centre});
  if (const auto map = fit_plane_map(points)) sight.map = *map;
  sight.centre = sight.map(Eigen::Vector2d::Zero());
}

void PatternEye::list_points(PatternSight& sight) const {
  sight.feature.points.clear();
  for (int label = 0; label < kPatternDots; ++label) {
    const DotFit& dot = sight.dots[static_cast<std::size_t>(label)];
    if (dot.status == DotStatus::whole)
      sight.feature.points.push_back({label, dot.shape.centre, dot.centre_covariance});
  }
}

// The last plane, moved and scaled as the centre-point shows.
PlaneMap PatternEye::predict(const Frame& frame, const PatternSight& last,
                             const Eigen::Vector2d& motion) {
  PlaneMap map = last.map;
  Eigen::Matrix3d step = Eigen::Matrix3d::Identity();
  step.topRightCorner<2, 1>() = motion;
  map.iHl = step * map.iHl;
  const EllipseShape expected = map.circle(Eigen::Vector2d::Zero(), last.shape.centre_radius_m);
  const Window window = intersect(window_round(expected, kCentreMargin), frame.full());
  if (window.width < 8 || window.height < 8) return map;
  block_.read(frame, window);
  block_.luma(luma_);
  detect(false);
  const Blob* best = nullptr;
  double least = kCentreMargin;
  for (const Blob& blob : blobs_) {
    const double off = (blob.ellipse.centre - expected.centre).norm();
    if (blob.cut || off > least ||
        std::abs(std::log(size_of(blob.ellipse) / size_of(expected))) > kMaxGrowth)
      continue;
    best = &blob;
    least = off;
  }
  if (best == nullptr) return map;
  step.topRightCorner<2, 1>() = best->ellipse.centre - expected.centre;
  map.iHl = step * map.iHl;
  return map;
}

std::optional<PatternSight> PatternEye::follow(const Frame& frame, const PatternSight& last,
                                               const Eigen::Vector2d& motion) {
  PatternSight sight = refit(frame, last, predict(frame, last, motion));
  const DotPlaces places = dot_places(sight.shape);
  std::vector<PlanePoint> points;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (sight.dots[i].status == DotStatus::whole)
      points.push_back({places[i], sight.dots[i].shape.centre});
  if (static_cast<int>(points.size()) < parameters_.min_dots) return std::nullopt;
  const auto map = fit_plane_map(points);
  if (!map) return std::nullopt;
  sight.map = *map;
  sight.centre = (*map)(Eigen::Vector2d::Zero());
  hide_misfits(sight);
  const double drift = kShiftDrift + kShiftSlope * (sight.centre - last.centre).norm();
  sight.chromatic.covariance.diagonal().array() += drift * drift;
  sight.chromatic = estimate_shift(pulls_of(sight), sight.chromatic);
  move_to_green(sight);
  if (!has_its_colours(sight)) return std::nullopt;
  list_points(sight);
  if (static_cast<int>(sight.feature.points.size()) < parameters_.min_dots) return std::nullopt;
  return sight;
}

// Each dot fitted where the plane has it, from the levels that it had before.
PatternSight PatternEye::refit(const Frame& frame, const PatternSight& last,
                               const PlaneMap& predicted) {
  PatternSight sight = last;
  const DotPlaces places = dot_places(last.shape);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const EllipseShape start =
        predicted.circle(places[i], dot_radius(last.shape, static_cast<int>(i)));
    DotFit& dot = sight.dots[i];
    dot.status = DotStatus::cut;
    if (cut_by(frame.full(), start)) continue;
    const DotFit& before = last.dots[i];
    block_.read(frame, intersect(dot_box(start, before.blur), frame.full()));
    dot = before.status == DotStatus::whole ? fitter_.fit(block_, start, before.blur, before.levels)
                                            : fitter_.fit(block_, start, before.blur);
  }
  return sight;
}

// Whether each dot that is seen still has the colour that its code gives it.
bool PatternEye::has_its_colours(const PatternSight& sight) const {
  const std::vector<PatternDot> pattern = pattern_dots(sight.shape);
  const std::size_t black = sight.dots[1].status == DotStatus::whole ? 1 : 1 + kDotsPerRing;
  if (sight.dots[black].status != DotStatus::whole) return false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const DotFit& dot = sight.dots[i];
    if (dot.status == DotStatus::whole &&
        !looks_like(dot.levels, sight.dots[black].levels, pattern[i].colour))
      return false;
  }
  return true;
}

bool PatternEye::dots_near(const std::vector<LabelledPoint>& points) const {
  constexpr double kNear = 6.0;  // px
  const auto near = std::count_if(points.begin(), points.end(), [&](const LabelledPoint& point) {
    return std::any_of(blobs_.begin(), blobs_.end(), [&](const Blob& blob) {
      return (blob.ellipse.centre - point.uv).norm() < kNear + 0.3 * size_of(blob.ellipse);
    });
  });
  return near >= kEnoughNear;
}

}  // namespace vigia::tracking
