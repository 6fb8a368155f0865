#include "vigia/localization/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace vigia::localization {

double chi_square_quantile(double p, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), p);
}

}  // namespace vigia::localization
