#include "vigia/localization/station_fix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

using Eigen::Index;

constexpr Index kPoseSize = 3;
constexpr Index kFirstMotion = 6;  // after pose and calibration

Index index_of(std::size_t i) {
  return static_cast<Index>(i);
}

Index landmark_state(const StationChain& chain, std::size_t landmark) {
  return kFirstMotion + 3 * index_of(chain.motions.size()) + 2 * index_of(landmark);
}

template <int N>
Eigen::Matrix<double, N, N> root_of(const Eigen::Matrix<double, N, N>& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> eigen(covariance);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

Eigen::Matrix2d turned_by(double angle) {
  const Eigen::Vector2d u = unit_vector(angle);
  Eigen::Matrix2d R;
  R << u.x(), -u.y(), u.y(), u.x();
  return R;
}

Eigen::Vector2d quarter_turn(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

StereoErrors errors_of(const StationChain& chain, const Eigen::VectorXd& state) {
  const Eigen::Vector3d e = chain.calibration_sigma.vector().cwiseProduct(state.segment<3>(3));
  return {e.x(), e.y(), e.z()};
}

/// Pose at a point, and how it moves with the state.
struct Station {
  Eigen::Vector3d pose;
  Eigen::MatrixXd dpose;
};

/// The point before @p after: θ − turn, then p − d, each motion's error whitened by its root.
Station before(const Station& after, const StationMotion& motion, const Eigen::Vector3d& white,
               Index at) {
  const Eigen::Matrix3d root = root_of<3>(motion.covariance);
  const Eigen::Vector3d error = root * white;
  Station station = after;
  station.pose.z() -= motion.turn + error.z();
  station.dpose.block<1, 3>(2, at) -= root.row(2);
  const Eigen::Vector2d d = motion.displacement_m + error.head<2>();
  if (motion.frame == MotionFrame::world) {
    station.pose.head<2>() -= d;
    station.dpose.block<2, 3>(0, at) -= root.topRows<2>();
    return station;
  }
  const Eigen::Matrix2d wRr = turned_by(station.pose.z());
  station.pose.head<2>() -= wRr * d;
  station.dpose.topRows<2>() -= quarter_turn(wRr * d) * station.dpose.row(2);
  station.dpose.block<2, 3>(0, at) -= wRr * root.topRows<2>();
  return station;
}

/// Poses at all points, the oldest first.
std::vector<Station> stations_at(const StationChain& chain, const Eigen::VectorXd& state) {
  std::vector<Station> stations(chain.sightings.size());
  Station& last = stations.back();
  last.pose = state.head<3>();
  last.dpose = Eigen::MatrixXd::Zero(3, state.size());
  last.dpose.leftCols<3>().setIdentity();
  for (std::size_t k = chain.motions.size(); k-- > 0;) {
    const Index at = kFirstMotion + 3 * index_of(k);
    stations[k] = before(stations[k + 1], chain.motions[k], state.segment<3>(at), at);
  }
  return stations;
}

/// Where the state puts a landmark.
Eigen::Vector2d place_at(const StationChain& chain, const Eigen::VectorXd& state,
                         std::size_t landmark) {
  const LandmarkPlace& place = chain.landmarks[landmark];
  return place.p_w +
         root_of<2>(place.covariance) * state.segment<2>(landmark_state(chain, landmark));
}

/// Two rows of one sighting; nothing where it is behind a camera.
struct SightingRows {
  Eigen::Vector2d r;
  Eigen::MatrixXd J;
};

std::optional<SightingRows> sighting_rows(const StationChain& chain, const Eigen::VectorXd& state,
                                          const Station& station, const StereoSighting& sighting) {
  const Eigen::Vector2d to = place_at(chain, state, sighting.landmark) - station.pose.head<2>();
  const Eigen::Matrix2d rRw = turned_by(-station.pose.z());
  const Eigen::Vector2d p_r = rRw * to;
  const auto image = stereo_image(chain.pair, errors_of(chain, state), p_r);
  if (!image) return std::nullopt;
  Eigen::MatrixXd dp_r = -rRw * station.dpose.topRows<2>();
  dp_r -= quarter_turn(p_r) * station.dpose.row(2);
  dp_r.middleCols<2>(landmark_state(chain, sighting.landmark)) +=
      rRw * root_of<2>(chain.landmarks[sighting.landmark].covariance);
  SightingRows rows{(image->columns - sighting.columns.vector()) / sighting.sigma_px,
                    image->dcolumns_dp * dp_r / sighting.sigma_px};
  rows.J.middleCols<3>(kPoseSize) +=
      image->dcolumns_derrors * chain.calibration_sigma.vector().asDiagonal() / sighting.sigma_px;
  return rows;
}

/// Information of the pose with everything else marginalised, JᵀJ's Schur complement.
Eigen::Matrix3d pose_information(const Eigen::MatrixXd& information) {
  const Index rest = information.rows() - kPoseSize;
  const Eigen::MatrixXd across = information.topRightCorner(kPoseSize, rest);
  return information.topLeftCorner<3, 3>() -
         across * information.bottomRightCorner(rest, rest).ldlt().solve(across.transpose());
}

/// Whether the three of a pose are all determined.
bool determined(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().x() > 1e-9 * eigen.eigenvalues().z() && eigen.eigenvalues().x() > 1e-6;
}

/// Whether some place differs from another, or a displacement is known in the world's axes.
bool tells_heading(const StationChain& chain) {
  if (chain.heading) return true;
  const auto& first = chain.landmarks[chain.sightings.front().landmark].p_w;
  return std::any_of(
             chain.sightings.begin(), chain.sightings.end(),
             [&](const StereoSighting& s) { return chain.landmarks[s.landmark].p_w != first; }) ||
         std::any_of(chain.motions.begin(), chain.motions.end(),
                     [](const StationMotion& m) { return m.frame == MotionFrame::world; });
}

/// What was seen, turned and put back into the last point's frame, and its landmark, displaced in
/// world axes: the pose at the last point carries one to the other.
struct Pairing {
  Eigen::Vector2d seen;
  Eigen::Vector2d place;
  double weight;  ///< nearer points count more
};

/// Empty where a sighting has no disparity.
std::vector<Pairing> pairings_of(const StationChain& chain) {
  std::vector<Pairing> pairings;
  double turn = 0.0;
  Eigen::Vector2d in_world = Eigen::Vector2d::Zero();
  Eigen::Vector2d in_body = Eigen::Vector2d::Zero();
  for (std::size_t k = chain.sightings.size(); k-- > 0;) {
    if (k < chain.motions.size()) {
      const StationMotion& motion = chain.motions[k];
      turn -= motion.turn;
      if (motion.frame == MotionFrame::world)
        in_world += motion.displacement_m;
      else
        in_body += turned_by(turn) * motion.displacement_m;
    }
    const auto point = triangulate(chain.pair, chain.sightings[k].columns, 1.0);
    if (!point) return {};
    pairings.push_back({turned_by(turn) * point->p_r - in_body,
                        chain.landmarks[chain.sightings[k].landmark].p_w + in_world,
                        1.0 / std::pow(point->p_r.norm(), 4)});
  }
  return pairings;
}

/// Weighted means of both.
struct Centroids {
  Eigen::Vector2d seen = Eigen::Vector2d::Zero();
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
};

Centroids centroids_of(const std::vector<Pairing>& pairings) {
  Centroids means;
  double weights = 0.0;
  for (const Pairing& pairing : pairings) {
    weights += pairing.weight;
    means.seen += pairing.weight * pairing.seen;
    means.place += pairing.weight * pairing.place;
  }
  return {means.seen / weights, means.place / weights};
}

/// The heading that turns what was seen onto the landmarks by least squares.
double laid_heading(const std::vector<Pairing>& pairings, const Centroids& means) {
  double sine = 0.0;
  double cosine = 0.0;
  for (const Pairing& pairing : pairings) {
    const Eigen::Vector2d a = pairing.seen - means.seen;
    const Eigen::Vector2d b = pairing.place - means.place;
    sine += pairing.weight * cross(a, b);
    cosine += pairing.weight * a.dot(b);
  }
  return std::atan2(sine, cosine);
}

/// Of two sightings: the headings by which what was seen differs across the line of sight as it
/// was seen to, and along it by what the distance of the places leaves, to either side.
std::vector<double> mirrored_headings(const std::vector<Pairing>& pairings) {
  const Eigen::Vector2d a = pairings[1].seen - pairings[0].seen;
  const Eigen::Vector2d b = pairings[1].place - pairings[0].place;
  const Eigen::Vector2d sight = (pairings[0].seen + pairings[1].seen).normalized();
  const Eigen::Vector2d across = a - a.dot(sight) * sight;
  const double along = std::sqrt(std::max(0.0, b.squaredNorm() - across.squaredNorm()));
  std::vector<double> headings;
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector2d v = across + side * along * sight;
    headings.push_back(std::atan2(cross(v, b), v.dot(b)));
  }
  return headings;
}

/// Poses to begin at.
std::vector<Eigen::Vector3d> starting_poses(const StationChain& chain,
                                            const std::vector<Pairing>& pairings) {
  const Centroids means = centroids_of(pairings);
  std::vector<double> headings;
  if (chain.heading) {
    headings = {chain.heading->heading};
  } else {
    if (pairings.size() == 2) headings = mirrored_headings(pairings);
    headings.push_back(laid_heading(pairings, means));
  }
  std::vector<Eigen::Vector3d> poses;
  for (const double heading : headings) {
    const Eigen::Vector2d p = means.place - turned_by(heading) * means.seen;
    poses.emplace_back(p.x(), p.y(), heading);
  }
  return poses;
}

double greatest_sin_gamma(const StationChain& chain, const Eigen::VectorXd& state) {
  std::vector<Eigen::Vector2d> sights;
  const std::vector<Station> stations = stations_at(chain, state);
  for (std::size_t k = 0; k < stations.size(); ++k)
    sights.push_back(
        (place_at(chain, state, chain.sightings[k].landmark) - stations[k].pose.head<2>())
            .normalized());
  double greatest = 0.0;
  for (std::size_t i = 0; i < sights.size(); ++i)
    for (std::size_t j = i + 1; j < sights.size(); ++j)
      greatest = std::max(greatest, std::abs(cross(sights[i], sights[j])));
  return greatest;
}

struct Descent {
  Eigen::VectorXd state;
  ChainResiduals at;
  bool converged = false;
};

/// Levenberg and Marquardt from where the residuals exist.
Descent descend(const StationChain& chain, const Eigen::VectorXd& start, const ChainResiduals& at,
                const StationFixParams& params) {
  Descent descent{start, at};
  double damping = 1e-6;
  for (int i = 0; i < params.iterations && !descent.converged; ++i) {
    Eigen::MatrixXd A = descent.at.J.transpose() * descent.at.J;
    A.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd step = -A.ldlt().solve(descent.at.J.transpose() * descent.at.r);
    const Eigen::VectorXd next = descent.state + step;
    const auto there = chain_residuals(chain, next);
    if (there && there->r.squaredNorm() <= descent.at.r.squaredNorm()) {
      descent.state = next;
      descent.at = *there;
      damping = std::max(1e-12, 0.1 * damping);
      descent.converged = step.norm() < params.converged;
    } else {
      // No way down but a step within rounding: it is there.
      descent.converged = step.norm() < params.converged;
      damping *= 10.0;
    }
  }
  return descent;
}

/// Mean and covariance of the pose, were (range, direction, heading) seen from @p centre normal:
/// that is what a heading's error leaves straight. Quadrature, five points an axis.
PoseHypothesis moments_about(const Eigen::Vector2d& centre, const Eigen::Vector3d& mode,
                             const Eigen::Matrix3d& covariance) {
  // Nodes and weights of Gauss and Hermite for a standard normal variable.
  constexpr std::array<double, 5> kNodes{-2.856970013872806, -1.355626179974266, 0.0,
                                         1.355626179974266, 2.856970013872806};
  constexpr std::array<double, 5> kWeights{0.011257411327721, 0.222075922005613, 0.533333333333333,
                                           0.222075922005613, 0.011257411327721};
  const Eigen::Vector2d q = mode.head<2>() - centre;
  const double range = q.norm();
  const Eigen::Vector2d u = q / range;
  Eigen::Matrix3d J;
  J << u.x(), u.y(), 0.0, -u.y() / range, u.x() / range, 0.0, 0.0, 0.0, 1.0;
  const Eigen::Matrix3d root = root_of<3>(J * covariance * J.transpose());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 125; ++i) {
    const std::array<std::size_t, 3> at{i % 5, i / 5 % 5, i / 25};
    const Eigen::Vector3d polar =
        root * Eigen::Vector3d(kNodes.at(at[0]), kNodes.at(at[1]), kNodes.at(at[2]));
    const double weight = kWeights.at(at[0]) * kWeights.at(at[1]) * kWeights.at(at[2]);
    Eigen::Vector3d off;
    off << (range + polar.x()) * (turned_by(polar.y()) * u) - q, polar.z();
    mean += weight * off;
    square += weight * off * off.transpose();
  }
  return {Pose2::from_vector(mode + mean), square - mean * mean.transpose(), 1.0};
}

/// A minimum of the residuals with what it says of the pose.
struct Mode {
  Descent descent;
  Eigen::MatrixXd covariance;  ///< of the state
  PoseHypothesis pose;
  double log_weight = 0.0;
};

/// Nothing where the pose is not determined there.
std::optional<Mode> mode_at(const StationChain& chain, Descent descent) {
  const Eigen::MatrixXd information = descent.at.J.transpose() * descent.at.J;
  const Eigen::Matrix3d of_pose = pose_information(information);
  if (!determined(of_pose)) return std::nullopt;
  Mode mode{std::move(descent), {}, {}, 0.0};
  mode.covariance =
      information.ldlt().solve(Eigen::MatrixXd::Identity(information.rows(), information.rows()));
  mode.pose = moments_about(place_at(chain, mode.descent.state, chain.sightings.back().landmark),
                            mode.descent.state.head<3>(), mode.covariance.topLeftCorner<3, 3>());
  mode.log_weight = -0.5 * (mode.descent.at.r.squaredNorm() + std::log(information.determinant()));
  return mode;
}

/// Whether both are one minimum, reached to different depths.
bool same_minimum(const Mode& a, const Mode& b) {
  const Eigen::Vector3d e = difference(a.pose.pose, b.pose.pose);
  return e.dot(a.pose.covariance.ldlt().solve(e)) < 0.0625;
}

/// The distinct minima, the likelier first.
std::vector<Mode> modes_of(const StationChain& chain, const std::vector<Pairing>& pairings,
                           const StationFixParams& params) {
  std::vector<Mode> modes;
  for (const Eigen::Vector3d& pose : starting_poses(chain, pairings)) {
    Eigen::VectorXd state = Eigen::VectorXd::Zero(chain_state_size(chain));
    state.head<3>() = pose;
    const auto at = chain_residuals(chain, state);
    if (!at) continue;
    auto mode = mode_at(chain, descend(chain, state, *at, params));
    const bool known = mode && std::any_of(modes.begin(), modes.end(), [&](const Mode& other) {
                         return same_minimum(other, *mode);
                       });
    if (mode && !known) modes.push_back(*std::move(mode));
  }
  std::sort(modes.begin(), modes.end(),
            [](const Mode& a, const Mode& b) { return a.log_weight > b.log_weight; });
  if (modes.size() > 2) modes.resize(2);
  return modes;
}

StationFix fix_of(const StationChain& chain, const std::vector<Mode>& modes,
                  const StationFixParams& params) {
  StationFix fix;
  if (modes.empty()) return fix;
  const Mode& best = modes.front();
  double sum = 0.0;
  for (const Mode& mode : modes) sum += std::exp(mode.log_weight - best.log_weight);
  for (const Mode& mode : modes) {
    fix.hypotheses.push_back(mode.pose);
    fix.hypotheses.back().weight = std::exp(mode.log_weight - best.log_weight) / sum;
  }
  const Eigen::Vector3d sigma = chain.calibration_sigma.vector();
  fix.calibration = errors_of(chain, best.descent.state);
  fix.calibration_covariance =
      sigma.asDiagonal() * best.covariance.block<3, 3>(kPoseSize, kPoseSize) * sigma.asDiagonal();
  Eigen::Matrix<double, 6, 1> units = Eigen::Matrix<double, 6, 1>::Ones();
  units.tail<3>() = sigma;
  fix.joint_covariance =
      units.asDiagonal() * best.covariance.topLeftCorner<6, 6>() * units.asDiagonal();
  fix.chi_square = best.descent.at.r.squaredNorm();
  fix.sin_gamma = greatest_sin_gamma(chain, best.descent.state);
  if (!best.descent.converged)
    fix.status = StationFixStatus::not_converged;
  else if (!chain.heading && fix.sin_gamma < params.min_sin_gamma)
    fix.status = StationFixStatus::degenerate;
  else if (fix.hypotheses.front().weight < params.resolved)
    fix.status = StationFixStatus::ambiguous;
  else
    fix.status = StationFixStatus::found;
  return fix;
}

}  // namespace

Index chain_state_size(const StationChain& chain) {
  return landmark_state(chain, chain.landmarks.size());
}

std::optional<ChainResiduals> chain_residuals(const StationChain& chain,
                                              const Eigen::VectorXd& state) {
  const Index columns = 2 * index_of(chain.sightings.size());
  const Index priors = state.size() - kPoseSize;
  const Index height = columns + priors + (chain.heading ? 1 : 0);
  ChainResiduals out{Eigen::VectorXd::Zero(height), Eigen::MatrixXd::Zero(height, state.size())};
  const std::vector<Station> stations = stations_at(chain, state);
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const auto rows = sighting_rows(chain, state, stations[k], chain.sightings[k]);
    if (!rows) return std::nullopt;
    out.r.segment<2>(2 * index_of(k)) = rows->r;
    out.J.middleRows<2>(2 * index_of(k)) = rows->J;
  }
  out.r.segment(columns, priors) = state.tail(priors);
  out.J.block(columns, kPoseSize, priors, priors).setIdentity();
  if (chain.heading) {
    out.r(height - 1) = wrap_angle(state.z() - chain.heading->heading) / chain.heading->sigma;
    out.J(height - 1, 2) = 1.0 / chain.heading->sigma;
  }
  return out;
}

StationFix station_fix(const StationChain& chain, const StationFixParams& params) {
  StationFix fix;
  fix.status = StationFixStatus::no_heading;
  if (chain.sightings.empty() || !tells_heading(chain)) return fix;
  fix.status = StationFixStatus::behind_camera;
  const std::vector<Pairing> pairings = pairings_of(chain);
  if (pairings.empty()) return fix;
  return fix_of(chain, modes_of(chain, pairings, params), params);
}

std::optional<Eigen::Matrix3d> station_bound(const StationChain& chain, const Pose2& last,
                                             const StereoErrors& errors) {
  Eigen::VectorXd state = Eigen::VectorXd::Zero(chain_state_size(chain));
  state.head<3>() = last.vector();
  for (Index i = 0; i < 3; ++i) {
    const double sigma = chain.calibration_sigma.vector()(i);
    if (sigma > 0.0) state(kPoseSize + i) = errors.vector()(i) / sigma;
  }
  const auto at = chain_residuals(chain, state);
  if (!at) return std::nullopt;
  const Eigen::Matrix3d information = pose_information(at->J.transpose() * at->J);
  if (!determined(information)) return std::nullopt;
  return Eigen::Matrix3d(information.inverse());
}

}  // namespace vigia::localization
