#pragma once

#include "formats/format.h"

namespace clothbrdf {

/// UTIA `.bin` (Filip and Vavra 2014): the anisotropic in/out grid of 6 x 48 x 6 x 48 nodes (theta
/// by 15 degrees up to 75, phi by 7.5), R, G and B as planes of 64-bit floats without a header,
/// 1,990,656 bytes. The index counts theta_i, phi_i, theta_o, phi_o, the last one fastest; i is the
/// light.
///
/// Stored are sRGB codes as the database's own readers take them (dj_brdf): f_r = 100 d(v / 140),
/// d(x) = ((x + 0.055) / 1.055)^2.4 above 0.0375, x / 12.92 up to it. The curve has a gap there:
/// f_r from 0.290248 to 0.290363 is stored as the nearer end, up to 2e-4 off; all else keeps 14
/// digits. Negative codes read as 0, as in dj_brdf, and are counted in a note.
///
/// Between nodes, and in the order that dj_brdf goes by: codes are linear in the four angles, phi
/// wraps, theta beyond 75 degrees goes on along the line from 60 to 75; the result is decoded and
/// clamped at 0.
Format utia_format();

/// The same layout in `.linear.bin`, with f_r itself in place of codes, as ALTA's data_utia reads
/// it. Negative values are kept at the nodes and clamped between them.
Format linear_utia_format();

}  // namespace clothbrdf
