#include "points_gate.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/localization/chi_square.hpp"

namespace vigia::localization {
namespace {

constexpr int kSteps = 20;
/// A turn about the camera with the pan turned back leaves no trace.
constexpr int kMostRank = 5;
constexpr double kConverged = 1e-7;  // m, rad

struct Explanation {
  Vector6 mean;  ///< the most likely state
  double nis = 0.0;
  double scatter = 0.0;
  int rank = 0;  ///< directions of the state that the points measure
};

/// Nothing when a point has no image on the way or the steps do not converge.
std::optional<Explanation> explain(const PointsGate& gate, const EkfState& state,
                                   const PointsFix& fix) {
  Explanation found;
  found.mean = state.mean;
  for (int i = 0; i < kSteps; ++i) {
    const auto seen = measure_points(fix.points, fix.landmark.wMl, fix.shot, gate.on_ground,
                                     Pose2::from_vector(found.mean.head<3>()),
                                     {found.mean(3), found.mean(4), found.mean(5)});
    if (!seen) return std::nullopt;
    const Matrix6 HP = seen->H * state.covariance;
    const Eigen::LLT<Matrix6> S(HP * seen->H.transpose() + reading_covariance(*seen, gate.noise));
    const Vector6 innovation = seen->y - seen->H * (state.mean - found.mean);
    const Vector6 weighted = S.solve(innovation);
    const Vector6 next = state.mean + HP.transpose() * weighted;
    const double step = (next - found.mean).cwiseAbs().maxCoeff();
    found.mean = next;
    found.nis = innovation.dot(weighted);
    found.scatter = seen->chi2 - seen->y.squaredNorm();
    found.rank = std::min(
        kMostRank, static_cast<int>((seen->H.rowwise().squaredNorm().array() > 0.0).count()));
    if (!(step < 1e6)) return std::nullopt;
    if (step < kConverged) return found;
  }
  return std::nullopt;
}

}  // namespace

UpdateResult gate_points(const PointsGate& gate, const EkfState& state, const PointsFix& fix) {
  const LandmarkId id = fix.landmark.id;
  const auto found = explain(gate, state, fix);
  if (!found) return {UpdateStatus::degenerate, id, 0.0, 0};
  const int spare = 2 * static_cast<int>(fix.points.size()) - found->rank;
  const bool expected = found->nis <= chi_square_quantile(gate.probability, found->rank);
  const bool tidy = spare <= 0 || found->scatter <= chi_square_quantile(gate.probability, spare);
  return {expected && tidy ? UpdateStatus::fused : UpdateStatus::gated, id, found->nis,
          found->rank};
}

}  // namespace vigia::localization
