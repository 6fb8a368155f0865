#pragma once

#include "ellipse_shape.hpp"

#include <optional>

#include <visp3/blob/vpDot2.h>

namespace vigia::tracking {

/// vpDot2 without its own search for a lost dot: that search reads pixels far from the dot, so its
/// outcome would depend on how much of the frame is computed. A dot that isn't under its seed, or
/// isn't like the wanted one, is lost.
class SeededDot : public vpDot2 {
 public:
  SeededDot();

  /// What vpDot2 says of the dot round @p seed whose grey levels lie in [low, high]; nothing when
  /// it is lost.
  std::optional<EllipseShape> track(const vpImage<unsigned char>& image,
                                    const Eigen::Vector2d& seed, int low, int high);

 private:
  bool isValid(const vpImage<unsigned char>& image, const vpDot2& wanted) override;
  vpDot2* getInstance() override;
};

}  // namespace vigia::tracking
