#pragma once

#include "formats/format.h"

namespace clothbrdf {

/// ALTA text, `.alta` (Belcour et al., alta.gforge.inria.fr): lines `#KEY value`, then a line for
/// each sample: coordinates of the pair of directions in radians, f_r of each channel; every number
/// in as many digits as read back to it.
///
/// Grids are written in the parametrisation that is theirs (RUSIN_TH_TD_PD, RUSIN_TH_PH_TD_PD,
/// SPHERICAL_TL_PL_TV_PV), lists of pairs as SPHERICAL_TL_PL_TV_PV or, isotropic, as
/// ISOTROPIC_TV_TL_DPHI. ALTA's difference vector is that of the eye: phi_d of a table that goes
/// around once is less by 180 degrees than ours, that of a table of both orders is the same.
/// Cells below the horizon and cells that were not measured (marked by a negative value) are left
/// out: ALTA would take them for data.
///
/// The key CLOTHBRDF, which ALTA passes over, holds the table's description (table_metadata): with
/// it the file reads back as the same table, and contradictions are refused. Other files read as
/// lists of pairs; what their parametrisation leaves open is said in a note. Their values must be
/// f_r in 1/sr: ENERGY and XYZ_COLOR have no scale, and of INV_STERADIAN_COSINE_FACTOR ALTA says in
/// three ways which cosine it holds. One value a sample is the channel "mono".
Format alta_format();

/// The same in binary, `.dat`: rows of 64-bit floats. Either format reads both.
Format alta_binary_format();

}  // namespace clothbrdf
