#include "seeded_dot.hpp"

#include <algorithm>

#include <visp3/core/vpTrackingException.h>

namespace vigia::tracking {

SeededDot::SeededDot() {
  setGraphics(false);
  setComputeMoments(true);
}

std::optional<EllipseShape> SeededDot::track(const vpImage<unsigned char>& image,
                                             const Eigen::Vector2d& seed, int low, int high) {
  setCog(vpImagePoint(seed.y(), seed.x()));
  setGrayLevelMin(static_cast<unsigned>(std::clamp(low, 0, 255)));
  setGrayLevelMax(static_cast<unsigned>(std::clamp(high, 0, 255)));
  try {
    vpDot2::track(image, false);
  } catch (const vpException&) {
    return std::nullopt;
  }
  const vpColVector n = get_nij();
  EllipseShape shape;
  shape.centre << getCog().get_u(), getCog().get_v();
  shape.sigma << n[0], n[1], n[1], n[2];
  shape.sigma *= 4.0;
  return shape;
}

// The tracker has its own, sharper tests.
bool SeededDot::isValid(const vpImage<unsigned char>& /*image*/, const vpDot2& /*wanted*/) {
  return true;
}

// vpDot2 asks for an instance only to search.
vpDot2* SeededDot::getInstance() {
  throw vpTrackingException(vpTrackingException::featureLostError, "no dot under the seed");
}

}  // namespace vigia::tracking
