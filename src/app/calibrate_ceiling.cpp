#include "ceiling_options.hpp"
#include "commands.hpp"
#include "usage_mistake.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/error.hpp"
#include "vigia/core/output_folder.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/imaging/picture_source.hpp"
#include "vigia/perception/ceiling_calibration.hpp"

namespace vigia::app {
namespace {

struct CeilingCalibrationOptions {
  std::vector<std::string> inputs;
  std::string camera;
  CeilingOptions ceiling;
  std::string out;
  bool quiet = false;
};

/// What a drive's pictures came to.
struct CeilingDriveCount {
  int pictures = 0;
  int fused = 0;
  int contradictory = 0;
  std::size_t patches = 0;
};

CeilingDriveCount follow_pictures(const CeilingCalibrationOptions& options,
                                  const Intrinsics& camera,
                                  perception::CeilingCalibration& calibration) {
  CeilingDriveCount count;
  for (const std::string& input : options.inputs) {
    const auto source = imaging::open_pictures(input);
    while (const auto picture = source->next()) {
      const imaging::Frame& frame = *picture->frame;
      if (frame.width() != camera.width || frame.height() != camera.height)
        throw InputError(fmt::format("{}: {}×{} pixels, but --camera is calibrated for {}×{}",
                                     picture->name, frame.width(), frame.height(), camera.width,
                                     camera.height));
      ++count.pictures;
      const double time_s = picture->time_s.value_or(count.pictures / options.ceiling.rate_hz);
      const auto step = calibration.next(imaging::grey_image(frame), Stamp::from_seconds(time_s));
      count.patches += step.scan.patches.size();
      count.fused += step.update == localization::CeilingUpdate::fused ? 1 : 0;
      count.contradictory += step.update == localization::CeilingUpdate::gated ? 1 : 0;
    }
  }
  return count;
}

/// Estimates with their σ.
std::string ceiling_parameters(const perception::CeilingCalibration::Result& found, double rise_m) {
  const localization::CeilingCameraErrors& errors = found.errors;
  const Eigen::Vector3d sigma = found.covariance.diagonal().cwiseSqrt();
  const double rise = rise_m * std::exp(errors.log_height);
  return fmt::format(
      "parameter,estimate,sigma\ntilt_x_deg,{:.5f},{:.5f}\ntilt_y_deg,{:.5f},{:.5f}\n"
      "rise_m,{:.6f},{:.6f}\n",
      to_deg(errors.tilt_x), to_deg(sigma[0]), to_deg(errors.tilt_y), to_deg(sigma[1]), rise,
      rise * sigma[2]);
}

std::string ceiling_covariance(const Eigen::Matrix3d& P) {
  const char* names[] = {"tilt_x_rad", "tilt_y_rad", "log_rise"};
  std::string text = "parameter,tilt_x_rad,tilt_y_rad,log_rise\n";
  for (int i = 0; i < 3; ++i)
    text += fmt::format("{},{:.6e},{:.6e},{:.6e}\n", names[i], P(i, 0), P(i, 1), P(i, 2));
  return text;
}

int calibrate_under_ceiling(const CeilingCalibrationOptions& options) {
  const perception::CeilingView view = ceiling_view(options.ceiling, options.camera);
  perception::CeilingCalibration calibration(view);
  const CeilingDriveCount count = follow_pictures(options, view.camera, calibration);
  if (!options.quiet)
    fmt::print(stderr,
               "{} pictures, {} patches, {} pictures fused, {} that contradict the others\n",
               count.pictures, count.patches, count.fused, count.contradictory);
  constexpr int kFewest = 3;
  if (count.fused < kFewest) {
    fmt::print(stderr,
               "not calibrated: {} pictures with patches that agree, fewer than {}; patches of "
               "another size than --rise-m and --patch-m say (by more than 10 %) are not seen\n",
               count.fused, kFewest);
    return 1;
  }
  const auto found = calibration.result();
  const std::string table = ceiling_parameters(found, view.rise_m);
  fmt::print("{}", table);
  if (options.out.empty()) return 0;
  OutputFolder folder(options.out, "calibration.csv");
  folder.add("calibration.csv", table);
  folder.add("covariance.csv", ceiling_covariance(found.covariance));
  folder.commit();
  return 0;
}

}  // namespace

void add_calibrate_ceiling(CLI::App& calibrate, int& status) {
  auto options = std::make_shared<CeilingCalibrationOptions>();
  options->ceiling.tilt_deg = 2.0;
  options->ceiling.height_percent = 5.0;
  CLI::App* ceiling = calibrate.add_subcommand(
      "ceiling", "The tilt of a camera that looks up and its distance to a ceiling of patches");
  ceiling->add_option("inputs", options->inputs, "Pictures, folders, videos of a drive, in order")
      ->required();
  ceiling->add_option("--camera", options->camera, "Calibrated camera (ViSP's XML, OpenCV's YAML)")
      ->required();
  add_ceiling_options(*ceiling, options->ceiling);
  ceiling->add_option("--out", options->out, "Folder for the tables");
  ceiling->add_flag("--quiet", options->quiet, "Only the table");
  ceiling->callback([options, &status] { status = calibrate_under_ceiling(*options); });
}

}  // namespace vigia::app
