#pragma once

#include "formats/format.h"
#include "formats/window_xml.h"

namespace clothbrdf {

/// Klems matrix `.xml`, of LBNL WINDOW and Radiance: 145 patches of the light (LBNL/Klems Full) by
/// 145 of the eye, about 1.3 MB. A value is the mean of f_r over both patches, each direction
/// weighted with its projected solid angle (so the sum over patches of the eye, times theirs, is
/// the albedo), exact to kKlemsAccuracy. Visible is Y; CIE-X and CIE-Z see to_tristimulus().
/// Columns are patches of the light, named by the direction in which it travels (azimuth + 180
/// degrees). "Reflection Back" is the cloth's front, as in Radiance.
///
/// Radiance itself asks with the ray's direction back to the eye as the incident one, which counts
/// only for the paper's f_r, which is not reciprocal.
Format klems_format();

/// The relative error of each patch pair and channel that its quadrature is refined to, by its own
/// estimate, within a budget of 3e4 values of f_r a pair.
inline constexpr double kKlemsAccuracy = 1e-3;

// Internal to formats/.

/// The table of a file of the family with the structure Columns or Rows: any of the three bases.
Table read_klems(const WindowFile& file);

}  // namespace clothbrdf
