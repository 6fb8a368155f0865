#include "commands.hpp"
#include "mirror_option.hpp"
#include "mirror_pictures.hpp"
#include "usage_mistake.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/config.hpp"
#include "vigia/core/error.hpp"
#include "vigia/core/head.hpp"
#include "vigia/core/output_folder.hpp"
#include "vigia/localization/mirror_calibration.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;
using localization::MirrorCalibration;
using localization::MirrorParameter;

struct CalibrateOptions {
  std::vector<std::string> inputs;
  std::string field;
  double height_m = 0.0;
  double focal_px = 0.0;
  double xi = 1.0;
  double max_angle_deg = 105.0;
  bool mirrored = false;
  std::string mirror;
  std::vector<std::string> near;
  std::vector<std::string> free;
  double ray_step_deg = 3.0;
  std::string out;
  bool quiet = false;
};

/// The pictures' points and what was made of them.
struct CalibratedMirror {
  std::vector<MirrorView> views;
  std::vector<localization::MirrorPicture> pictures;
  MirrorCalibration calibration;
};

FieldMap read_field(const std::string& file) {
  MapReader reader(load_config(file), "field");
  return read_field_map(reader.map("field"));
}

std::vector<std::optional<Pose2>> parse_near(const CalibrateOptions& options, std::size_t count) {
  std::vector<std::optional<Pose2>> poses(count);
  if (!options.near.empty() && options.near.size() != count)
    throw InputError(
        fmt::format("--near: given {} times, but there are {} pictures: one for each, "
                    "in their order, or none",
                    options.near.size(), count));
  for (std::size_t i = 0; i < options.near.size(); ++i) {
    const auto n = parse_numbers(options.near[i], 3);
    if (!n)
      throw InputError(fmt::format("--near: found '{}', must be X,Y,HEADING, in m and degrees",
                                   options.near[i]));
    poses[i] = Pose2{(*n)[0], (*n)[1], wrap_angle(from_deg((*n)[2]))};
  }
  return poses;
}

/// The focal length whose mirror ends where the pictures' does.
double focal_by_edge(const CalibrateOptions& options, const std::vector<MirrorView>& views) {
  double radius = 0.0;
  for (const MirrorView& view : views) radius += view.mirror.outer_px;
  radius /= static_cast<double>(views.size());
  const double angle = from_deg(options.max_angle_deg);
  const double reach = std::cos(angle) + options.xi;
  if (!(reach > 0.0))
    throw InputError(
        fmt::format("--max-angle-deg {}: a mirror of xi {} shows no direction so far off its axis; "
                    "give less, or more of --xi",
                    options.max_angle_deg, options.xi));
  return radius * reach / std::sin(angle);
}

localization::MirrorMount start_mount(const CalibrateOptions& options,
                                      const std::vector<MirrorView>& views) {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const MirrorView& view : views)
    centre += view.mirror.centre / static_cast<double>(views.size());
  const double focal = options.focal_px > 0.0 ? options.focal_px : focal_by_edge(options, views);
  localization::MirrorMount mount;
  mount.mirror = {views.front().frame.width(),
                  views.front().frame.height(),
                  options.xi,
                  focal,
                  options.mirrored ? -focal : focal,
                  centre.x(),
                  centre.y(),
                  from_deg(options.max_angle_deg)};
  mount.rMc.linear() = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  mount.rMc.translation() = Eigen::Vector3d(0.0, 0.0, options.height_m);
  return mount;
}

localization::MirrorCalibrationParams calibration_params(const CalibrateOptions& options) {
  constexpr double kFreeXi = 0.5;
  constexpr double kFreeHeight = 0.5;  // of the height
  localization::MirrorCalibrationParams params;
  for (const std::string& name : options.free) {
    if (name == "xi") params.prior_sigma[static_cast<std::size_t>(MirrorParameter::xi)] = kFreeXi;
    if (name == "height")
      params.prior_sigma[static_cast<std::size_t>(MirrorParameter::height)] =
          kFreeHeight * options.height_m;
  }
  return params;
}

void take_points(double ray_step, const localization::MirrorMount* floor, double width_m,
                 CalibratedMirror& found) {
  for (std::size_t i = 0; i < found.views.size(); ++i)
    found.pictures[i].points = line_points(found.views[i], ray_step, floor, width_m);
}

/// First with all that looks like a line, then, as the floor is known, with what is as wide as one.
CalibratedMirror calibrate(const CalibrateOptions& options, const FieldMap& field) {
  CalibratedMirror found;
  found.views = read_mirror_views(options.inputs, parse_mirror(options.mirror));
  const auto near = parse_near(options, found.views.size());
  for (const auto& pose : near) found.pictures.push_back({{}, pose});
  const localization::MirrorMount start = start_mount(options, found.views);
  const auto params = calibration_params(options);
  const double step = from_deg(options.ray_step_deg);
  take_points(step, nullptr, 0.0, found);
  found.calibration = calibrate_mirror(field, start, found.pictures, params);
  const double width_m = field.lines.front().width_m;
  const bool one_width = std::all_of(field.lines.begin(), field.lines.end(),
                                     [&](const FieldLine& l) { return l.width_m == width_m; });
  if (found.calibration.status != localization::MirrorCalibrationStatus::converged || !one_width)
    return found;
  for (std::size_t i = 0; i < found.pictures.size(); ++i)
    if (found.calibration.pictures[i].used)
      found.pictures[i].near = found.calibration.pictures[i].pose;
  take_points(step, &found.calibration.mount, width_m, found);
  found.calibration = calibrate_mirror(field, start, found.pictures, params);
  return found;
}

/// A parameter's name, value at the start, value, σ (0: it was known), and σ before.
struct ParameterRow {
  std::string name;
  double start = 0.0;
  double estimate = 0.0;
  double sigma = 0.0;
  double prior_sigma = 0.0;
};

std::vector<ParameterRow> parameter_rows(const CalibrateOptions& options,
                                         const MirrorCalibration& calibration) {
  const auto params = calibration_params(options);
  const auto& mirror = calibration.mount.mirror;
  const double focal = mirror.px / (1.0 + calibration.change[0]);
  const auto row = [&](MirrorParameter of, const std::string& name, double value, double unit) {
    const auto k = static_cast<std::size_t>(of);
    const double change = calibration.change[static_cast<Eigen::Index>(k)];
    const double prior = params.prior_sigma[k];
    const double sigma = prior > 0.0 ? calibration.sigma(of) : 0.0;
    return ParameterRow{name, value - unit * change, value, unit * sigma, unit * prior};
  };
  const double degree = to_deg(1.0);
  const auto tilt = [&](MirrorParameter of) {
    return degree * calibration.change[static_cast<Eigen::Index>(of)];
  };
  return {row(MirrorParameter::focal, "focal_px", mirror.px, focal),
          row(MirrorParameter::u0, "u0_px", mirror.u0, 1.0),
          row(MirrorParameter::v0, "v0_px", mirror.v0, 1.0),
          row(MirrorParameter::tilt_x, "tilt_x_deg", tilt(MirrorParameter::tilt_x), degree),
          row(MirrorParameter::tilt_y, "tilt_y_deg", tilt(MirrorParameter::tilt_y), degree),
          row(MirrorParameter::xi, "xi", mirror.xi, 1.0),
          row(MirrorParameter::height, "height_m", calibration.mount.rMc.translation().z(), 1.0)};
}

std::string parameters_csv(const std::vector<ParameterRow>& rows) {
  std::string text = "parameter,start,estimate,sigma\n";
  for (const ParameterRow& row : rows)
    text += fmt::format("{},{:.6g},{:.6f},{}\n", row.name, row.start, row.estimate,
                        row.sigma > 0.0 ? fmt::format("{:.6f}", row.sigma) : "");
  return text;
}

std::string covariance_csv(const MirrorCalibration& calibration) {
  std::string text = "parameter";
  for (std::size_t k = 0; k < localization::kMirrorParameters; ++k)
    text += fmt::format(",{}", to_string(static_cast<MirrorParameter>(k)));
  text += '\n';
  for (std::size_t k = 0; k < localization::kMirrorParameters; ++k) {
    text += to_string(static_cast<MirrorParameter>(k));
    for (std::size_t l = 0; l < localization::kMirrorParameters; ++l)
      text += fmt::format(",{:.6e}", calibration.covariance(static_cast<Eigen::Index>(k),
                                                            static_cast<Eigen::Index>(l)));
    text += '\n';
  }
  return text;
}

std::string pictures_csv(const CalibratedMirror& found) {
  std::string text = "image,used,x_m,y_m,heading_deg,points,on_lines,rms_px\n";
  for (std::size_t i = 0; i < found.views.size(); ++i) {
    const auto& fit = found.calibration.pictures[i];
    text += fmt::format("{},{},{:.4f},{:.4f},{:.3f},{},{},{:.3f}\n", found.views[i].name,
                        fit.used ? 1 : 0, fit.pose.x, fit.pose.y, to_deg(fit.pose.theta),
                        fit.on.size(), fit.points_on(), fit.rms_px);
  }
  return text;
}

std::string distance_csv(const MirrorCalibration& calibration) {
  std::string text = "radius_px,distance_m,sigma_m\n";
  for (int r = 0;; ++r) {
    const auto distance = floor_distance(calibration, r);
    if (!distance) return text;
    text += fmt::format("{},{:.5f},{:.5f}\n", r, distance->distance_m, distance->sigma_m);
  }
}

/// Roll, pitch and yaw of a robot file's fixed mount, degrees.
Eigen::Vector3d rpy_deg(const Eigen::Isometry3d& rMc) {
  const Eigen::Matrix3d turn = rMc.linear() * head_from_camera().transpose();
  const double pitch = std::asin(std::clamp(-turn(2, 0), -1.0, 1.0));
  // Straight up or down roll and yaw are one turn.
  if (std::cos(pitch) < 1e-6)
    return {0.0, to_deg(pitch), to_deg(std::atan2(-turn(0, 1), turn(1, 1)))};
  return {to_deg(std::atan2(turn(2, 1), turn(2, 2))), to_deg(pitch),
          to_deg(std::atan2(turn(1, 0), turn(0, 0)))};
}

/// The camera's keys in a robot file.
std::string camera_yaml(const localization::MirrorMount& mount) {
  const UnifiedOmni& m = mount.mirror;
  const Eigen::Vector3d turn = rpy_deg(mount.rMc);
  const Eigen::Vector3d at = mount.rMc.translation();
  return fmt::format(
      "version: 1\ncameras:\n  - optics: omni\n    width_px: {}\n    height_px: {}\n"
      "    u0_px: {:.4f}\n    v0_px: {:.4f}\n    xi: {:.6f}\n    focal_px: {:.4f}\n"
      "    mirrored: {}\n    max_angle_deg: {:.3f}\n    mount: fixed\n"
      "    mount_m: [{:.5f}, {:.5f}, {:.5f}]\n    rpy_deg: [{:.6f}, {:.6f}, {:.6f}]\n",
      m.width, m.height, m.u0, m.v0, m.xi, m.px, m.py < 0.0, to_deg(m.max_angle), at.x(), at.y(),
      at.z(), turn.x(), turn.y(), turn.z());
}

void write_overlays(const CalibratedMirror& found, const FieldMap& field,
                    const OutputFolder& folder) {
  folder.make("overlay");
  for (std::size_t i = 0; i < found.views.size(); ++i) {
    const auto& fit = found.calibration.pictures[i];
    if (!fit.used) continue;
    imaging::write_png(
        folder.staging() / "overlay" /
            fmt::format("{:05}_{}.png", i + 1, fs::path(found.views[i].name).stem().string()),
        mirror_overlay(found.views[i], field, found.calibration.mount, fit.pose,
                       found.pictures[i].points, fit.on));
  }
}

void write_folder(const CalibratedMirror& found, const FieldMap& field,
                  const std::vector<ParameterRow>& rows, const std::string& path) {
  OutputFolder folder(path, "calibration.csv");
  folder.add("calibration.csv", parameters_csv(rows));
  folder.add("covariance.csv", covariance_csv(found.calibration));
  folder.add("pictures.csv", pictures_csv(found));
  folder.add("distance.csv", distance_csv(found.calibration));
  folder.add("camera.yaml", camera_yaml(found.calibration.mount));
  write_overlays(found, field, folder);
  folder.commit();
}

void say_how_well(const CalibratedMirror& found, const std::vector<ParameterRow>& rows) {
  constexpr double kUntold = 0.5;  // of the σ before
  int used = 0;
  int on = 0;
  std::size_t points = 0;
  for (std::size_t i = 0; i < found.views.size(); ++i) {
    const auto& fit = found.calibration.pictures[i];
    used += fit.used ? 1 : 0;
    on += fit.points_on();
    points += fit.on.size();
    if (!fit.used)
      fmt::print(stderr, "{}: left out: {} of its {} points lie on the field's lines\n",
                 found.views[i].name, fit.points_on(), fit.on.size());
  }
  fmt::print(stderr, "{} of {} pictures, {} of {} points on lines, {:.3f} px rms, misfit {:.2f}\n",
             used, found.views.size(), on, points, found.calibration.rms_px,
             found.calibration.misfit);
  for (const ParameterRow& row : rows)
    if (row.sigma > kUntold * row.prior_sigma)
      fmt::print(stderr, "{}: the pictures hardly tell it (σ {:.3g}, before {:.3g})\n", row.name,
                 row.sigma, row.prior_sigma);
}

int calibrate_omni(const CalibrateOptions& options) {
  const FieldMap field = read_field(options.field);
  if (field.lines.empty()) throw InputError(options.field + ": the field has no lines");
  const CalibratedMirror found = calibrate(options, field);
  const std::vector<ParameterRow> rows = parameter_rows(options, found.calibration);
  const bool converged =
      found.calibration.status == localization::MirrorCalibrationStatus::converged;
  if (!options.quiet) say_how_well(found, rows);
  if (!converged) {
    fmt::print(stderr, "not calibrated: {}\n",
               found.calibration.status == localization::MirrorCalibrationStatus::no_picture
                   ? "no picture's points match the field's lines; --near says where it was taken"
                   : "the estimate does not come to rest; a better --focal-px or --near may help");
    return 1;
  }
  fmt::print("{}", parameters_csv(rows));
  if (!options.out.empty()) write_folder(found, field, rows, options.out);
  return 0;
}

void add_start(CLI::App& command, CalibrateOptions& options) {
  command.add_option("--height", options.height_m, "Of the mirror's focus over the floor, m")
      ->check(CLI::Range(0.01, 10.0))
      ->required();
  command
      .add_option("--focal-px", options.focal_px,
                  "Where the estimate starts, px (default: by the mirror's edge)")
      ->check(CLI::Range(1.0, 1e5));
  command.add_option("--xi", options.xi, "Of the unified model: 1 a parabolic mirror")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command.add_option("--max-angle-deg", options.max_angle_deg, "The mirror's edge, off its axis")
      ->check(CLI::Range(1.0, 179.0))
      ->capture_default_str();
  command.add_flag("--mirrored", options.mirrored, "The pictures are turned over, as a mirror's");
  command.add_option(
      "--mirror", options.mirror,
      "U,V,INNER,OUTER, the mirror's middle and the radii between which it shows the "
      "field, px; without it the mirror is looked for");
  command
      .add_option("--near", options.near,
                  "X,Y,HEADING (m, degrees), about where a picture was taken, once for each "
                  "(default: anywhere on the field)")
      ->allow_extra_args(false);
  command
      .add_option("--free", options.free,
                  "What is estimated beside focal length, middle and tilt: xi, height")
      ->check(one_of({"xi", "height"}))
      ->delimiter(',')
      ->allow_extra_args(false);
}

}  // namespace

void add_calibrate(CLI::App& app, int& status) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand("calibrate", "Calibrate a camera on the robot");
  command->require_subcommand(1);
  add_calibrate_ceiling(*command, status);
  CLI::App* omni = command->add_subcommand(
      "omni", "A mirror's focal length, middle and tilt by a field's lines or a target of rings");
  omni->add_option("inputs", options->inputs, "Pictures, folders, NAME%04d.png")->required();
  omni->add_option("--field", options->field, "The lines: a file with a field (YAML)")->required();
  add_start(*omni, *options);
  omni->add_option("--ray-step-deg", options->ray_step_deg, "From one ray to the next, degrees")
      ->check(CLI::Range(0.1, 90.0))
      ->capture_default_str();
  omni->add_option("--out", options->out,
                   "Folder for tables, the distance function, camera.yaml and overlay pictures");
  omni->add_flag("--quiet", options->quiet, "Only the table");
  omni->callback([options, &status] { status = calibrate_omni(*options); });
}

}  // namespace vigia::app
