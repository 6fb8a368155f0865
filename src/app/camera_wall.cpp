#include "camera_wall.hpp"

#include "recording.hpp"

#include <algorithm>

#include "vigia/report/overlay.hpp"

namespace vigia::app {
namespace {

unsigned even(unsigned size) {
  return size + size % 2U;
}

}  // namespace

CameraWall::CameraWall(const mission::MissionSetup& setup) {
  unsigned width = 0;
  unsigned height = 0;
  for (const Camera& camera : setup.robot.rig().cameras) {
    const CameraModel model = camera.model(setup.robot.initial_zoom_mm);
    left_[camera.id] = width;
    width += static_cast<unsigned>(image_width(model));
    height = std::max(height, static_cast<unsigned>(image_height(model)));
  }
  picture_.resize(even(height), even(width), vpRGBa(0, 0, 0));
}

void CameraWall::show(const mission::Tick& tick, const mission::EyeTick& shown) {
  auto image = imaging::colour_image(*shown.frame);
  if (shown.observed) report::draw_overlay(image, overlay_of(tick, *shown.eye));
  const unsigned left = left_.at(shown.camera);
  for (unsigned row = 0; row < image.getHeight(); ++row)
    std::copy_n(image[row], image.getWidth(), picture_[row] + left);
}

}  // namespace vigia::app
