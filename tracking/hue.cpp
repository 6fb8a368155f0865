#include "hue.hpp"

#include "vigia/core/angle.hpp"

namespace vigia::tracking {

HueColour hue_colour(const Eigen::Vector3d& rgb) {
  const double high = rgb.maxCoeff();
  const double spread = high - rgb.minCoeff();
  if (high <= 0.0 || spread <= 0.0) return {0.0, 0.0, high};
  double sixths = 0.0;
  if (rgb.x() == high)
    sixths = (rgb.y() - rgb.z()) / spread;
  else if (rgb.y() == high)
    sixths = 2.0 + (rgb.z() - rgb.x()) / spread;
  else
    sixths = 4.0 + (rgb.x() - rgb.y()) / spread;
  if (sixths < 0.0) sixths += 6.0;
  return {sixths * (kPi / 3.0), spread / high, high};
}

}  // namespace vigia::tracking
