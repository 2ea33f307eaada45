#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fit/lobe_basis.h"
#include "fit/observations.h"
#include "fit/parameter_set.h"
#include "fit/path_basis.h"
#include "fit/rows.h"
#include "model/material.h"
#include "support/progress.h"

namespace clothbrdf {

/// How exactly the sums over lobes and paths are taken: about this, relative.
struct Exactness {
  double tolerance;
};
inline constexpr Exactness kExact{1e-15};
inline constexpr Exactness kSearching{1e-6};

/// The rows of a table and the model: residuals, their derivatives, and sums over them. Holds
/// references. All members may be called from several threads at once.
class Misfit {
 public:
  Misfit(const Observations& observations, const Rows& rows, Exactness exactness, Workers workers)
      : observations_(observations), rows_(rows), exactness_(exactness), workers_(workers) {}

  /// Sum of squared residuals, without Rows::constant.
  double cost(const Material& material) const;

  /// Products of the columns of [d residual / d coordinate | residual], summed over all rows; as
  /// many rows and columns as free parameters, and one.
  Eigen::MatrixXd products(const Material& material, const ParameterSet& set) const;

  /// The triangular factor R of [d residual / d coordinate | residual] = Q R, for singular values
  /// that the products would lose.
  Eigen::MatrixXd triangle(const Material& material, const ParameterSet& set) const;

  /// Every residual: those of the blocks in order, then one a channel. `slopes`, if not null,
  /// becomes the derivative by the coordinates.
  std::vector<double> residuals(const Material& material, const ParameterSet& set,
                                Eigen::MatrixXd* slopes) const;

  const Rows& rows() const { return rows_; }
  const Observations& observations() const { return observations_; }

 private:
  const Observations& observations_;
  const Rows& rows_;
  Exactness exactness_;
  Workers workers_;
};

/// B at all sites and D in all channels.
ModelValues model_values(const Observations& observations, const Material& material,
                         Exactness exactness, Workers workers);

}  // namespace clothbrdf
