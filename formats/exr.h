#pragma once

#include "formats/format.h"

namespace clothbrdf {

/// OpenEXR, scan lines, one float (or half) channel for each of the table's, uncompressed unless
/// asked. Rows of the picture are the first pair of axes, columns the second; of a 3-D grid, rows
/// are theta_h and theta_d, columns phi_d. The string attribute "clothbrdf"
/// (data-schemas/table.schema.json) holds all that is needed to rebuild the table. No renderer
/// evaluates such a picture by itself. Tiled, deep and multi-part pictures are refused, and headers
/// that claim more than the file can hold.
Format exr_format();

}  // namespace clothbrdf
