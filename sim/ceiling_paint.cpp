#include "ceiling_paint.hpp"

#include "rays.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::sim {
namespace {

constexpr double kFarthest_m = 10.0;
constexpr double kLampLength_m = 1.2;
constexpr double kLampWidth_m = 0.2;
constexpr double kPipePiece_m = 2.0;
constexpr double kSeam_m = 0.02;  // by which pieces overlap
constexpr double kCollar_m = 0.06;
constexpr double kPipeSideGrey = 95.0;
constexpr double kPipeGrey = 150.0;
constexpr double kPipeShineGrey = 215.0;

/// Of the ceiling.
struct Rectangle {
  Eigen::Array2d min;
  Eigen::Array2d max;
};

/// What lies above the image's border. A camera that sees beyond it sees the ceiling as far as
/// kFarthest_m on that side.
Rectangle seen_part(double height_m, const Eigen::Isometry3d& wMc, const CameraModel& model) {
  const Eigen::Array2d below = wMc.translation().head<2>().array();
  const double rise = height_m - wMc.translation().z();
  Rectangle part{below, below};
  for (const double u : {-0.5, 0.5 * image_width(model), image_width(model) - 0.5}) {
    for (const double v : {-0.5, 0.5 * image_height(model), image_height(model) - 0.5}) {
      const Eigen::Vector3d r = wMc.linear() * point_ray(model, {u, v});
      Eigen::Array2d off = Eigen::Array2d::Constant(kFarthest_m);
      if (r.z() > 1e-3 * r.norm()) off = rise / r.z() * r.head<2>().array();
      off = off.min(kFarthest_m).max(-kFarthest_m);
      if (r.z() <= 1e-3 * r.norm()) part.min = part.min.min(below - off.abs());
      part.min = part.min.min(below + off);
      part.max = part.max.max(below + off);
    }
  }
  return part;
}

/// Frame of a mark at @p pose, seen from above, its z pointing down.
Eigen::Isometry3d hung(const Pose2& pose, double height_m, double forward_m) {
  Eigen::Isometry3d wMd = to_isometry(pose, height_m);
  wMd = wMd * Eigen::Translation3d(forward_m, 0.0, 0.0);
  wMd.linear() = wMd.linear() * Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  return wMd;
}

class MarkList {
 public:
  MarkList(const CeilingTruth& truth, double height_m, std::size_t surface)
      : truth_(truth), height_m_(height_m), surface_(surface) {}

  void add_patch(const Pose2& pose) {
    const CeilingGrid& grid = truth_.grid;
    if (!grid.polarity) return add(pose, 0.0, grid.length_m, grid.width_m, truth_.patch_grey);
    // The tongue's strip begins within the body, so that no seam shows between them.
    const double tongue = kTongueLength * grid.length_m;
    add(pose, -0.5 * tongue, grid.length_m - tongue, grid.width_m, truth_.patch_grey);
    add(pose, 0.25 * grid.length_m, 0.5 * grid.length_m, kTongueWidth * grid.width_m,
        truth_.patch_grey);
  }
  void add_lamp(const Eigen::Vector2d& p) {
    add({p.x(), p.y(), 0.0}, 0.0, kLampLength_m, kLampWidth_m, truth_.lamp_grey);
  }
  /// A piece of a pipe about @p p: round, so that it shines below and is dark at its sides; every
  /// piece has a collar.
  void add_pipe(const Eigen::Vector2d& p, double length_m) {
    const double z = height_m_ - truth_.pipe_drop_m;
    const double width = truth_.pipe_width_m;
    add({p.x(), p.y(), 0.0}, 0.0, length_m, width, kPipeSideGrey, z);
    add({p.x(), p.y(), 0.0}, 0.0, length_m, 0.7 * width, kPipeGrey, z);
    add({p.x(), p.y() + 0.1 * width, 0.0}, 0.0, length_m, 0.2 * width, kPipeShineGrey, z);
    add({p.x(), p.y(), 0.0}, 0.0, kCollar_m, 1.3 * width, kPipeSideGrey, z);
  }
  std::vector<StripeMark> take() { return std::move(marks_); }

 private:
  void add(const Pose2& pose, double forward_m, double length_m, double width_m, double grey) {
    add(pose, forward_m, length_m, width_m, grey, height_m_);
  }
  void add(const Pose2& pose, double forward_m, double length_m, double width_m, double grey,
           double height_m) {
    StripeMark& mark = marks_.emplace_back();
    mark.wMd = hung(pose, height_m, forward_m);
    mark.half_length_m = 0.5 * length_m;
    mark.half_width_m = 0.5 * width_m;
    mark.grey = static_cast<float>(grey);
    mark.surface = surface_;
  }

  const CeilingTruth& truth_;
  double height_m_;
  std::size_t surface_;
  std::vector<StripeMark> marks_;
};

/// First and last node of a grid of @p pitch_m that lies @p offset_m beside the origin.
std::pair<std::int64_t, std::int64_t> nodes(double low, double high, double pitch_m,
                                            double offset_m) {
  return {static_cast<std::int64_t>(std::ceil((low - offset_m) / pitch_m)),
          static_cast<std::int64_t>(std::floor((high - offset_m) / pitch_m))};
}

void add_lamps(const CeilingTruth& truth, const Rectangle& part, MarkList& list) {
  const double pitch = truth.lamp_pitch_m;
  if (pitch <= 0.0) return;
  const double aside = 0.5 * truth.grid.pitch_m;
  const auto [i0, i1] =
      nodes(part.min.x() - kLampLength_m, part.max.x() + kLampLength_m, pitch, aside);
  const auto [j0, j1] =
      nodes(part.min.y() - kLampLength_m, part.max.y() + kLampLength_m, pitch, aside);
  for (std::int64_t j = j0; j <= j1; ++j)
    for (std::int64_t i = i0; i <= i1; ++i)
      list.add_lamp(
          {aside + pitch * static_cast<double>(i), aside + pitch * static_cast<double>(j)});
}

/// Whoever is near a pipe sees less of it than of the ceiling: the same part holds.
void add_pipes(const CeilingTruth& truth, const Rectangle& part, MarkList& list) {
  const double pitch = truth.pipe_pitch_m;
  if (pitch <= 0.0) return;
  const double aside = 0.3 * truth.grid.pitch_m;
  const auto [i0, i1] =
      nodes(part.min.x() - kPipePiece_m, part.max.x() + kPipePiece_m, kPipePiece_m, 0.0);
  const auto [j0, j1] = nodes(part.min.y() - pitch, part.max.y() + pitch, pitch, aside);
  for (std::int64_t j = j0; j <= j1; ++j)
    for (std::int64_t i = i0; i <= i1; ++i)
      list.add_pipe({kPipePiece_m * static_cast<double>(i), aside + pitch * static_cast<double>(j)},
                    kPipePiece_m + kSeam_m);
}

}  // namespace

std::vector<StripeMark> ceiling_marks(const CeilingTruth& truth, double height_m,
                                      std::size_t surface, const Eigen::Isometry3d& wMc,
                                      const CameraModel& model) {
  if (wMc.translation().z() >= height_m) return {};
  const Rectangle part = seen_part(height_m, wMc, model);
  MarkList list(truth, height_m, surface);
  add_lamps(truth, part, list);
  const double reach =
      truth.grid.length_m + 5.0 * truth.grid.placement_m + 0.5 * truth.grid.pitch_m;
  const auto [i0, i1] = nodes(part.min.x() - reach, part.max.x() + reach, truth.grid.pitch_m, 0.0);
  const auto [j0, j1] = nodes(part.min.y() - reach, part.max.y() + reach, truth.grid.pitch_m, 0.0);
  for (std::int64_t j = j0; j <= j1; ++j) {
    for (std::int64_t i = i0; i <= i1; ++i) {
      if (const auto patch = true_patch(truth, {i, j})) list.add_patch(*patch);
      if (const auto patch = spurious_patch(truth, {i, j})) list.add_patch(*patch);
    }
  }
  add_pipes(truth, part, list);
  return list.take();
}

}  // namespace vigia::sim
