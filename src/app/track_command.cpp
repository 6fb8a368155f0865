#include "ceiling_options.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "mirror_option.hpp"
#include "track_run.hpp"
#include "usage_mistake.hpp"

#include <charconv>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <omp.h>
#include <opencv2/core/utility.hpp>

#include "vigia/core/angle.hpp"
#include "vigia/core/camera_file.hpp"
#include "vigia/core/error.hpp"
#include "vigia/core/suggestion.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/tracking/trackers.hpp"

namespace vigia::app {
namespace {

struct TrackOptions {
  std::string tracker = "disc";
  std::vector<std::string> inputs;
  std::string polarity = "either";
  std::string radius_px;
  std::string ids;
  double min_score = 0.0;
  int every = 1;
  int expected = 0;
  int remember = 50;
  std::string mirror;
  double ray_step_deg = 3.0;
  std::string patch_px;
  CeilingOptions ceiling;
  std::string camera;
  std::string landmarks;
  double size_m = 0.0;
  double timeout_s = 10.0;
  int threads = 1;
  bool quiet = false;
  bool no_overlay = false;
  TrackOutput output;
};

bool tracks_points(const TrackOptions& options) {
  return find_name(tracking::trackers(), options.tracker)->make_points != nullptr;
}

/// A whole text as a number; nothing when it is none.
template <typename Number>
std::optional<Number> parsed(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (text.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

struct RadiusRange {
  double min_px = 3.0;
  double max_px = std::numeric_limits<double>::infinity();
};

tracking::Polarity parse_polarity(const std::string& text) {
  if (text == "dark") return tracking::Polarity::dark;
  if (text == "bright") return tracking::Polarity::bright;
  return tracking::Polarity::either;
}

/// A tag's number, or floor-room-pattern.
std::optional<tracking::LandmarkCode> parse_code(const std::string& text, bool tag) {
  if (tag) {
    const auto number = parsed<int>(text);
    if (!number || *number < 0) return std::nullopt;
    return *number;
  }
  const std::size_t first = text.find('-');
  const std::size_t second = text.find('-', first == std::string::npos ? first : first + 1);
  if (second == std::string::npos) return std::nullopt;
  const std::string_view view(text);
  const auto floor = parsed<int>(view.substr(0, first));
  const auto room = parsed<int>(view.substr(first + 1, second - first - 1));
  const auto pattern = parsed<int>(view.substr(second + 1));
  if (!floor || !room || !pattern) return std::nullopt;
  return PatternCode{*floor, *room, *pattern};
}

std::vector<tracking::LandmarkCode> parse_codes(const TrackOptions& options) {
  if (!options.ids.empty() && !tracks_points(options))
    throw InputError("--ids: discs have no codes; --tracker pattern and tag have");
  const bool tag = options.tracker == "tag";
  std::vector<tracking::LandmarkCode> codes;
  std::istringstream list(options.ids);
  for (std::string id; std::getline(list, id, ',');) {
    const auto code = parse_code(id, tag);
    if (!code)
      throw InputError(fmt::format("--ids: found '{}', must be {}", id,
                                   tag ? "the number of a tag" : "FLOOR-ROOM-PATTERN"));
    codes.push_back(*code);
  }
  return codes;
}

bool scans_field(const TrackOptions& options) {
  return options.tracker == "field_scan";
}

tracking::FieldPictureParams make_field_scan(const TrackOptions& options) {
  if (!options.ids.empty() || !options.radius_px.empty() || !options.camera.empty() ||
      options.size_m > 0.0 || !options.landmarks.empty())
    throw InputError(
        "--tracker field_scan: a field has no --ids, --radius-px, --camera, --size or "
        "--landmarks");
  tracking::FieldPictureParams params;
  params.mirror = parse_mirror(options.mirror);
  params.scan.ray_step = from_deg(options.ray_step_deg);
  return params;
}

RadiusRange parse_radius(const std::string& text) {
  if (text.empty()) return {};
  const auto range = parsed_pair(text);
  if (!range || !(range->first >= 3.0) || !(range->second >= range->first) ||
      !(range->second <= 1e5))
    throw InputError(
        fmt::format("--radius-px: found '{}', must be MIN:MAX, in pixels, with "
                    "3 ≤ MIN ≤ MAX ≤ 100000",
                    text));
  return {range->first, range->second};
}

bool follows_ceiling(const TrackOptions& options) {
  return options.tracker == "ceiling";
}

CeilingTrack make_ceiling(const TrackOptions& options) {
  if (!options.ids.empty() || !options.radius_px.empty() || options.size_m > 0.0 ||
      !options.landmarks.empty())
    throw InputError(
        "--tracker ceiling: patches have no --ids, --radius-px, --size or --landmarks");
  if (!options.camera.empty()) {
    if (!options.patch_px.empty())
      throw InputError("--patch-px: with --camera the size in pixels follows from --patch-m");
    return CeilingTrack(ceiling_view(options.ceiling, options.camera), options.ceiling.rate_hz);
  }
  if (options.ceiling.rise_m > 0.0 || !options.ceiling.patch_m.empty())
    throw InputError("--rise-m and --patch-m give poses only with --camera FILE");
  if (options.patch_px.empty())
    throw InputError(
        "--tracker ceiling: how large are the patches in the pictures? Give --patch-px "
        "LENGTH:WIDTH, or --camera FILE and --rise-m H");
  tracking::PatchFinderParams params;
  std::tie(params.length_px, params.width_px) =
      parse_patch("--patch-px", options.patch_px, 3.0, 1000.0);
  params.polarity = !options.ceiling.plain;
  return CeilingTrack(params);
}

void refuse_other_trackers_options(const TrackOptions& options) {
  if (!scans_field(options) && (!options.mirror.empty() || options.output.panorama))
    throw InputError("--mirror and --panorama: are for --tracker field_scan");
  if (!follows_ceiling(options) && (!options.patch_px.empty() || options.ceiling.given()))
    throw InputError(
        "--patch-px, --patch-m, --rise-m, --placement and --plain: are for --tracker ceiling");
}

TrackRun::Tracker make_tracker(const TrackOptions& options) {
  refuse_other_trackers_options(options);
  if (follows_ceiling(options)) return make_ceiling(options);
  if (scans_field(options)) return make_field_scan(options);
  const std::vector<tracking::LandmarkCode> codes = parse_codes(options);
  const RadiusRange radius = parse_radius(options.radius_px);
  if (tracks_points(options)) {
    if (!options.radius_px.empty())
      throw InputError("--radius-px: is for --tracker disc, ellipse and correlation");
    tracking::PointPictureRunParams params;
    params.tracker = options.tracker;
    params.known = codes;
    params.min_confidence = options.min_score;
    params.every = options.every;
    params.expected = options.expected;
    params.remember = options.remember;
    return tracking::PointPictureRun(params);
  }
  tracking::PictureRunParams params;
  params.tracker = options.tracker;
  params.polarity = parse_polarity(options.polarity);
  params.min_radius_px = radius.min_px;
  params.max_radius_px = radius.max_px;
  params.min_score = options.min_score;
  params.every = options.every;
  params.expected = options.expected;
  params.remember = options.remember;
  return tracking::PictureRun(params);
}

LandmarkMap read_landmarks(const std::string& file) {
  MapReader reader(load_config(file), "world");
  return read_world_map(reader).landmarks;
}

std::optional<LandmarkPoses> make_poses(const TrackOptions& options) {
  if (follows_ceiling(options)) return std::nullopt;
  const bool sized = options.size_m > 0.0 || !options.landmarks.empty();
  if (options.camera.empty()) {
    if (sized) throw InputError("--size and --landmarks give poses only with --camera FILE");
    return std::nullopt;
  }
  if (!sized)
    throw InputError("--camera: how large are the landmarks? Give --size M or --landmarks FILE");
  LandmarkSizes sizes;
  sizes.size_m = options.size_m;
  if (!options.landmarks.empty()) sizes.map = read_landmarks(options.landmarks);
  return LandmarkPoses(read_camera(options.camera), std::move(sizes));
}

void use_threads(int threads) {
  cv::setNumThreads(threads);
  // ViSP's conversions are OpenMP loops whose threads spin between pictures.
  omp_set_num_threads(threads);
}

void track_input(const std::string& input, const imaging::SourceParams& params, TrackRun& run) {
  const auto source = imaging::open_pictures(input, params);
  while (!interrupted() && !run.closed()) {
    const auto picture = source->next();
    if (!picture) return;
    run.picture(*picture);
  }
}

int track(const TrackOptions& options) {
  if (options.output.panorama && options.output.folder.empty())
    throw InputError("--panorama: needs --out DIR for its pictures");
  use_threads(options.threads);
  TrackOutput output = options.output;
  output.overlays = !options.no_overlay;
  TrackRun run(make_tracker(options), make_poses(options), output);
  imaging::SourceParams params;
  params.timeout_s = options.timeout_s;
  params.stop = interrupted;
  catch_interrupts();
  for (const std::string& input : options.inputs) {
    if (interrupted() || run.closed()) break;
    track_input(input, params, run);
  }
  if (!options.quiet)
    fmt::print(stderr, "{} {} found in {} pictures{}\n", run.found(), run.things(), run.pictures(),
               interrupted() ? ", then interrupted" : "");
  return run.found() > 0 && run.fewest() >= options.expected ? 0 : 1;
}

void add_what(CLI::App& command, TrackOptions& options) {
  const std::vector<std::string> trackers = names_of(tracking::trackers());
  command.add_option("--tracker", options.tracker, joined(trackers))
      ->check(one_of(trackers))
      ->capture_default_str();
  command
      .add_option("inputs", options.inputs,
                  "Pictures, folders, videos, NAME%04d.png, /dev/videoN, rtsp:// or http:// "
                  "addresses, or - for pictures on stdin")
      ->required();
  command.add_option("--polarity", options.polarity, "Discs that are dark, bright or either")
      ->check(one_of({"dark", "bright", "either"}))
      ->capture_default_str();
  command.add_option("--radius-px", options.radius_px,
                     "MIN:MAX, smallest and largest semi-axis of discs, px");
  command.add_option("--ids", options.ids, "Tags (3,7) or patterns (2-13-4,2-13-5) that count");
  command
      .add_option("--min-score", options.min_score,
                  "Discs with less of a score, landmarks with less of a confidence do not count")
      ->check(CLI::Range(0.0, 1.0));
  command
      .add_option("--expect", options.expected,
                  "Landmarks in sight: none are looked for while so many are held, and the exit "
                  "status is 1 when a picture shows fewer")
      ->check(CLI::Range(0, 100000));
  command
      .add_option("--every", options.every,
                  "Look for newcomers in every n-th picture, and track between")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      .add_option("--remember", options.remember,
                  "Pictures for which a landmark that is not seen keeps its number")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
}

void add_field(CLI::App& command, TrackOptions& options) {
  command.add_option("--mirror", options.mirror,
                     "field_scan: U,V,INNER,OUTER, the mirror's middle and the radii between which "
                     "it shows the field, px; without it the mirror is looked for");
  command
      .add_option("--ray-step-deg", options.ray_step_deg,
                  "field_scan: from one ray to the next, degrees")
      ->check(CLI::Range(0.1, 90.0))
      ->capture_default_str();
  command.add_flag("--panorama", options.output.panorama,
                   "field_scan: unwrapped pictures in the folder panorama");
}

void add_pose(CLI::App& command, TrackOptions& options) {
  command.add_option("--camera", options.camera,
                     "Calibrated camera (ViSP's XML, OpenCV's YAML): gives poses");
  command
      .add_option("--size", options.size_m,
                  "With --camera: a disc's diameter, a tag's black side, a pattern's sheet, m")
      ->check(CLI::Range(1e-4, 100.0));
  command.add_option("--landmarks", options.landmarks,
                     "With --camera: a world file that has the landmarks' sizes");
}

void add_output(CLI::App& command, TrackOptions& options) {
  command.add_option("--out", options.output.folder,
                     "Folder for track.csv, poses.csv and the overlay pictures");
  command.add_flag("--no-overlay", options.no_overlay, "No pictures in the folder");
  command.add_flag("--view", options.output.view, "Show the overlay in a window");
  command
      .add_option("--timeout", options.timeout_s,
                  "Seconds to wait for a camera's address, and for each of its pictures")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command.add_option("--threads", options.threads, "Threads of the image libraries")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command.add_flag("--quiet", options.quiet, "Only the table");
}

}  // namespace

void add_track(CLI::App& app, int& status) {
  auto options = std::make_shared<TrackOptions>();
  CLI::App* command =
      app.add_subcommand("track", "Run a tracker on pictures, a video or a live camera");
  add_what(*command, *options);
  add_field(*command, *options);
  command->add_option("--patch-px", options->patch_px,
                      "ceiling: LENGTH:WIDTH of a patch in the pictures, px");
  add_ceiling_options(*command, options->ceiling);
  add_pose(*command, *options);
  add_output(*command, *options);
  command->callback([options, &status] { status = track(*options); });
}

}  // namespace vigia::app
