#include "commands.hpp"
#include "usage_mistake.hpp"

#include <algorithm>
#include <cctype>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "vigia/core/error.hpp"
#include "vigia/core/output_folder.hpp"
#include "vigia/core/suggestion.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/picture_run.hpp"
#include "vigia/tracking/point_picture_run.hpp"
#include "vigia/tracking/trackers.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;

struct TrackOptions {
  std::string tracker = "disc";
  std::vector<std::string> inputs;
  std::string out;
  bool quiet = false;
};

bool has_ending(const fs::path& file, const std::vector<std::string>& endings) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

bool is_picture(const fs::path& file) {
  return has_ending(file, {".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".tif", ".tiff"});
}

bool is_video(const fs::path& file) {
  return has_ending(file, {".mp4", ".avi", ".mpg", ".mpeg", ".mkv", ".mov", ".webm"});
}

/// The pictures of a folder in the order of their names.
std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_picture(entry.path())) files.push_back(entry.path());
  if (files.empty()) throw InputError(folder.string() + ": no pictures in this folder");
  std::sort(files.begin(), files.end());
  return files;
}

/// One picture's part of the table and of the count.
struct PictureOutcome {
  std::string csv;
  int found = 0;
};

/// Discs or landmarks of points, followed from picture to picture.
class Pictures {
 public:
  explicit Pictures(const std::string& tracker) {
    if (find_name(tracking::trackers(), tracker)->make_points != nullptr)
      points_.emplace(tracker);
    else
      discs_.emplace(tracker);
  }

  std::string header() const {
    return discs_ ? tracking::picture_csv_header() : tracking::point_csv_header();
  }
  const char* things() const { return discs_ ? "discs" : "landmarks"; }

  /// Draws into @p overlay unless it is null.
  PictureOutcome next(const fs::path& name, const imaging::ImageFrame& picture,
                      vpImage<vpRGBa>* overlay) {
    return discs_ ? next_of(*discs_, name, picture, overlay)
                  : next_of(*points_, name, picture, overlay);
  }

 private:
  static std::string lines(const tracking::PointPictureResult& result) {
    return tracking::point_csv_lines(result);
  }
  static std::string lines(const tracking::PictureResult& result) {
    std::string text;
    for (const auto& row : result.rows) text += tracking::picture_csv_line(row) + "\n";
    return text;
  }

  template <typename Run>
  static PictureOutcome next_of(Run& run, const fs::path& name, const imaging::ImageFrame& picture,
                                vpImage<vpRGBa>* overlay) {
    const auto result = run.next(name, picture);
    if (overlay != nullptr) tracking::draw_overlay(result, *overlay);
    const auto found = std::count_if(result.rows.begin(), result.rows.end(), [](const auto& row) {
      return row.feature.status == tracking::FeatureStatus::found;
    });
    return {lines(result), static_cast<int>(found)};
  }

  std::optional<tracking::PictureRun> discs_;
  std::optional<tracking::PointPictureRun> points_;
};

/// Runs the tracker and collects the table and, when asked for, the overlay pictures.
class TrackRun {
 public:
  explicit TrackRun(const TrackOptions& options) : run_(options.tracker) {
    if (options.out.empty()) return;
    folder_.emplace(options.out, "track.csv");
    folder_->make("overlay");
  }

  void picture(const fs::path& name, const imaging::ImageFrame& picture) {
    auto overlay = folder_ ? imaging::colour_image(picture) : vpImage<vpRGBa>();
    const PictureOutcome outcome = run_.next(name, picture, folder_ ? &overlay : nullptr);
    ++pictures_;
    csv_ += outcome.csv;
    found_ += outcome.found;
    if (!folder_) return;
    imaging::write_png(folder_->staging() / "overlay" /
                           fmt::format("{:05}_{}.png", pictures_, name.stem().string()),
                       overlay);
  }

  void video(const fs::path& file) {
    cv::VideoCapture capture(file.string());
    if (!capture.isOpened()) throw InputError(file.string() + ": no video that can be read");
    cv::Mat bgr;
    int number = 0;
    while (capture.read(bgr)) {
      vpImage<vpRGBa> image(static_cast<unsigned>(bgr.rows), static_cast<unsigned>(bgr.cols));
      cv::Mat rgba(bgr.rows, bgr.cols, CV_8UC4, image.bitmap);
      cv::cvtColor(bgr, rgba, cv::COLOR_BGR2RGBA);
      picture(fmt::format("{}#{:05}", file.stem().string(), ++number),
              imaging::ImageFrame(std::move(image)));
    }
    if (number == 0) throw InputError(file.string() + ": a video without a picture");
  }

  /// Writes what was collected; the table goes to stdout as well.
  void finish(bool quiet) {
    const std::string table = run_.header() + "\n" + csv_;
    fmt::print("{}", table);
    if (folder_) {
      folder_->add("track.csv", table);
      folder_->commit();
    }
    if (!quiet)
      fmt::print(stderr, "{} {} found in {} pictures\n", found_, run_.things(), pictures_);
  }

  int found() const { return found_; }

 private:
  Pictures run_;
  std::optional<OutputFolder> folder_;
  std::string csv_;
  int pictures_ = 0;
  int found_ = 0;
};

int track(const TrackOptions& options) {
  TrackRun run(options);
  for (const auto& text : options.inputs) {
    const fs::path input(text);
    if (fs::is_directory(input)) {
      for (const auto& file : pictures_in(input)) run.picture(file, imaging::read_image(file));
    } else if (is_video(input)) {
      run.video(input);
    } else {
      run.picture(input, imaging::read_image(input));
    }
  }
  run.finish(options.quiet);
  return run.found() > 0 ? 0 : 1;
}

}  // namespace

void add_track(CLI::App& app, int& status) {
  auto options = std::make_shared<TrackOptions>();
  CLI::App* command = app.add_subcommand("track", "Run a tracker on real pictures or a video");
  const auto trackers = names_of(tracking::trackers());
  command->add_option("--tracker", options->tracker, joined(trackers))
      ->check(one_of(trackers))
      ->capture_default_str();
  command->add_option("inputs", options->inputs, "Pictures, folders of pictures, or a video")
      ->required();
  command->add_option("--out", options->out, "Folder for track.csv and the overlay pictures");
  command->add_flag("--quiet", options->quiet, "Only the table");
  command->callback([options, &status] { status = track(*options); });
}

}  // namespace vigia::app
