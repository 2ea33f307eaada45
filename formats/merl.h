#pragma once

#include "formats/format.h"

namespace clothbrdf {

/// MERL `.binary` (Matusik 2003): 90 x 90 x 180 isotropic half/difference cells, R, G and B as
/// 64-bit floats, each divided by its scale (1, 1.15, 1.66 over 1500). Values are those of the
/// cells' centres. 34,992,012 bytes.
Format merl_format();

}  // namespace clothbrdf
