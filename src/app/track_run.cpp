#include "track_run.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/core/overloaded.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/ceiling_picture.hpp"
#include "vigia/tracking/panorama.hpp"

namespace vigia::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFeatures = "track.csv";
constexpr const char* kPoses = "poses.csv";

std::string header_of(const tracking::PictureRun& /*run*/) {
  return tracking::ellipse_csv_header();
}
std::string header_of(const tracking::PointPictureRun& /*run*/) {
  return tracking::points_csv_header();
}
std::string header_of(const tracking::FieldPictureParams& /*run*/) {
  return tracking::field_csv_header();
}
std::string header_of(const CeilingTrack& /*run*/) {
  return tracking::ceiling_csv_header();
}

std::string feature_lines(const tracking::PictureRow& row, const std::string& start) {
  return start + tracking::ellipse_csv_fields(row.feature) + '\n';
}
std::string feature_lines(const tracking::PointPictureRow& row, const std::string& start) {
  return tracking::points_csv_lines(row.feature, start);
}

/// What identifies a target in the table of poses, besides its number.
std::string code_of(const tracking::PictureRow& /*row*/) {
  return "";
}
std::string code_of(const tracking::PointPictureRow& row) {
  return row.feature.code ? tracking::to_string(*row.feature.code) : "";
}

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

/// A file's name without its folder and ending, in letters that every file system takes.
std::string file_stem(const std::string& name) {
  const fs::path path(name);
  std::string stem = path.stem().string();
  for (char& c : stem)
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0 || c == '/' || c == ':' || c == '?')
      c = '_';
  return stem;
}

}  // namespace

TrackRun::TrackRun(Tracker tracker, std::optional<LandmarkPoses> poses, const TrackOutput& output)
    : tracker_(std::move(tracker)), poses_(std::move(poses)), output_(output) {
  if (!output_.folder.empty()) folder_.emplace(output_.folder, kFeatures);
  if (output_.view)
    window_.emplace("vigia track", "without --view, --out writes the overlay pictures");
}

TrackRun::~TrackRun() = default;

const char* TrackRun::things() const {
  if (std::holds_alternative<tracking::FieldPictureParams>(tracker_))
    return "points on lines, goals and posts";
  if (std::holds_alternative<CeilingTrack>(tracker_)) return "patches";
  return std::holds_alternative<tracking::PictureRun>(tracker_) ? "discs" : "landmarks";
}

/// Those of the table of poses beside the target's; empty without poses.
std::string TrackRun::pose_columns() const {
  if (poses_) return "code," + pose_csv_header();
  const auto* ceiling = std::get_if<CeilingTrack>(&tracker_);
  return ceiling != nullptr && ceiling->gives_poses() ? CeilingTrack::pose_header() : "";
}

/// The one that gives poses.
const Intrinsics* TrackRun::camera() const {
  if (poses_) return &poses_->camera();
  const auto* ceiling = std::get_if<CeilingTrack>(&tracker_);
  return ceiling != nullptr && ceiling->gives_poses() ? &ceiling->view()->camera : nullptr;
}

// The heads of the tables.
void TrackRun::begin() {
  const std::string features =
      "image,frame,time_s,target," +
      std::visit([](const auto& run) { return header_of(run); }, tracker_) + '\n';
  const std::string columns = pose_columns();
  const std::string poses = "image,frame,time_s,target," + columns + '\n';
  fmt::print("{}", columns.empty() ? features : poses);
  if (!folder_) return;
  folder_->add(kFeatures, "");
  if (output_.overlays) folder_->make("overlay");
  if (output_.panorama) folder_->make("panorama");
  folder_->commit();
  features_file_.emplace(fs::path(output_.folder) / kFeatures);
  features_file_->write(features);
  if (columns.empty()) return;
  poses_file_.emplace(fs::path(output_.folder) / kPoses);
  poses_file_->write(poses);
}

/// What each row begins with.
std::string TrackRun::place_of(const imaging::Picture& picture) const {
  return fmt::format("{},{},{},", csv_quoted(picture.name), pictures_,
                     picture.time_s ? fmt::format("{:.6f}", *picture.time_s) : std::string());
}

fs::path TrackRun::picture_file(const char* kind, const imaging::Picture& picture) const {
  return fs::path(output_.folder) / kind /
         fmt::format("{:05}_{}.png", pictures_, file_stem(picture.name));
}

template <typename Row>
TrackRun::Tables TrackRun::tables_of(const std::vector<Row>& rows,
                                     const imaging::Picture& picture) const {
  Tables tables;
  const std::string place = place_of(picture);
  for (const Row& row : rows) {
    const std::string target = row.target > 0 ? std::to_string(row.target) : "";
    tables.features += feature_lines(row, place + target + ',');
    tables.found += row.feature.status == tracking::FeatureStatus::found ? 1 : 0;
    if (!poses_) continue;
    for (const LandmarkPose& pose : poses_->of(row.feature))
      tables.poses += place + target + ',' + code_of(row) + ',' + pose_csv_fields(pose) + '\n';
  }
  return tables;
}

TrackRun::Tables TrackRun::track(const imaging::Picture& picture, vpImage<vpRGBa>* overlay) {
  return std::visit(
      Overloaded{
          [&](tracking::FieldPictureParams& params) { return scanned(params, picture, overlay); },
          [&](CeilingTrack& ceiling) { return patches(ceiling, picture, overlay); },
          [&](auto& run) { return followed(run, picture, overlay); }},
      tracker_);
}

template <typename Run>
TrackRun::Tables TrackRun::followed(Run& run, const imaging::Picture& picture,
                                    vpImage<vpRGBa>* overlay) const {
  const auto rows = run.next(*picture.frame);
  if (overlay != nullptr) tracking::draw_overlay(rows, *overlay);
  return tables_of(rows, picture);
}

TrackRun::Tables TrackRun::scanned(const tracking::FieldPictureParams& params,
                                   const imaging::Picture& picture, vpImage<vpRGBa>* overlay) {
  const tracking::FieldPicture found = tracking::scan_field_picture(*picture.frame, params);
  if (overlay != nullptr) tracking::draw_overlay(found, *overlay);
  if (output_.panorama && found.mirror.outer_px > 0.0)
    panorama_ = tracking::unwrapped_panorama(*picture.frame, found.mirror);
  // No target is followed: that column stays empty.
  return {tracking::field_csv_lines(found, place_of(picture) + ','), "",
          tracking::features_in(found)};
}

TrackRun::Tables TrackRun::patches(CeilingTrack& ceiling, const imaging::Picture& picture,
                                   vpImage<vpRGBa>* overlay) const {
  const CeilingTrack::Row row = ceiling.next(picture, pictures_);
  if (overlay != nullptr) tracking::draw_overlay(row.scan, *overlay);
  const std::string start = place_of(picture) + ',';
  return {tracking::ceiling_csv_lines(row.scan, start),
          ceiling.gives_poses() ? start + row.pose + '\n' : "",
          static_cast<int>(row.scan.patches.size())};
}

void TrackRun::picture(const imaging::Picture& picture) {
  const imaging::Frame& frame = *picture.frame;
  if (const Intrinsics* own = camera();
      own != nullptr && (frame.width() != own->width || frame.height() != own->height))
    throw InputError(fmt::format("{}: {}×{} pixels, but --camera is calibrated for {}×{}",
                                 picture.name, frame.width(), frame.height(), own->width,
                                 own->height));
  const bool drawn = (folder_ && output_.overlays) || window_;
  ++pictures_;
  auto overlay = drawn ? imaging::colour_image(frame) : vpImage<vpRGBa>();
  const Tables tables = track(picture, drawn ? &overlay : nullptr);
  if (pictures_ == 1) begin();
  write(tables);
  fewest_ = pictures_ == 1 ? tables.found : std::min(fewest_, tables.found);
  found_ += tables.found;
  if (folder_ && output_.overlays) imaging::write_png(picture_file("overlay", picture), overlay);
  if (folder_ && panorama_) imaging::write_png(picture_file("panorama", picture), *panorama_);
  panorama_.reset();
  if (window_) window_->show(overlay);
}

void TrackRun::write(const Tables& tables) {
  fmt::print("{}", pose_columns().empty() ? tables.features : tables.poses);
  if (std::fflush(stdout) != 0) throw InputError("stdout: the table cannot be written");
  if (features_file_) {
    features_file_->write(tables.features);
    features_file_->flush();
  }
  if (poses_file_) {
    poses_file_->write(tables.poses);
    poses_file_->flush();
  }
}

}  // namespace vigia::app
