#include "vigia/localization/mirror_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

#include "vigia/core/median.hpp"
#include "vigia/localization/field_match.hpp"

namespace vigia::localization {
namespace {

constexpr auto kFirstPose = static_cast<Eigen::Index>(kMirrorParameters);

/// Steps of the central differences: of each parameter's change, and of x, y, θ.
constexpr std::array<double, kMirrorParameters> kMirrorSteps{1e-5, 1e-3, 1e-3, 1e-6,
                                                             1e-6, 1e-5, 1e-5};
constexpr double kPoseStep = 1e-6;

std::optional<Eigen::Vector2d> on_floor(const MirrorMount& mount, const Eigen::Vector2d& uv) {
  constexpr double kShallow = 1e-3;  // rad below the horizon
  const auto direction_c = ray(mount.mirror, uv);
  if (!direction_c) return std::nullopt;
  const Eigen::Vector3d direction_r = mount.rMc.linear() * *direction_c;
  if (direction_r.z() > -kShallow) return std::nullopt;
  const Eigen::Vector3d& eye_r = mount.rMc.translation();
  return (eye_r - direction_r * (eye_r.z() / direction_r.z())).head<2>();
}

Eigen::Vector2d in_field(const Pose2& pose, const Eigen::Vector2d& p_r) {
  return pose.position() + Eigen::Rotation2Dd(pose.theta) * p_r;
}

MirrorPoint moved_along_ray(const MirrorPoint& point, double by_px) {
  const Eigen::Vector2d along = (point.outer_uv - point.inner_uv).normalized();
  return {point.inner_uv + by_px * along, point.outer_uv + by_px * along, point.sigma_px};
}

/// The signed offsets of a point's edges from a line's middle, m.
struct EdgeOffsets {
  double inner_m = 0.0;
  double outer_m = 0.0;
  double mean() const { return 0.5 * (inner_m + outer_m); }
  double apart() const { return std::abs(outer_m - inner_m); }
};

std::optional<EdgeOffsets> edge_offsets(const FieldLine& line, const MirrorPoint& point,
                                        const MirrorMount& mount, const Pose2& pose) {
  const auto inner = on_floor(mount, point.inner_uv);
  const auto outer = on_floor(mount, point.outer_uv);
  if (!inner || !outer) return std::nullopt;
  return EdgeOffsets{line_offset(line, in_field(pose, *inner)).distance_m,
                     line_offset(line, in_field(pose, *outer)).distance_m};
}

/// Their mean, m.
std::optional<double> offset_from(const FieldLine& line, const MirrorPoint& point,
                                  const MirrorMount& mount, const Pose2& pose) {
  const auto offsets = edge_offsets(line, point, mount, pose);
  return offsets ? std::optional<double>(offsets->mean()) : std::nullopt;
}

/// How far a point lies off a line, and how far that may be by its own error.
struct LineResidual {
  double offset_m = 0.0;
  double sigma_m = 1.0;
  double wider_m = 0.0;  ///< than the line is painted: what the edges are apart more, or less
  double whitened() const { return offset_m / sigma_m; }
  /// Whether the edges can be those of this line alone, where what is not known of the mirror may
  /// change its width by a share. Where lines meet, or a ray runs along one,
  /// they are not, and their middle is beside the line's.
  bool has_the_width(const FieldLine& line, double mirror_share) const {
    constexpr double kSigmas = 2.0;  // two edges, each √2 σ of their middle
    return std::abs(wider_m) < mirror_share * line.width_m + kSigmas * 2.0 * sigma_m;
  }
};

std::optional<LineResidual> line_residual(const FieldLine& line, const MirrorPoint& point,
                                          const MirrorMount& mount, const Pose2& pose) {
  constexpr double kMapError_m = 0.0005;
  const auto offsets = edge_offsets(line, point, mount, pose);
  const auto before = offset_from(line, moved_along_ray(point, -0.5), mount, pose);
  const auto after = offset_from(line, moved_along_ray(point, 0.5), mount, pose);
  if (!offsets || !before || !after) return std::nullopt;
  return LineResidual{offsets->mean(), std::hypot(point.sigma_px * (*after - *before), kMapError_m),
                      offsets->apart() - line.width_m};
}

/// A point and the line that it lies on.
struct OnLine {
  std::size_t picture = 0;
  std::size_t point = 0;
  std::size_t line = 0;
  LineResidual residual;
};

/// The line that a point lies off by the fewest σ.
std::optional<OnLine> nearest_line(const FieldMap& field, const MirrorPoint& point,
                                   const MirrorMount& mount, const Pose2& pose,
                                   double mirror_share) {
  const auto middle = on_floor(mount, 0.5 * (point.inner_uv + point.outer_uv));
  if (!middle) return std::nullopt;
  constexpr double kFarOff_m = 1.5;
  const Eigen::Vector2d p_w = in_field(pose, *middle);
  std::optional<OnLine> best;
  for (std::size_t k = 0; k < field.lines.size(); ++k) {
    const FieldLine& line = field.lines[k];
    const LineOffset off = line_offset(line, p_w);
    if (off.inside_m < -0.5 * line.width_m || std::abs(off.distance_m) > kFarOff_m) continue;
    const auto residual = line_residual(line, point, mount, pose);
    if (!residual || !residual->has_the_width(line, mirror_share)) continue;
    if (!best || std::abs(residual->whitened()) < std::abs(best->residual.whitened()))
      best = OnLine{0, 0, k, *residual};
  }
  return best;
}

/// The estimate while it is being found.
class MirrorFit {
 public:
  MirrorFit(const FieldMap& field, const MirrorMount& start,
            const std::vector<MirrorPicture>& pictures, const MirrorCalibrationParams& params)
      : field_(field), start_(start), pictures_(pictures), params_(params) {
    change.setZero();
    used.assign(pictures.size(), true);
  }

  MirrorMount mount() const { return changed(start_, change); }

  /// Each point of the pictures in use with its line; those beyond the gate are left out. The gate
  /// is that of errors as large as the residuals' median says, where that is more than σ.
  std::vector<OnLine> assigned() const {
    constexpr double kMedianToSigma = 1.4826;
    std::vector<OnLine> all;
    std::vector<double> sizes;
    const MirrorMount now = mount();
    for (std::size_t i = 0; i < pictures_.size(); ++i)
      for (std::size_t k = 0; used[i] && k < pictures_[i].points.size(); ++k)
        if (auto found =
                nearest_line(field_, pictures_[i].points[k], now, poses[i], mirror_share)) {
          found->picture = i;
          found->point = k;
          sizes.push_back(std::abs(found->residual.whitened()));
          all.push_back(*found);
        }
    if (all.empty()) return all;
    const double limit = params_.gate * std::max(1.0, kMedianToSigma * median_of(std::move(sizes)));
    all.erase(
        std::remove_if(all.begin(), all.end(),
                       [&](const OnLine& p) { return std::abs(p.residual.whitened()) > limit; }),
        all.end());
    return all;
  }

  /// The same points beside the same lines, by the estimate as it is now.
  std::vector<OnLine> measured_anew(std::vector<OnLine> points) const {
    const MirrorMount now = mount();
    for (OnLine& at : points) {
      const MirrorPoint& point = pictures_[at.picture].points[at.point];
      const auto residual = line_residual(field_.lines[at.line], point, now, poses[at.picture]);
      if (residual) at.residual = *residual;
    }
    return points;
  }

  Eigen::Index unknowns() const { return kFirstPose + 3 * static_cast<Eigen::Index>(poses.size()); }

  /// Information of points and priors, and the gradient of minus the log-posterior.
  void normal_equations(const std::vector<OnLine>& points, Eigen::MatrixXd& information,
                        Eigen::VectorXd& gradient) const {
    information = Eigen::MatrixXd::Zero(unknowns(), unknowns());
    gradient = Eigen::VectorXd::Zero(unknowns());
    add_priors(information, gradient);
    for (const OnLine& at : points) {
      const auto row = jacobian(at);
      if (!row) continue;
      const auto pose = kFirstPose + 3 * static_cast<Eigen::Index>(at.picture);
      const double r = at.residual.whitened();
      const MirrorVector by_mirror = row->head<kMirrorParameters>().transpose();
      const Eigen::Vector3d by_pose = row->tail<3>().transpose();
      information.topLeftCorner<kMirrorParameters, kMirrorParameters>() +=
          by_mirror * by_mirror.transpose();
      information.block<3, 3>(pose, pose) += by_pose * by_pose.transpose();
      information.block<kMirrorParameters, 3>(0, pose) += by_mirror * by_pose.transpose();
      information.block<3, kMirrorParameters>(pose, 0) += by_pose * by_mirror.transpose();
      gradient.head<kMirrorParameters>() += by_mirror * r;
      gradient.segment<3>(pose) += by_pose * r;
    }
  }

  void step(const Eigen::VectorXd& by) {
    change += by.head<kMirrorParameters>();
    for (std::size_t i = 0; i < poses.size(); ++i)
      poses[i] = Pose2::from_vector(poses[i].vector() +
                                    by.segment<3>(kFirstPose + 3 * static_cast<Eigen::Index>(i)));
  }

  MirrorVector change;
  std::vector<Pose2> poses;
  std::vector<bool> used;
  double mirror_share = 0.03;  ///< of a line's width, by which the mirror may still be wrong

 private:
  using Row = Eigen::Matrix<double, 1, static_cast<int>(kMirrorParameters) + 3>;

  void add_priors(Eigen::MatrixXd& information, Eigen::VectorXd& gradient) const {
    constexpr double kAnywhere_m = 10.0;
    constexpr double kKnown = 1e12;
    for (Eigen::Index k = 0; k < kFirstPose; ++k) {
      const double sigma = params_.prior_sigma[static_cast<std::size_t>(k)];
      const double weight = sigma > 0.0 ? 1.0 / (sigma * sigma) : kKnown;
      information(k, k) += weight;
      gradient(k) += weight * change(k);
    }
    // Keeps the heading over a target that is the same all round where it is.
    for (Eigen::Index k = kFirstPose; k < unknowns(); ++k)
      information(k, k) += 1.0 / (kAnywhere_m * kAnywhere_m);
  }

  /// ∂(offset/σ) by the mirror's parameters and the picture's x, y, θ, by central differences.
  std::optional<Row> jacobian(const OnLine& at) const {
    const MirrorPoint& point = pictures_[at.picture].points[at.point];
    const FieldLine& line = field_.lines[at.line];
    const Pose2& pose = poses[at.picture];
    Row row = Row::Zero();
    const auto take = [&](Eigen::Index k, double step, const std::optional<double>& after,
                          const std::optional<double>& before) {
      if (!after || !before) return false;
      row(k) = (*after - *before) / (2.0 * step * at.residual.sigma_m);
      return true;
    };
    for (std::size_t k = 0; k < kMirrorParameters; ++k) {
      if (params_.prior_sigma[k] <= 0.0) continue;
      const MirrorVector by = kMirrorSteps[k] * MirrorVector::Unit(static_cast<Eigen::Index>(k));
      if (!take(static_cast<Eigen::Index>(k), kMirrorSteps[k],
                offset_from(line, point, changed(start_, change + by), pose),
                offset_from(line, point, changed(start_, change - by), pose)))
        return std::nullopt;
    }
    const MirrorMount now = mount();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Vector3d by = kPoseStep * Eigen::Vector3d::Unit(k);
      if (!take(kFirstPose + k, kPoseStep,
                offset_from(line, point, now, Pose2::from_vector(pose.vector() + by)),
                offset_from(line, point, now, Pose2::from_vector(pose.vector() - by))))
        return std::nullopt;
    }
    return row;
  }

  const FieldMap& field_;
  const MirrorMount& start_;
  const std::vector<MirrorPicture>& pictures_;
  const MirrorCalibrationParams& params_;
};

/// Gauss and Newton's steps, points being assigned anew at each of the first: later a point at the
/// gate that comes and goes would keep them from ending. Returns whether they ended.
bool iterate(MirrorFit& fit) {
  constexpr int kMost = 60;
  constexpr int kAssigning = 40;
  constexpr int kRough = 10;
  constexpr double kArrived = 1e-3;  // of a standard deviation
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  std::vector<OnLine> points;
  for (int i = 0; i < kMost; ++i) {
    fit.mirror_share = i < kRough ? 0.2 : 0.03;
    points = i < kAssigning ? fit.assigned() : fit.measured_anew(std::move(points));
    fit.normal_equations(points, information, gradient);
    const Eigen::VectorXd by = information.ldlt().solve(-gradient);
    if (!by.allFinite()) return false;
    // Far steps are those of wrong assignments.
    const double longest = by.tail(fit.unknowns() - kFirstPose).cwiseAbs().maxCoeff();
    constexpr double kLongest = 0.3;  // m, rad
    fit.step(by * std::min(1.0, kLongest / std::max(1e-12, longest)));
    if (i >= kRough &&
        by.dot(information * by) < kArrived * kArrived * static_cast<double>(by.size()))
      return true;
  }
  return false;
}

/// A picture's points on the floor by a mirror of which @p open is not known: the errors of its
/// scale and tilt move a point by open · h sec²θ, θ the angle from straight down.
FieldScan rough_scan(const MirrorPicture& picture, const MirrorMount& mount, double open) {
  FieldScan scan;
  for (const MirrorPoint& point : picture.points) {
    const auto inner = on_floor(mount, point.inner_uv);
    const auto outer = on_floor(mount, point.outer_uv);
    if (!inner || !outer) continue;
    FieldPoint on;
    on.p_r = 0.5 * (*inner + *outer);
    const double height = mount.rMc.translation().z();
    const double across = open * (height + on.p_r.squaredNorm() / height);
    const double along =
        point.sigma_px * (*outer - *inner).norm() / (point.outer_uv - point.inner_uv).norm();
    const Eigen::Vector2d direction = on.p_r.normalized();
    on.covariance = across * across * Eigen::Matrix2d::Identity() +
                    along * along * direction * direction.transpose();
    scan.points.push_back(on);
  }
  return scan;
}

/// The mirror and the pose that a single picture makes of one start, and how well they fit.
struct PictureStart {
  MirrorVector change = MirrorVector::Zero();
  Pose2 pose;
  double cost = 0.0;  ///< mean over the points of min(r², gate²)
};

/// Finds where the pictures were taken and what the mirror is, about.
class PicturePlacer {
 public:
  PicturePlacer(const FieldMap& field, const MirrorMount& start,
                const std::vector<MirrorPicture>& pictures, const MirrorCalibrationParams& params)
      : field_(field), start_(start), pictures_(pictures), params_(params) {}

  /// Marks the pictures that have too few points, or none that match. Returns whether any is in
  /// use. The picture that a mirror explains best tells the mirror by which the others are matched:
  /// with one that is 1 % or half a degree off, lines 4 m away lie decimetres beside the field's.
  bool place(MirrorFit& fit) {
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      fit.poses.push_back(pictures_[i].near.value_or(Pose2{}));
      fit.used[i] = static_cast<int>(pictures_[i].points.size()) >= params_.min_points;
    }
    const std::optional<PictureStart> best = best_start(fit.used);
    if (!best) return false;
    fit.change = best->change;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      if (!fit.used[i] || pictures_[i].near) continue;
      constexpr double kFairlyKnown = 0.002;
      const auto poses = matched(pictures_[i], fit.mount(), kFairlyKnown, 1);
      fit.used[i] = !poses.empty();
      if (fit.used[i]) fit.poses[i] = poses.front();
    }
    return std::find(fit.used.begin(), fit.used.end(), true) != fit.used.end();
  }

 private:
  std::vector<Pose2> matched(const MirrorPicture& picture, const MirrorMount& mount, double open,
                             std::size_t most) {
    if (!matcher_) {
      model_.emplace(field_);
      matcher_.emplace(*model_);
    }
    std::vector<Pose2> poses;
    for (const auto& suggestion : matcher_->match(rough_scan(picture, mount, open))) {
      if (poses.size() == most) break;
      poses.push_back(suggestion.fix.pose);
    }
    return poses;
  }

  std::optional<PictureStart> best_start(const std::vector<bool>& used) {
    constexpr double kHardlyKnown = 0.012;  // half a degree, 1 %
    constexpr std::size_t kMost = 6;
    std::optional<PictureStart> best;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      if (!used[i]) continue;
      const MirrorPicture& picture = pictures_[i];
      const auto poses = picture.near ? std::vector<Pose2>{*picture.near}
                                      : matched(picture, start_, kHardlyKnown, kMost);
      for (const Pose2& pose : poses) {
        const PictureStart found = start_from(picture, pose);
        if (!best || found.cost < best->cost) best = found;
      }
    }
    return best;
  }

  PictureStart start_from(const MirrorPicture& picture, const Pose2& pose) const {
    const std::vector<MirrorPicture> alone{picture};
    MirrorFit fit(field_, start_, alone, params_);
    fit.poses.push_back(pose);
    iterate(fit);
    PictureStart found{fit.change, fit.poses.front(), 0.0};
    const double worst = params_.gate * params_.gate;
    for (const MirrorPoint& point : picture.points) {
      const auto on = nearest_line(field_, point, fit.mount(), found.pose, fit.mirror_share);
      const double r = on ? on->residual.whitened() : params_.gate;
      found.cost += std::min(worst, r * r) / static_cast<double>(picture.points.size());
    }
    return found;
  }

  const FieldMap& field_;
  const MirrorMount& start_;
  const std::vector<MirrorPicture>& pictures_;
  const MirrorCalibrationParams& params_;
  std::optional<FieldModel> model_;
  std::optional<FieldMatcher> matcher_;
};

/// Leaves out the pictures of whose points too few lie on lines. Returns whether it did.
bool leave_out(const std::vector<MirrorPicture>& pictures, const MirrorCalibrationParams& params,
               MirrorFit& fit) {
  std::vector<int> on(pictures.size(), 0);
  for (const OnLine& point : fit.assigned()) ++on[point.picture];
  bool left = false;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto enough = std::max(static_cast<double>(params.min_points),
                                 params.min_share * static_cast<double>(pictures[i].points.size()));
    if (!fit.used[i] || static_cast<double>(on[i]) >= enough) continue;
    fit.used[i] = false;
    left = true;
  }
  return left;
}

/// Poses, points and residuals of the pictures, and the misfit.
void describe_residuals(const std::vector<MirrorPicture>& pictures, const MirrorFit& fit,
                        const std::vector<OnLine>& points, MirrorCalibration& out) {
  std::vector<double> squares_px(pictures.size(), 0.0);
  out.pictures.resize(pictures.size());
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    out.pictures[i].used = fit.used[i];
    out.pictures[i].pose = fit.poses[i];
    out.pictures[i].on.assign(pictures[i].points.size(), false);
  }
  double chi2 = 0.0;
  for (const OnLine& at : points) {
    const double r = at.residual.whitened();
    const double off_px = r * pictures[at.picture].points[at.point].sigma_px;
    out.pictures[at.picture].on[at.point] = true;
    squares_px[at.picture] += off_px * off_px;
    chi2 += r * r;
  }
  for (std::size_t i = 0; i < pictures.size(); ++i)
    out.pictures[i].rms_px = std::sqrt(squares_px[i] / std::max(1, out.pictures[i].points_on()));
  const auto count = static_cast<double>(points.size());
  const auto used = static_cast<double>(std::count(fit.used.begin(), fit.used.end(), true));
  const double freedom = count - 5.0 - 3.0 * used;
  out.misfit = chi2 / std::max(1.0, freedom);
  out.rms_px =
      std::sqrt(std::accumulate(squares_px.begin(), squares_px.end(), 0.0) / std::max(1.0, count));
}

}  // namespace

std::string_view to_string(MirrorParameter parameter) {
  constexpr std::array<std::string_view, kMirrorParameters> kNames{
      "focal", "u0", "v0", "tilt_x", "tilt_y", "xi", "height"};
  return kNames[static_cast<std::size_t>(parameter)];
}

MirrorMount changed(const MirrorMount& start, const MirrorVector& change) {
  MirrorMount out = start;
  out.mirror.px *= 1.0 + change[0];
  out.mirror.py *= 1.0 + change[0];
  out.mirror.u0 += change[1];
  out.mirror.v0 += change[2];
  out.rMc.rotate(Eigen::AngleAxisd(change[3], Eigen::Vector3d::UnitX()) *
                 Eigen::AngleAxisd(change[4], Eigen::Vector3d::UnitY()));
  out.mirror.xi = std::max(0.0, out.mirror.xi + change[5]);
  out.rMc.translation().z() += change[6];
  return out;
}

int MirrorPictureFit::points_on() const {
  return static_cast<int>(std::count(on.begin(), on.end(), true));
}

double MirrorCalibration::sigma(MirrorParameter parameter) const {
  const auto k = static_cast<Eigen::Index>(parameter);
  return std::sqrt(std::max(0.0, covariance(k, k)));
}

MirrorCalibration calibrate_mirror(const FieldMap& field, const MirrorMount& start,
                                   const std::vector<MirrorPicture>& pictures,
                                   const MirrorCalibrationParams& params) {
  MirrorCalibration out;
  out.mount = start;
  MirrorFit fit(field, start, pictures, params);
  if (!PicturePlacer(field, start, pictures, params).place(fit)) {
    describe_residuals(pictures, fit, {}, out);
    return out;
  }
  bool ended = iterate(fit);
  if (leave_out(pictures, params, fit)) ended = iterate(fit);
  const std::vector<OnLine> points = fit.assigned();
  describe_residuals(pictures, fit, points, out);
  out.mount = fit.mount();
  out.change = fit.change;
  if (points.empty()) return out;
  out.status = ended ? MirrorCalibrationStatus::converged : MirrorCalibrationStatus::not_converged;
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  fit.normal_equations(points, information, gradient);
  const Eigen::MatrixXd covariance =
      information.ldlt().solve(Eigen::MatrixXd::Identity(fit.unknowns(), fit.unknowns()));
  out.covariance =
      std::max(1.0, out.misfit) * covariance.topLeftCorner<kMirrorParameters, kMirrorParameters>();
  return out;
}

std::optional<FloorDistance> floor_distance(const MirrorCalibration& calibration,
                                            double radius_px) {
  MirrorMount level = calibration.mount;
  level.rMc.linear() = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  level.rMc.translation().head<2>().setZero();
  const auto distance = [&](const MirrorVector& by) -> std::optional<double> {
    const MirrorMount at = changed(level, by);
    // The middle and the tilt are no part of the function.
    const auto p = on_floor(at, {at.mirror.u0 + radius_px, at.mirror.v0});
    return p ? std::optional<double>(p->norm()) : std::nullopt;
  };
  const auto here = distance(MirrorVector::Zero());
  if (!here) return std::nullopt;
  MirrorVector slope = MirrorVector::Zero();
  for (const MirrorParameter k :
       {MirrorParameter::focal, MirrorParameter::xi, MirrorParameter::height}) {
    const auto i = static_cast<Eigen::Index>(k);
    const double step = kMirrorSteps[static_cast<std::size_t>(k)];
    const auto after = distance(step * MirrorVector::Unit(i));
    const auto before = distance(-step * MirrorVector::Unit(i));
    if (!after || !before) return std::nullopt;
    slope[i] = (*after - *before) / (2.0 * step);
  }
  return FloorDistance{*here, std::sqrt(slope.dot(calibration.covariance * slope))};
}

}  // namespace vigia::localization
