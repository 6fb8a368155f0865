#include "drive_layer.hpp"

#include "map_marks.hpp"
#include "travel.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>

namespace vigia::report {
namespace {

constexpr double kHalo = 2.5;  // round labels

std::vector<Eigen::Vector2d> positions(const std::vector<Pose2>& poses) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(poses.size());
  for (const Pose2& pose : poses) points.push_back(pose.position());
  return points;
}

std::vector<Eigen::Vector2d> positions(const std::vector<MapPose>& poses) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(poses.size());
  for (const MapPose& each : poses) points.push_back(each.pose.position());
  return points;
}

// The instants nearest to every metre of travel, the first metre first.
std::vector<std::size_t> every_metre(const MapDrive& drive) {
  std::vector<std::size_t> instants;
  const std::vector<double> travelled = travelled_m(drive);
  for (std::size_t i = 0; i < travelled.size(); ++i)
    if (travelled[i] >= static_cast<double>(instants.size()) + 1.0) instants.push_back(i);
  return instants;
}

double largest_semi_axis_m(const MapDrive& drive) {
  double largest = 0.0;
  for (const std::size_t i : every_metre(drive))
    largest = std::max(largest, position_sigma_m(drive.estimate[i].covariance));
  return largest * std::sqrt(kChi2At95);
}

void draw_sight_lines(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                      const DriveStyle& style) {
  for (const MapLook& look : drive.looks) {
    const Landmark* landmark = drive.world.landmarks.find(look.landmark);
    if (landmark == nullptr) continue;
    const Colour colour = landmark_colour(drive.world.landmarks, look.landmark);
    sheet.line(view(look.from), view(drive.world.in_plan(*landmark)),
               {colour.with_alpha(0.8), style.sight_width,
                look.fused ? std::vector<double>{} : style.unfused_dashes});
  }
}

void draw_cut_line(const Sheet& sheet, const MapView& view, const CutLine& line,
                   const Stroke& driven, const Stroke& jump) {
  for (const auto& piece : line.pieces) {
    sheet.polyline(view(piece));
    sheet.stroke(driven);
  }
  for (const auto& [from, to] : line.jumps) sheet.line(view(from), view(to), jump);
}

void draw_paths(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                const DriveStyle& style) {
  sheet.polyline(view(positions(drive.odometry)));
  sheet.stroke(style.odometry);
  draw_cut_line(sheet, view, cut_where_far(positions(drive.estimate)), style.estimate,
                style.correction);
  sheet.polyline(view(drive.planned.points()));
  sheet.stroke(style.planned);
}

void draw_ellipses(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                   const DriveStyle& style) {
  if (drive.estimate.empty()) return;
  const double k = ellipse_scale(drive) * std::sqrt(kChi2At95);
  for (const std::size_t i : every_metre(drive)) {
    const MapPose& at = drive.estimate[i];
    const auto outline =
        view(ellipse_outline(at.pose.position(), at.covariance.topLeftCorner<2, 2>(), k));
    sheet.polyline(outline, true);
    sheet.fill(style.ellipse.colour.with_alpha(style.ellipse_fill));
    sheet.polyline(outline, true);
    sheet.stroke(style.ellipse);
  }
}

// A chevron along the direction of travel in the middle of every second metre.
void draw_arrows(const Sheet& sheet, const MapView& view, const MapDrive& drive) {
  const std::vector<Pose2>& truth = drive.truth;
  const std::vector<double> travelled = travelled_m(drive);
  double next = 0.5;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    if (travelled[i] < next) continue;
    next += 2.0;
    const Eigen::Vector2d along = truth[i].position() - truth[i - 1].position();
    const Eigen::Vector2d u = Eigen::Vector2d(along.x(), -along.y()).normalized();
    draw_chevron(sheet, view(truth[i].position()), u, 5.5, 2.4);
  }
}

void draw_robot(const Sheet& sheet, const MapView& view, const Pose2& pose, double radius_m,
                Colour colour) {
  const Eigen::Vector2d centre = view(pose.position());
  const double radius = std::max(6.0, radius_m * view.scale);
  const Eigen::Vector2d nose(std::cos(pose.theta), -std::sin(pose.theta));
  sheet.circle(centre, radius);
  sheet.fill(colour.with_alpha(0.15));
  sheet.circle(centre, radius);
  sheet.stroke({colour, 2.2});
  sheet.line(centre, centre + radius * nose, {colour, 2.2});
}

void draw_landmarks(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                    LabelPlacer& labels) {
  for (const Landmark& landmark : drive.world.landmarks.all()) {
    draw_landmark(sheet, view, drive.world, landmark,
                  landmark_colour(drive.world.landmarks, landmark.id));
    block_disc(labels, view(drive.world.in_plan(landmark)), 9.0);
  }
  for (const Landmark& landmark : drive.world.landmarks.all()) {
    const Eigen::Vector2d behind(-landmark.normal_w().x(), landmark.normal_w().y());
    const double gap = 4.0 + std::max(7.0, disc_radius(landmark).value_or(0.0) * view.scale);
    draw_tag(sheet, labels, "L" + std::to_string(landmark.id), view(drive.world.in_plan(landmark)),
             gap, behind, {17.0, true}, palette::kInk, kHalo);
  }
}

void draw_rings(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                const DriveStyle& style) {
  if (drive.look_ring_m <= 0.0) return;
  for (const MapLook& look : drive.looks) {
    if (!look.fused) continue;
    sheet.circle(view(look.from), drive.look_ring_m * view.scale);
    sheet.stroke(style.ring);
  }
}

void draw_looks(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                LabelPlacer& labels) {
  constexpr double kRadius = 5.0;
  for (const MapLook& look : drive.looks) block_disc(labels, view(look.from), kRadius);
  int number = 0;
  for (const MapLook& look : drive.looks) {
    const Eigen::Vector2d at = view(look.from);
    const Colour colour = landmark_colour(drive.world.landmarks, look.landmark);
    sheet.circle(at, kRadius);
    sheet.fill(look.fused ? colour : palette::kWhite);
    sheet.circle(at, kRadius);
    sheet.stroke({palette::kInk, 1.3});
    draw_tag(sheet, labels, std::to_string(++number), at, 8.0, {0.0, -1.0}, {13.0}, palette::kInk,
             kHalo);
  }
}

// Chevrons in the middle of the jumps say whither.
void draw_jumps(const Sheet& sheet, const MapView& view, const MapDrive& drive) {
  for (const auto& [from, to] : cut_at(positions(drive.truth), drive.jumps).jumps) {
    const Eigen::Vector2d along = view(to) - view(from);
    if (along.norm() > 0.0)
      draw_chevron(sheet, view(from) + 0.5 * along, along.normalized(), 5.5, 2.4);
  }
}

void draw_marks(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                LabelPlacer& labels) {
  constexpr double kHalf = 4.5;
  for (const MapMark& mark : drive.marks) {
    const Eigen::Vector2d at = view(drive.truth[mark.instant].position());
    const Colour colour = mark.grave ? palette::kVermillion : palette::kInk;
    sheet.rectangle({at.x() - kHalf, at.y() - kHalf, 2.0 * kHalf, 2.0 * kHalf});
    sheet.fill(colour);
    sheet.rectangle({at.x() - kHalf, at.y() - kHalf, 2.0 * kHalf, 2.0 * kHalf});
    sheet.stroke({palette::kWhite, 1.2});
    block_disc(labels, at, kHalf);
    draw_tag(sheet, labels, mark.text, at, 9.0, {1.0, 0.0}, {13.0, true}, colour, kHalo);
  }
}

void draw_ends(const Sheet& sheet, const MapView& view, const MapDrive& drive,
               LabelPlacer& labels) {
  if (drive.truth.empty()) return;
  const double gap = drive.robot_radius_m * view.scale + 4.0;
  const Eigen::Vector2d start = view(drive.truth.front().position());
  draw_robot(sheet, view, drive.truth.front(), drive.robot_radius_m, palette::kInk);
  draw_tag(sheet, labels, "start", start, gap, {0.0, 1.0}, {15.0, true}, palette::kInk, kHalo);
  draw_robot(sheet, view, drive.truth.back(), drive.robot_radius_m, palette::kInk);
  draw_tag(sheet, labels, "end", view(drive.truth.back().position()), gap, {0.0, 1.0}, {15.0, true},
           palette::kInk, kHalo);
  if (drive.planned.empty()) return;
  const Eigen::Vector2d goal = view(drive.planned.points().back());
  for (const double turn : {-1.0, 1.0})
    sheet.line(goal + Eigen::Vector2d(-8.0, -8.0 * turn), goal + Eigen::Vector2d(8.0, 8.0 * turn),
               {palette::kVermillion, 3.5});
  draw_tag(sheet, labels, "goal", goal, gap, {1.0, 0.0}, {15.0, true}, palette::kVermillion, kHalo);
}

void avoid_paths(LabelPlacer& labels, const MapView& view, const MapDrive& drive) {
  constexpr double kSpacing = 6.0;
  for (const auto& path :
       {positions(drive.truth), positions(drive.odometry), drive.planned.points()}) {
    Eigen::Vector2d last(-1e9, -1e9);
    for (const Eigen::Vector2d& p : view(path)) {
      if ((p - last).norm() < kSpacing) continue;
      labels.avoid(p);
      last = p;
    }
  }
}

}  // namespace

double ellipse_scale(const MapDrive& drive) {
  if (drive.ellipse_scale > 0.0) return drive.ellipse_scale;
  constexpr double kWanted_m = 0.5;
  const double largest = drive.estimate.empty() ? 0.0 : largest_semi_axis_m(drive);
  double chosen = 1.0;
  for (const double scale : {2.0, 5.0, 10.0, 20.0, 50.0})
    if (scale * largest <= kWanted_m && largest > 0.0) chosen = scale;
  return chosen;
}

std::vector<Eigen::Vector2d> ellipse_outline(const Eigen::Vector2d& p,
                                             const Eigen::Matrix2d& covariance, double k) {
  constexpr int kPoints = 64;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector2d axes = k * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2.0 * M_PI * i / kPoints;
    outline.emplace_back(p + solver.eigenvectors() *
                                 Eigen::Vector2d(axes.x() * std::cos(t), axes.y() * std::sin(t)));
  }
  return outline;
}

void draw_drive(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                const DriveStyle& style) {
  const Sheet::Clip clip = sheet.clip(view.box());
  LabelPlacer labels(view.box());
  avoid_paths(labels, view, drive);
  draw_sight_lines(sheet, view, drive, style);
  draw_cut_line(sheet, view, cut_at(positions(drive.truth), drive.jumps), style.truth,
                style.kidnapping);
  draw_ellipses(sheet, view, drive, style);
  draw_paths(sheet, view, drive, style);
  draw_arrows(sheet, view, drive);
  draw_jumps(sheet, view, drive);
  draw_rings(sheet, view, drive, style);
  draw_landmarks(sheet, view, drive, labels);
  draw_ends(sheet, view, drive, labels);
  draw_marks(sheet, view, drive, labels);
  draw_looks(sheet, view, drive, labels);
}

}  // namespace vigia::report
