#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// Keeps a few camera pictures with what their eyes made of them, spread evenly over the drive,
/// each taken while something is observed; by a camera that is directed, once its target has
/// settled.
class FrameAlbum : public mission::Listener {
 public:
  void on_start(const mission::MissionStart& start) override;
  /// Takes this tick's picture when one is due.
  void on_tick(const mission::Tick& tick) override;

  /// Writes the pictures as PNG files.
  void write(const std::filesystem::path& folder) const;

 private:
  struct Picture {
    std::string name;
    vpImage<vpRGBa> image;
  };

  int count_ = 0;
  double spacing_m_ = 0.0;
  double due_m_ = 0.0;
  const perception::Eye* first_eye_ = nullptr;
  std::vector<Picture> pictures_;
};

}  // namespace vigia::app
