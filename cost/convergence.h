#pragma once

#include <span>
#include <vector>

#include "cost/report.h"

namespace clothbrdf {

/// How fast errors fall along every dial with three or more settings that differ only in size and
/// err by more than 1e-13, fitted by least squares to the logarithm of the rms:
///
/// - Tables: rms ~ step^order, step = cells^(-1/3) of "3-D", cells^(-1/4) of "4-D". Expected: order
///   1 of nearest cells, 2 of linear reading and of formats with a rule of their own. Differs by
///   more than 0.35 in the order.
/// - "layers kept": rms ~ ratio^layers. Expected: the same fit to what the layers left out add to
///   the internal light at normal incidence, in closed form, in the yarn and channel that absorb
///   least. Differs by more than a quarter, and always without absorption, where no ratio is.
/// - "rotations": rms ~ rotations^-order, `fitted` between the last two points, `expected` between
///   the two before: "faster than any power" where the order grows by more than 0.35, else it
///   differs.
///
/// `dial` tells the settings apart: "4-D uniform axes, EXR, point, linear, half".
std::vector<Convergence> convergence(const Material& material,
                                     std::span<const CostSetting> settings);

}  // namespace clothbrdf
