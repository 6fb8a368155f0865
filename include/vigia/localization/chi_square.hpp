#pragma once

namespace vigia::localization {

/// The value that a χ² variable of @p dof degrees of freedom stays below with probability @p p.
double chi_square_quantile(double p, double dof);
/// The probability that it exceeds @p value.
double chi_square_tail(double value, double dof);

}  // namespace vigia::localization
