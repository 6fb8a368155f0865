#pragma once

#include "ceiling_track.hpp"
#include "landmark_poses.hpp"
#include "overlay_window.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "vigia/core/output_file.hpp"
#include "vigia/core/output_folder.hpp"
#include "vigia/imaging/picture_source.hpp"
#include "vigia/tracking/field_picture_run.hpp"
#include "vigia/tracking/picture_run.hpp"
#include "vigia/tracking/point_picture_run.hpp"

namespace vigia::app {

struct TrackOutput {
  std::string folder;     ///< for the tables and the overlay pictures; empty: none
  bool overlays = true;   ///< whether the folder gets pictures
  bool view = false;      ///< a window
  bool panorama = false;  ///< a field's pictures unwrapped, in the folder
};

/// Runs a tracker over pictures and writes what it sees, picture by picture: on stdout the table of
/// features, or that of poses where the camera is known; in the folder both. What is written stays,
/// whatever happens afterwards. The folder takes its name when the first picture has been tracked.
class TrackRun {
 public:
  using Tracker = std::variant<tracking::PictureRun, tracking::PointPictureRun,
                               tracking::FieldPictureParams, CeilingTrack>;

  TrackRun(Tracker tracker, std::optional<LandmarkPoses> poses, const TrackOutput& output);
  ~TrackRun();

  /// Throws InputError when the picture isn't of the camera's size, or the tables can't be written.
  void picture(const imaging::Picture& picture);

  int pictures() const { return pictures_; }
  int found() const { return found_; }                          ///< features of all pictures
  int fewest() const { return fewest_; }                        ///< features of the poorest picture
  const char* things() const;                                   ///< what is counted
  bool closed() const { return window_ && window_->closed(); }  ///< by its user

 private:
  struct Tables {
    std::string features;
    std::string poses;
    int found = 0;
  };

  void begin();
  Tables track(const imaging::Picture& picture, vpImage<vpRGBa>* overlay);
  template <typename Run>
  Tables followed(Run& run, const imaging::Picture& picture, vpImage<vpRGBa>* overlay) const;
  Tables scanned(const tracking::FieldPictureParams& params, const imaging::Picture& picture,
                 vpImage<vpRGBa>* overlay);
  Tables patches(CeilingTrack& ceiling, const imaging::Picture& picture,
                 vpImage<vpRGBa>* overlay) const;
  std::string pose_columns() const;
  const Intrinsics* camera() const;
  std::string place_of(const imaging::Picture& picture) const;
  std::filesystem::path picture_file(const char* kind, const imaging::Picture& picture) const;
  template <typename Row>
  Tables tables_of(const std::vector<Row>& rows, const imaging::Picture& picture) const;
  void write(const Tables& tables);

  Tracker tracker_;
  std::optional<LandmarkPoses> poses_;
  TrackOutput output_;
  std::optional<OutputFolder> folder_;
  std::optional<OutputFile> features_file_;
  std::optional<OutputFile> poses_file_;
  std::optional<OverlayWindow> window_;
  std::optional<vpImage<vpRGBa>> panorama_;  ///< of the present picture
  int pictures_ = 0;
  int found_ = 0;
  int fewest_ = 0;
};

}  // namespace vigia::app
