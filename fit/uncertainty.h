#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fit/parameter_set.h"
#include "fit/report.h"

namespace clothbrdf {

/// What the derivatives at a fit say of its parameters (Fisher information, Cramer-Rao bound).
struct Uncertainty {
  /// Of each free parameter; none where the table does not settle it.
  std::vector<std::optional<double>> standard_errors;
  std::vector<double> singular_values;  ///< over the noise, relative changes; largest first
  double condition = 0;                 ///< 0 where it is infinite
  std::vector<BlindDirection> blind;    ///< the least visible first
};

/// A change of a parameter counts relative to this: its value, or kSmallValue where that is larger;
/// 45 degrees for the rotation.
double unit_of_change(const FitParameter& parameter, double value);

/// `triangle`: Misfit::triangle at the material. `noise`: standard deviation of a residual.
Uncertainty uncertainty(const Eigen::MatrixXd& triangle, const ParameterSet& set,
                        const Material& material, double noise);

/// The verdict on a free parameter.
Verdict verdict_of(const FitParameter& parameter, double value,
                   const std::optional<double>& standard_error);

/// Why a free parameter is not identifiable, or only weakly: the blind directions that it takes
/// part in, in words.
std::string reason_of(const FitParameter& parameter, const std::vector<BlindDirection>& blind);

}  // namespace clothbrdf
