#include "pattern_assembly.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

constexpr int kMinDots = 7;       // in all, with the centre
constexpr double kMinFill = 0.8;  // of a blob that may be a dot
constexpr double kMaxFill = 1.2;
constexpr double kRadiusTolerance = 0.25;  // perspective and the centre blob's own errors
constexpr double kSizeTolerance = 0.5;
constexpr double kPhaseAgreement = 0.6;  // length of the mean of unit vectors
constexpr double kMaxOffset = 0.5;       // of a blob from its place, in radii of the dot
constexpr int kDrops = 3;                // blobs that may turn out not to fit

/// A blob in the unstretched plane round a centre.
struct Neighbour {
  std::size_t blob = 0;
  bool outer = false;
  double angle = 0.0;
};

bool may_be_dot(const Blob& blob) {
  return !blob.cut && blob.fill > kMinFill && blob.fill < kMaxFill;
}

/// Maps image offsets to metres of the plane, up to a turn: Σ^(−1/2) times the dot's radius.
Eigen::Matrix2d unstretch(const EllipseShape& dot, double radius) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(dot.sigma);
  return radius * eigen.operatorInverseSqrt();
}

std::vector<Neighbour> neighbours_of(const std::vector<Blob>& blobs, std::size_t centre,
                                     const PatternShape& shape) {
  const EllipseShape& middle = blobs[centre].ellipse;
  const double size = size_of(middle) * shape.dot_radius_m / shape.centre_radius_m;
  const double reach = (1.0 + kRadiusTolerance) * shape.outer_radius_m / shape.centre_radius_m *
                       std::sqrt(middle.sigma.trace());
  const Eigen::Matrix2d to_plane = unstretch(middle, shape.centre_radius_m);
  std::vector<Neighbour> neighbours;
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (i == centre || !may_be_dot(blobs[i])) continue;
    const Eigen::Vector2d offset = blobs[i].ellipse.centre - middle.centre;
    if (std::abs(offset.x()) > reach || std::abs(offset.y()) > reach) continue;
    if (std::abs(std::log(size_of(blobs[i].ellipse) / size)) > kSizeTolerance) continue;
    const Eigen::Vector2d q = to_plane * offset;
    const double inner_misfit = std::abs(q.norm() / shape.inner_radius_m - 1.0);
    const double outer_misfit = std::abs(q.norm() / shape.outer_radius_m - 1.0);
    if (std::min(inner_misfit, outer_misfit) > kRadiusTolerance) continue;
    neighbours.push_back({i, outer_misfit < inner_misfit, std::atan2(q.y(), q.x())});
  }
  return neighbours;
}

/// The angle of one of the eight places, or nothing when the angles are no multiples of an eighth.
std::optional<double> phase_of(const std::vector<Neighbour>& neighbours) {
  std::complex<double> sum = 0.0;
  for (const Neighbour& n : neighbours) sum += std::polar(1.0, kDotsPerRing * n.angle);
  if (std::abs(sum) < kPhaseAgreement * static_cast<double>(neighbours.size())) return std::nullopt;
  return std::arg(sum) / kDotsPerRing;
}

/// Places 1–8 (outer) and 9–16 (inner): image angles grow clockwise, as places do.
std::size_t place_of(const Neighbour& neighbour, double phase) {
  const double eighths = wrap_angle(neighbour.angle - phase) * kDotsPerRing / (2.0 * kPi);
  const long turn = std::lround(eighths);
  const auto slot = static_cast<std::size_t>((turn % kDotsPerRing + kDotsPerRing) % kDotsPerRing);
  return 1 + slot + (neighbour.outer ? 0 : kDotsPerRing);
}

struct Assembly {
  PatternCandidate candidate;
  std::array<std::size_t, kPatternDots> blob{};
};

/// Fits the homography and drops what does not fit. False when too little is left.
bool settle(Assembly& assembly) {
  PatternCandidate& candidate = assembly.candidate;
  const DotPlaces places = dot_places(candidate.shape);
  for (int pass = 0; pass <= kDrops; ++pass) {
    std::vector<PlanePoint> points;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (candidate.dots[i]) points.push_back({places[i], candidate.dots[i]->centre});
    candidate.count = static_cast<int>(points.size());
    if (candidate.count < kMinDots || !candidate.dots[0]) return false;
    const auto map = fit_plane_map(points);
    if (!map) return false;
    candidate.map = *map;
    std::size_t worst = 0;
    double worst_offset = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!candidate.dots[i]) continue;
      const Eigen::Matrix2d J = map->jacobian(places[i]);
      const double offset = (J.inverse() * (candidate.dots[i]->centre - (*map)(places[i]))).norm() /
                            dot_radius(candidate.shape, static_cast<int>(i));
      if (offset > worst_offset) {
        worst = i;
        worst_offset = offset;
      }
    }
    if (worst_offset < kMaxOffset) return true;
    candidate.dots[worst].reset();
  }
  return false;
}

std::optional<Assembly> assemble(const std::vector<Blob>& blobs, std::size_t centre,
                                 const PatternShape& shape) {
  const std::vector<Neighbour> neighbours = neighbours_of(blobs, centre, shape);
  if (static_cast<int>(neighbours.size()) + 1 < kMinDots) return std::nullopt;
  const auto phase = phase_of(neighbours);
  if (!phase) return std::nullopt;
  Assembly assembly;
  assembly.candidate.shape = shape;
  assembly.candidate.dots[0] = blobs[centre].ellipse;
  assembly.blob[0] = centre;
  for (const Neighbour& neighbour : neighbours) {
    const std::size_t place = place_of(neighbour, *phase);
    assembly.candidate.dots[place] = blobs[neighbour.blob].ellipse;
    assembly.blob[place] = neighbour.blob;
  }
  if (!settle(assembly)) return std::nullopt;
  return assembly;
}

}  // namespace

DotPlaces dot_places(const PatternShape& shape) {
  DotPlaces places;
  for (const PatternDot& dot : pattern_dots(shape))
    places[static_cast<std::size_t>(dot.label)] = dot.centre_l;
  return places;
}

double dot_radius(const PatternShape& shape, int place) {
  return place == 0 ? shape.centre_radius_m : shape.dot_radius_m;
}

std::vector<PatternCandidate> PatternAssembly::find(const std::vector<Blob>& blobs) const {
  std::vector<Assembly> assemblies;
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (!may_be_dot(blobs[i])) continue;
    for (const PatternShape& shape : geometries_)
      if (auto assembly = assemble(blobs, i, shape)) assemblies.push_back(std::move(*assembly));
  }
  std::stable_sort(assemblies.begin(), assemblies.end(), [](const Assembly& a, const Assembly& b) {
    return a.candidate.count > b.candidate.count;
  });
  std::vector<bool> taken(blobs.size(), false);
  std::vector<PatternCandidate> candidates;
  for (const Assembly& assembly : assemblies) {
    bool clash = false;
    for (std::size_t i = 0; i < kPatternDots; ++i)
      clash = clash || (assembly.candidate.dots[i] && taken[assembly.blob[i]]);
    if (clash) continue;
    for (std::size_t i = 0; i < kPatternDots; ++i)
      if (assembly.candidate.dots[i]) taken[assembly.blob[i]] = true;
    candidates.push_back(assembly.candidate);
  }
  return candidates;
}

}  // namespace vigia::tracking
