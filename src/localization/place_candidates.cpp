#include "vigia/localization/place_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "vigia/core/overloaded.hpp"
#include "vigia/localization/disc_measurement.hpp"
#include "vigia/localization/points_pose.hpp"
#include "vigia/localization/spatial_pose.hpp"

namespace vigia::localization {
namespace {

/// How far off a place from an apparent size may be: so much, and a share of the range. Sizes off
/// the optical axis overstate the range by up to a tenth.
constexpr double kPlaceTolerance_m = 0.1;
constexpr double kPlaceToleranceShare = 0.12;
/// The same of a height above the floor: by the range, and by the tilt of head and floor.
constexpr double kHeightToleranceShare = 0.15;
constexpr double kTiltTolerance = 0.05;
/// Of a disc's axes' ratio beside the cosine of its slant, which is rough off the optical axis and
/// from a rough place.
constexpr double kAspectTolerance = 0.25;
/// Pairs are made of so many discs, the largest in the image, whose ranges are the best.
constexpr std::size_t kPairedDiscs = 10;
/// Two sightings in about the same direction tell no heading; as a rule they are one landmark.
const double kMinApart = from_deg(2.0);
/// No two landmarks farther apart are seen from one place.
constexpr float kMaxPair_m = 25.0F;
constexpr double kGridCell_m = 1.0;
/// Candidates of one cell are one.
constexpr double kPoseCell_m = 0.25;
const double kPoseCellAngle = from_deg(6.0);

double bearing_of(const Eigen::Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

/// Where a disc of the given radius stands in the base frame, its range from the longer axis.
Eigen::Vector3d disc_place(const EllipseObservation& seen, double radius,
                           const RigOnGround& on_ground) {
  const Intrinsics& intrinsics = pinhole(seen.shot);
  const Eigen::Vector2d xy = unproject(intrinsics, {seen.ellipse.u, seen.ellipse.v});
  const double depth = radius * std::sqrt(intrinsics.px * intrinsics.py) / seen.ellipse.a;
  return on_ground.rig.at(seen.shot.camera).rMc(seen.shot.head) *
         Eigen::Vector3d(depth * xy.homogeneous());
}

/// The planar pose that takes q_a, q_b (base frame) to p_a, p_b (plan): direction from the
/// difference, position from the means.
Pose2 align(const Eigen::Vector2d& q_a, const Eigen::Vector2d& q_b, const Eigen::Vector2d& p_a,
            const Eigen::Vector2d& p_b) {
  const double theta = wrap_angle(bearing_of(p_b - p_a) - bearing_of(q_b - q_a));
  const Eigen::Vector2d mid_q = 0.5 * (q_a + q_b);
  const Eigen::Vector2d mid_p = 0.5 * (p_a + p_b);
  return {mid_p.x() - std::cos(theta) * mid_q.x() + std::sin(theta) * mid_q.y(),
          mid_p.y() - std::sin(theta) * mid_q.x() - std::cos(theta) * mid_q.y(), theta};
}

/// The pose on the floor from which the landmark is seen so, whatever leans.
Pose2 on_floor(const Landmark& landmark, const FittedPose& fit, const Shot& shot,
               const RigOnGround& on_ground) {
  const Eigen::Isometry3d rMl = on_ground.rig.at(shot.camera).rMc(shot.head) * fit.cMl;
  const Eigen::Isometry3d gMr = on_ground.ground.place({}).inverse() * landmark.wMl * rMl.inverse();
  return {gMr.translation().x(), gMr.translation().y(),
          std::atan2(gMr.linear()(1, 0), gMr.linear()(0, 0))};
}

const Clue::Option* option_of(const Clue& clue, std::size_t landmark) {
  const auto at = std::lower_bound(
      clue.options.begin(), clue.options.end(), landmark,
      [](const Clue::Option& option, std::size_t key) { return option.landmark < key; });
  return at != clue.options.end() && at->landmark == landmark ? &*at : nullptr;
}

bool is_disc(const Clue& clue) {
  return std::holds_alternative<EllipseObservation>(*clue.seen);
}

/// All codes and the largest discs, in the order of the clues.
std::vector<std::size_t> paired(const std::vector<Clue>& clues) {
  std::vector<std::size_t> discs;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < clues.size(); ++i) (is_disc(clues[i]) ? discs : chosen).push_back(i);
  std::stable_sort(discs.begin(), discs.end(), [&clues](std::size_t a, std::size_t b) {
    return clues[a].radius_px > clues[b].radius_px;
  });
  discs.resize(std::min(discs.size(), kPairedDiscs));
  chosen.insert(chosen.end(), discs.begin(), discs.end());
  return chosen;
}

}  // namespace

/// Collects candidates: of each cell of place and heading the best supported.
class PlaceCandidates::Ballot {
 public:
  explicit Ballot(long max_pairs) : max_pairs_(max_pairs) {}

  /// Whether the budget has room for one more; counts it.
  bool take() {
    if (found_.pairs >= max_pairs_) found_.complete = false;
    if (!found_.complete) return false;
    ++found_.pairs;
    return true;
  }
  bool complete() const { return found_.complete; }

  void add(CandidatePose candidate) {
    const auto [at, is_new] = cells_.try_emplace(cell(candidate.pose), found_.poses.size());
    if (is_new)
      found_.poses.push_back(std::move(candidate));
    else if (better(candidate, found_.poses[at->second]))
      found_.poses[at->second] = std::move(candidate);
  }

  CandidatePoses result() && {
    std::stable_sort(found_.poses.begin(), found_.poses.end(), &better);
    return std::move(found_);
  }

 private:
  static bool better(const CandidatePose& a, const CandidatePose& b) {
    return a.support != b.support ? a.support > b.support : a.misfit < b.misfit;
  }
  static std::uint64_t cell(const Pose2& pose) {
    const auto index = [](double value, double size) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / size)) &
                                        0xfffff);
    };
    return (index(pose.x, kPoseCell_m) << 40U) | (index(pose.y, kPoseCell_m) << 20U) |
           index(pose.theta, kPoseCellAngle);
  }

  long max_pairs_;
  CandidatePoses found_;
  std::unordered_map<std::uint64_t, std::size_t> cells_;
};

PlaceCandidates::PlaceCandidates(LandmarkMap map, const RigOnGround& on_ground)
    : map_(std::move(map)), on_ground_(on_ground) {
  for (const Landmark& landmark : map_.all()) {
    marks_.push_back({on_ground.ground.in_plan(landmark.centre_w()),
                      on_ground.ground.frame_under(landmark.centre_w()).linear().transpose() *
                          landmark.normal_w(),
                      disc_radius(landmark).value_or(0.0)});
    const double radius = marks_.back().radius_m;
    if (radius > 0.0 && std::find(radii_.begin(), radii_.end(), radius) == radii_.end())
      radii_.push_back(radius);
  }
  sort_pairs();
  fill_grid();
}

void PlaceCandidates::sort_pairs() {
  for (unsigned a = 0; a < marks_.size(); ++a) {
    for (unsigned b = a + 1; b < marks_.size(); ++b) {
      if (marks_[a].radius_m <= 0.0 || marks_[b].radius_m <= 0.0) continue;
      const auto apart = static_cast<float>((in_plan(a) - in_plan(b)).norm());
      if (apart <= kMaxPair_m) pairs_.push_back({apart, a, b});
    }
  }
  std::stable_sort(pairs_.begin(), pairs_.end(),
                   [](const Pair& a, const Pair& b) { return a.distance_m < b.distance_m; });
}

void PlaceCandidates::fill_grid() {
  if (marks_.empty()) return;
  Eigen::Vector2d low = in_plan(0);
  Eigen::Vector2d high = low;
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    low = low.cwiseMin(in_plan(i));
    high = high.cwiseMax(in_plan(i));
  }
  grid_.corner = low;
  grid_.columns = 1 + static_cast<int>((high - low).x() / kGridCell_m);
  grid_.rows = 1 + static_cast<int>((high - low).y() / kGridCell_m);
  grid_.cells.resize(static_cast<std::size_t>(grid_.columns) *
                     static_cast<std::size_t>(grid_.rows));
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    const Eigen::Vector2d at = (in_plan(i) - low) / kGridCell_m;
    grid_.cells[grid_.index(static_cast<int>(at.x()), static_cast<int>(at.y()))].push_back(i);
  }
}

double PlaceCandidates::tolerance(double range_m) {
  return kPlaceTolerance_m + kPlaceToleranceShare * range_m;
}

std::vector<Clue> PlaceCandidates::clues(const std::vector<Observation>& sightings) const {
  std::vector<Clue> clues;
  for (const Observation& seen : sightings) {
    clues.push_back(
        std::visit(Overloaded{[this](const EllipseObservation& disc) { return disc_clue(disc); },
                              [this](const PointsObservation& code) { return points_clue(code); },
                              [](const auto&) { return Clue{}; }},
                   seen));
    clues.back().seen = &seen;
  }
  return clues;
}

Clue PlaceCandidates::disc_clue(const EllipseObservation& seen) const {
  Clue clue;
  clue.radius_px = seen.ellipse.a;
  clue.aspect = seen.ellipse.b / seen.ellipse.a;
  const double eye_m = on_ground_.rig.at(seen.shot.camera).rMc(seen.shot.head).translation().z();
  std::vector<Eigen::Vector3d> places;
  for (const double radius : radii_) places.push_back(disc_place(seen, radius, on_ground_));
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    const auto kind = std::find(radii_.begin(), radii_.end(), marks_[i].radius_m);
    if (kind == radii_.end()) continue;
    const Eigen::Vector3d& at = places[static_cast<std::size_t>(kind - radii_.begin())];
    const double off_m = kPlaceTolerance_m + kHeightToleranceShare * std::abs(at.z() - eye_m) +
                         kTiltTolerance * at.head<2>().norm();
    if (std::abs(at.z() - marks_[i].p.z()) < off_m) clue.options.push_back({i, at.head<2>()});
  }
  return clue;
}

Clue PlaceCandidates::points_clue(const PointsObservation& seen) const {
  Clue clue;
  const Landmark* landmark = map_.find(seen.landmark);
  if (landmark == nullptr) return clue;
  clue.radius_px = image_extent(seen, landmark).radius_px;
  const PointsPose solved = solve_points(seen_points(*landmark, seen), pinhole(seen.shot));
  if (!solved.has_pose()) return clue;
  const auto index = static_cast<std::size_t>(landmark - map_.all().data());
  const Eigen::Vector3d p_r =
      on_ground_.rig.at(seen.shot.camera).rMc(seen.shot.head) * solved.pose.cMl.translation();
  clue.options.push_back({index, p_r.head<2>()});
  clue.poses.push_back(on_floor(*landmark, solved.pose, seen.shot, on_ground_));
  if (solved.twin) clue.poses.push_back(on_floor(*landmark, *solved.twin, seen.shot, on_ground_));
  return clue;
}

CandidatePoses PlaceCandidates::search(const std::vector<Clue>& clues, long max_pairs) const {
  Ballot ballot(max_pairs);
  for (std::size_t i = 0; i < clues.size(); ++i)
    for (const Pose2& pose : clues[i].poses)
      if (ballot.take())
        ballot.add({pose, {{i, clues[i].options.front().landmark}}, support(clues, pose), 0.0});
  const std::vector<std::size_t> chosen = paired(clues);
  for (std::size_t a = 0; a < chosen.size() && ballot.complete(); ++a)
    for (std::size_t b = a + 1; b < chosen.size() && ballot.complete(); ++b)
      look_up(clues, chosen[a], chosen[b], ballot);
  return std::move(ballot).result();
}

/// Every pair of landmarks that the two sightings may be.
void PlaceCandidates::look_up(const std::vector<Clue>& clues, std::size_t i, std::size_t j,
                              Ballot& ballot) const {
  if (clues[i].options.empty() || clues[j].options.empty()) return;
  const double apart = wrap_angle(bearing_of(clues[i].options.front().p_r) -
                                  bearing_of(clues[j].options.front().p_r));
  if (std::abs(apart) < kMinApart) return;
  if (is_disc(clues[i]) && is_disc(clues[j])) return look_up_discs(clues, i, j, ballot);
  for (const Clue::Option& k : clues[i].options) {
    for (const Clue::Option& l : clues[j].options) {
      if (k.landmark == l.landmark) continue;
      const double allowed = tolerance(k.p_r.norm() + l.p_r.norm());
      const double off =
          (k.p_r - l.p_r).norm() - (in_plan(k.landmark) - in_plan(l.landmark)).norm();
      if (std::abs(off) > allowed) continue;
      if (!ballot.take()) return;
      const Pose2 pose = align(k.p_r, l.p_r, in_plan(k.landmark), in_plan(l.landmark));
      if (faces(clues[i], k.landmark, pose) && faces(clues[j], l.landmark, pose))
        ballot.add({pose,
                    {{i, k.landmark}, {j, l.landmark}},
                    support(clues, pose),
                    std::abs(off) / allowed});
    }
  }
}

void PlaceCandidates::look_up_discs(const std::vector<Clue>& clues, std::size_t i, std::size_t j,
                                    Ballot& ballot) const {
  const auto& disc_i = std::get<EllipseObservation>(*clues[i].seen);
  const auto& disc_j = std::get<EllipseObservation>(*clues[j].seen);
  const auto consider = [&](std::size_t k, std::size_t l, double allowed, double distance) {
    const Clue::Option* at_i = option_of(clues[i], k);
    const Clue::Option* at_j = at_i == nullptr ? nullptr : option_of(clues[j], l);
    if (at_j == nullptr || !ballot.take()) return;
    const Pose2 pose = align(at_i->p_r, at_j->p_r, in_plan(k), in_plan(l));
    if (!faces(clues[i], k, pose) || !faces(clues[j], l, pose)) return;
    const double off = std::abs((at_i->p_r - at_j->p_r).norm() - distance);
    ballot.add({pose, {{i, k}, {j, l}}, support(clues, pose), off / allowed});
  };
  for (const double r_i : radii_) {
    for (const double r_j : radii_) {
      const Eigen::Vector2d q_i = disc_place(disc_i, r_i, on_ground_).head<2>();
      const Eigen::Vector2d q_j = disc_place(disc_j, r_j, on_ground_).head<2>();
      const double allowed = tolerance(q_i.norm() + q_j.norm());
      const double distance = (q_i - q_j).norm();
      const auto from =
          std::lower_bound(pairs_.begin(), pairs_.end(), distance - allowed,
                           [](const Pair& pair, double least) { return pair.distance_m < least; });
      for (auto pair = from; pair != pairs_.end() && pair->distance_m < distance + allowed;
           ++pair) {
        if (!ballot.complete()) return;
        if (marks_[pair->a].radius_m == r_i && marks_[pair->b].radius_m == r_j)
          consider(pair->a, pair->b, allowed, pair->distance_m);
        if (marks_[pair->b].radius_m == r_i && marks_[pair->a].radius_m == r_j)
          consider(pair->b, pair->a, allowed, pair->distance_m);
      }
    }
  }
}

/// Whether the landmark turns its face to a robot there, a disc about as far as it was seen.
bool PlaceCandidates::faces(const Clue& clue, std::size_t landmark, const Pose2& pose) const {
  const Shot& shot = shot_of(*clue.seen);
  const Mark& mark = marks_[landmark];
  const Eigen::Vector3d eye_r = on_ground_.rig.at(shot.camera).rMc(shot.head).translation();
  const Eigen::Vector3d line = to_isometry(pose) * eye_r - mark.p;
  const double cosine = line.normalized().dot(mark.n);
  return cosine > 0.0 && (!is_disc(clue) || std::abs(cosine - clue.aspect) < kAspectTolerance);
}

int PlaceCandidates::support(const std::vector<Clue>& clues, const Pose2& pose) const {
  return static_cast<int>(std::count_if(clues.begin(), clues.end(),
                                        [&](const Clue& clue) { return supported(clue, pose); }));
}

/// Whether one of the landmarks that it may be is about where the sighting stands.
bool PlaceCandidates::supported(const Clue& clue, const Pose2& pose) const {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(pose.theta).toRotationMatrix();
  const auto near = [&](const Clue::Option& option) {
    const Eigen::Vector2d off = pose.position() + turn * option.p_r - in_plan(option.landmark);
    const double allowed = tolerance(option.p_r.norm());
    return off.squaredNorm() <= allowed * allowed;
  };
  constexpr std::size_t kFew = 12;
  if (clue.options.size() <= kFew || radii_.size() > 1)
    return std::any_of(clue.options.begin(), clue.options.end(), near);
  const Eigen::Vector2d& p_r = clue.options.front().p_r;
  const Eigen::Vector2d at = pose.position() + turn * p_r - grid_.corner;
  const double reach = tolerance(p_r.norm());
  const auto cell = [](double m) { return static_cast<int>(std::floor(m / kGridCell_m)); };
  for (int row = std::max(0, cell(at.y() - reach));
       row <= std::min(grid_.rows - 1, cell(at.y() + reach)); ++row) {
    for (int column = std::max(0, cell(at.x() - reach));
         column <= std::min(grid_.columns - 1, cell(at.x() + reach)); ++column) {
      for (const std::size_t landmark : grid_.cells[grid_.index(column, row)]) {
        const Clue::Option* option = option_of(clue, landmark);
        if (option != nullptr && near(*option)) return true;
      }
    }
  }
  return false;
}

}  // namespace vigia::localization
