#include "vigia/localization/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace vigia::localization {

double chi_square_quantile(double p, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), p);
}

double chi_square_tail(double value, double dof) {
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(dof), value));
}

}  // namespace vigia::localization
