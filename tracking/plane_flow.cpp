#include "vigia/tracking/plane_flow.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "vigia/core/angle.hpp"
#include "vigia/core/median.hpp"

namespace vigia::tracking {
namespace {

constexpr int kFlowUnknowns = 5;  // shift x, y, turn, gain, offset
using FlowNormal = Eigen::Matrix<double, kFlowUnknowns, kFlowUnknowns>;
using FlowVector = Eigen::Matrix<double, kFlowUnknowns, 1>;

constexpr double kFlowBlur_px = 1.0;
constexpr int kFlowMargin_px = 4;
constexpr int kFlowSteps = 12;
constexpr int kCoarse = 4;          // pixels: σ and step of the search
constexpr int kSearchPoints = 300;  // that it goes by
constexpr int kSmall = 4;           // a picture is so many times smaller for the widest search
constexpr int kFarTurns = 3;        // to either side
constexpr double kFarTurn = from_deg(4.0);
constexpr double kFaintCorrelation = 0.5;
constexpr double kFaintResidual = 2.0;  // grey levels, of smoothed pictures
constexpr double kPlainlyAlike = 0.95;  // correlation of pictures that nobody need doubt
constexpr double kSaturated = 250.0;
constexpr double kMaxGain = 2.0;  // of the light from one picture to the other, either way

/// Grey and slope between pixels, linear.
struct GreySample {
  double grey;
  double du;
  double dv;
};
GreySample sample(const cv::Mat& image, double u, double v) {
  const int i = static_cast<int>(u);
  const int j = static_cast<int>(v);
  const double fu = u - i;
  const double fv = v - j;
  const auto* above = image.ptr<unsigned char>(j);
  const auto* below = image.ptr<unsigned char>(j + 1);
  const double a = above[i];
  const double b = above[i + 1];
  const double c = below[i];
  const double d = below[i + 1];
  const double top = a + fu * (b - a);
  const double bottom = c + fu * (d - c);
  return {top + fv * (bottom - top), (1.0 - fv) * (b - a) + fv * (d - c), bottom - top};
}

/// Of pairs of greys.
class GreyMoments {
 public:
  void add(double a, double b) {
    n_ += 1.0;
    a_ += a;
    b_ += b;
    aa_ += a * a;
    bb_ += b * b;
    ab_ += a * b;
  }
  double correlation() const {
    const double spread = (n_ * aa_ - a_ * a_) * (n_ * bb_ - b_ * b_);
    return spread > 0.0 ? (n_ * ab_ - a_ * b_) / std::sqrt(spread) : 0.0;
  }

 private:
  double n_ = 0.0;
  double a_ = 0.0;
  double b_ = 0.0;
  double aa_ = 0.0;
  double bb_ = 0.0;
  double ab_ = 0.0;
};

}  // namespace

class PlaneFlow::State {
 public:
  State(const CameraModel& model, const Eigen::Matrix3d& level, const PlaneFlowParams& params)
      : model_(model), level_(level), params_(params) {}

  PlaneFlowResult next(const vpImage<unsigned char>& image) {
    const cv::Mat grey(static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()),
                       CV_8U, image.bitmap);
    cv::Mat smooth;
    cv::GaussianBlur(grey, smooth, {}, kFlowBlur_px);
    PlaneFlowResult result;
    if (points_.empty()) {
      make_key(grey, smooth);
      result.new_key = true;
      result.status = points_.empty() ? FlowStatus::failed : FlowStatus::key;
      return result;
    }
    const Match match = best_match(grey, smooth);
    if (!agrees(match)) {
      make_key(grey, smooth);
      result.status = FlowStatus::failed;
      result.new_key = true;
      return result;
    }
    step_ = {rotated(match.state.shift - last_.shift, -last_.turn), match.state.turn - last_.turn};
    last_ = match.state;
    result = {FlowStatus::matched,
              {match.state.shift, wrap_angle(match.state.turn), match.covariance},
              false,
              match.agreement};
    if (match.overlap < params_.min_overlap) {
      make_key(grey, smooth);
      result.new_key = true;
    }
    return result;
  }

 private:
  /// A pixel of the key frame that the flow goes by.
  struct KeyPoint {
    Eigen::Vector2d m;  ///< levelled direction, (x, y) at unit distance
    double grey;
    double coarse;  ///< grey of the blurred picture that is searched
  };
  using Level = double KeyPoint::*;

  /// Turn and shift with the light's change.
  struct FlowState {
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
    double turn = 0.0;
    double gain = 1.0;
    double offset = 0.0;
  };
  struct Match {
    FlowState state;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
    double agreement = 0.0;
    double correlation = 0.0;  ///< of the greys of the two pictures
    double scale = 0.0;        ///< robust σ of the residuals, grey levels
    double overlap = 0.0;
    bool converged = false;
  };
  /// The last frame's motion, in its own frame.
  struct Step {
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
    double turn = 0.0;
  };

  static Eigen::Vector2d rotated(const Eigen::Vector2d& p, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {c * p.x() - s * p.y(), s * p.x() + c * p.y()};
  }

  /// From the prediction; where the pictures are not plainly alike there, of the searches too the
  /// one after which they are most alike.
  Match best_match(const cv::Mat& grey, const cv::Mat& smooth) const {
    Match best = align(smooth, predicted(), &KeyPoint::grey);
    for (const auto search : {&State::found_again, &State::found_far}) {
      if (agrees(best) && best.correlation >= kPlainlyAlike) return best;
      const Match other = align(smooth, (this->*search)(grey), &KeyPoint::grey);
      if (!agrees(best) || (agrees(other) && other.correlation > best.correlation)) best = other;
    }
    return best;
  }

  /// That most points fit by the residuals' own scale says nothing where the light's gain has gone
  /// to zero: the pictures must be alike, or where they show so little that noise counts, differ by
  /// hardly more than noise.
  bool agrees(const Match& match) const {
    const bool alike = match.correlation >= params_.min_correlation ||
                       (match.correlation >= kFaintCorrelation && match.scale <= kFaintResidual);
    return match.converged && match.agreement >= params_.min_agreement && alike &&
           match.state.gain < kMaxGain && match.state.gain > 1.0 / kMaxGain;
  }

  FlowState predicted() const {
    FlowState state = last_;
    state.shift += rotated(step_.shift, last_.turn);
    state.turn += step_.turn;
    return state;
  }

  static cv::Mat blurred(const cv::Mat& grey) {
    cv::Mat coarse;
    cv::GaussianBlur(grey, coarse, {}, kCoarse);
    return coarse;
  }

  void make_key(const cv::Mat& grey, const cv::Mat& smooth) {
    points_.clear();
    const cv::Mat coarse = blurred(grey);
    key_small_ = small(grey);
    last_ = {};
    const int block = params_.block_px;
    for (int v0 = kFlowMargin_px; v0 + block <= smooth.rows - kFlowMargin_px; v0 += block)
      for (int u0 = kFlowMargin_px; u0 + block <= smooth.cols - kFlowMargin_px; u0 += block)
        add_steepest(smooth, coarse, u0, v0);
    if (static_cast<int>(points_.size()) < params_.min_points) points_.clear();
  }

  void add_steepest(const cv::Mat& smooth, const cv::Mat& coarse, int u0, int v0) {
    int best = 0;
    int best_u = 0;
    int best_v = 0;
    for (int v = v0; v < v0 + params_.block_px; ++v) {
      const auto* above = smooth.ptr<unsigned char>(v - 1);
      const auto* row = smooth.ptr<unsigned char>(v);
      const auto* below = smooth.ptr<unsigned char>(v + 1);
      for (int u = u0; u < u0 + params_.block_px; ++u) {
        const int slope = std::abs(row[u + 1] - row[u - 1]) + std::abs(below[u] - above[u]);
        if (slope <= best) continue;
        best = slope;
        best_u = u;
        best_v = v;
      }
    }
    if (0.5 * best < params_.min_slope) return;
    if (smooth.ptr<unsigned char>(best_v)[best_u] >= kSaturated) return;
    const auto seen = ray(model_, Eigen::Vector2d(best_u, best_v));
    if (!seen) return;
    const Eigen::Vector3d r = level_ * *seen;
    if (r.z() < 0.1) return;
    points_.push_back({r.head<2>() / r.z(),
                       static_cast<double>(smooth.ptr<unsigned char>(best_v)[best_u]),
                       static_cast<double>(coarse.ptr<unsigned char>(best_v)[best_u])});
  }

  /// Gauss–Newton from @p start.
  Match align(const cv::Mat& now, const FlowState& start, Level level) const {
    Match match;
    match.state = start;
    double scale = 12.0;
    for (int i = 0; i < kFlowSteps; ++i) {
      const Sums sums = sum_up(now, match.state, scale, level);
      match.overlap = static_cast<double>(sums.seen) / static_cast<double>(points_.size());
      if (sums.seen < params_.min_points / 2) return match;
      match.agreement = static_cast<double>(sums.fitting) / sums.seen;
      match.correlation = sums.correlation;
      match.scale = sums.scale;
      scale = std::clamp(sums.scale, 1.5, 40.0);
      const Eigen::LDLT<FlowNormal> solver(sums.normal);
      const FlowVector step = solver.solve(sums.gradient);
      if (!step.allFinite()) return match;
      match.state.shift += step.head<2>();
      match.state.turn += step[2];
      match.state.gain += step[3];
      match.state.offset += step[4];
      const double variance = sums.square / std::max(1.0, sums.weight - kFlowUnknowns);
      match.covariance = variance * solver.solve(FlowNormal::Identity()).topLeftCorner<3, 3>();
      match.converged = step.head<3>().norm() < 2e-5;
      if (match.converged) return match;
    }
    return match;
  }

  struct Sums {
    FlowNormal normal = FlowNormal::Zero();
    FlowVector gradient = FlowVector::Zero();
    double square = 0.0;
    double weight = 0.0;
    double scale = 0.0;  ///< robust σ of the residuals
    double correlation = 0.0;
    int seen = 0;
    int fitting = 0;
  };

  Sums sum_up(const cv::Mat& now, const FlowState& state, double scale, Level level) const {
    Sums sums;
    const double c = std::cos(state.turn);
    const double s = std::sin(state.turn);
    const Eigen::Matrix3d unlevel = level_.transpose();
    std::vector<double> residuals;
    residuals.reserve(points_.size());
    GreyMoments greys;
    for (const KeyPoint& point : points_) {
      const Eigen::Vector2d d = point.m - state.shift;
      const Eigen::Vector2d m(c * d.x() + s * d.y(), c * d.y() - s * d.x());
      const Eigen::Vector3d p = unlevel * m.homogeneous();
      const auto uv = project(model_, p);
      if (!uv || !in_image(model_, *uv, kFlowMargin_px)) continue;
      const auto duv_dp = project_jacobian(model_, p);
      if (!duv_dp) continue;
      const GreySample grey = sample(now, uv->x(), uv->y());
      if (grey.grey >= kSaturated) continue;
      ++sums.seen;
      greys.add(point.*level, grey.grey);
      const double residual = state.gain * point.*level + state.offset - grey.grey;
      residuals.push_back(std::abs(residual));
      if (std::abs(residual) < 3.0 * scale) ++sums.fitting;
      Eigen::Matrix<double, 2, 3> dm;
      dm << -c, -s, m.y(), s, -c, -m.x();
      const Eigen::Matrix<double, 2, 3> duv = *duv_dp * unlevel.leftCols<2>() * dm;
      FlowVector row;
      row.head<3>() = Eigen::RowVector2d(grey.du, grey.dv) * duv;
      row[3] = -(point.*level);
      row[4] = -1.0;
      // Geman and McClure's weight.
      const double z = residual / (2.0 * scale);
      const double weight = 1.0 / ((1.0 + z * z) * (1.0 + z * z));
      sums.normal += weight * row * row.transpose();
      sums.gradient += weight * residual * row;
      sums.square += weight * residual * residual;
      sums.weight += weight;
    }
    if (!residuals.empty()) sums.scale = 1.4826 * median_of(residuals);
    sums.correlation = greys.correlation();
    return sums;
  }

  /// Where a fine match may begin when the prediction fails: searched and aligned in a blurred
  /// picture, whose basin is as wide as the search's steps.
  FlowState found_again(const cv::Mat& grey) const {
    const cv::Mat coarse = blurred(grey);
    return align(coarse, search(coarse), &KeyPoint::coarse).state;
  }

  static cv::Mat small(const cv::Mat& grey) {
    cv::Mat reduced;
    cv::resize(grey, reduced, {}, 1.0 / kSmall, 1.0 / kSmall, cv::INTER_AREA);
    reduced.convertTo(reduced, CV_32F);
    return reduced;
  }

  /// Further away, where the pictures overlap at all: of the picture turned back by several angles
  /// the highest peak of the phase correlation.
  FlowState found_far(const cv::Mat& grey) const {
    const cv::Mat now = small(grey);
    cv::Mat window;
    cv::createHanningWindow(window, now.size(), CV_32F);
    FlowState best;
    double highest = 0.0;
    for (int k = -kFarTurns; k <= kFarTurns; ++k) {
      FlowState state;
      state.turn = k * kFarTurn;
      const cv::Mat back = turned_back(now, state.turn);
      double peak = 0.0;
      const cv::Point2d moved = cv::phaseCorrelate(key_small_, back, window, &peak);
      if (peak <= highest) continue;
      highest = peak;
      state.shift =
          (level_ * Eigen::Vector3d(-moved.x, -moved.y, 0.0)).head<2>() * kSmall / focal();
      best = state;
    }
    return align(blurred(grey), best, &KeyPoint::coarse).state;
  }

  /// A small picture as the camera would have seen it without the turn.
  cv::Mat turned_back(const cv::Mat& picture, double turn) const {
    if (turn == 0.0) return picture;
    const auto axis = project(model_, Eigen::Vector3d(level_.transpose().col(2)));
    const Eigen::Vector2d middle =
        axis.value_or(Eigen::Vector2d(0.5 * kSmall * picture.cols, 0.5 * kSmall * picture.rows)) /
        kSmall;
    cv::Mat turned;
    // OpenCV's angle is against the picture's v; what is seen turns against the camera.
    const cv::Mat map = cv::getRotationMatrix2D(
        {static_cast<float>(middle.x()), static_cast<float>(middle.y())}, -to_deg(turn), 1.0);
    cv::warpAffine(picture, turned, map, picture.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    return turned;
  }

  /// The shift, about the last frame's, under which the pictures differ least, in steps of kCoarse
  /// pixels and of turns that move the image's border by as much.
  FlowState search(const cv::Mat& now) const {
    const double step = kCoarse / focal();
    const double turn_step = 2.0 * kCoarse / now.cols;
    const int reach = static_cast<int>(std::ceil(params_.max_search_px / kCoarse));
    FlowState best = last_;
    best.gain = 1.0;
    best.offset = 0.0;
    double least = 1e30;
    for (int k = -3; k <= 3; ++k) {
      for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
          FlowState state = last_;
          state.gain = 1.0;
          state.offset = 0.0;
          state.shift += rotated(Eigen::Vector2d(i * step, j * step), last_.turn);
          state.turn += k * turn_step;
          const double off = difference(now, state);
          if (off >= least) continue;
          least = off;
          best = state;
        }
      }
    }
    return best;
  }

  double difference(const cv::Mat& now, const FlowState& state) const {
    const double c = std::cos(state.turn);
    const double s = std::sin(state.turn);
    double sum = 0.0;
    int seen = 0;
    const std::size_t every = std::max<std::size_t>(1, points_.size() / kSearchPoints);
    for (std::size_t i = 0; i < points_.size(); i += every) {
      const Eigen::Vector2d d = points_[i].m - state.shift;
      const Eigen::Vector2d m(c * d.x() + s * d.y(), c * d.y() - s * d.x());
      const auto uv = project(model_, Eigen::Vector3d(level_.transpose() * m.homogeneous()));
      if (!uv || !in_image(model_, *uv, kFlowMargin_px)) continue;
      ++seen;
      const double off =
          state.gain * points_[i].coarse + state.offset - sample(now, uv->x(), uv->y()).grey;
      sum += std::min(std::abs(off), 40.0);
    }
    return seen < params_.min_points / 4 ? 1e30 : sum / seen;
  }

  double focal() const {
    if (const auto* pinhole = std::get_if<Intrinsics>(&model_)) return pinhole->px;
    return std::abs(std::get<UnifiedOmni>(model_).px);
  }

  CameraModel model_;
  Eigen::Matrix3d level_;
  PlaneFlowParams params_;
  std::vector<KeyPoint> points_;
  FlowState last_;
  Step step_;
  cv::Mat key_small_;
};

PlaneFlow::PlaneFlow(const CameraModel& model, const Eigen::Matrix3d& level,
                     const PlaneFlowParams& params)
    : state_(std::make_unique<State>(model, level, params)) {}
PlaneFlow::~PlaneFlow() = default;
PlaneFlow::PlaneFlow(PlaneFlow&&) noexcept = default;

PlaneFlowResult PlaneFlow::next(const vpImage<unsigned char>& image) {
  return state_->next(image);
}

namespace {

/// Motion from one of two frames to the other, both compared with one key frame.
ImageShift between(const ImageShift& before, const ImageShift& now) {
  ImageShift step;
  step.shift = Eigen::Rotation2Dd(-before.turn) * (now.shift - before.shift);
  step.turn = wrap_angle(now.turn - before.turn);
  step.covariance = before.covariance + now.covariance;
  return step;
}

ImageShift at_rest() {
  ImageShift none;
  none.covariance.setZero();
  return none;
}

}  // namespace

FrameFlow::FrameFlow(const CameraModel& model, const Eigen::Matrix3d& level,
                     const PlaneFlowParams& params)
    : flow_(model, level, params), since_key_(at_rest()) {}

std::optional<ImageShift> FrameFlow::next(const vpImage<unsigned char>& image) {
  const PlaneFlowResult result = flow_.next(image);
  agreement_ = result.agreement;
  std::optional<ImageShift> step;
  if (result.status == FlowStatus::matched) step = between(since_key_, result.since_key);
  since_key_ = result.new_key ? at_rest() : result.since_key;
  return step;
}

}  // namespace vigia::tracking
