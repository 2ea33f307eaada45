#pragma once

#include "formats/format.h"
#include "formats/window_xml.h"

namespace clothbrdf {

/// Radiance's tensor tree `.tree.xml` (TensorTree4, LBNL/Shirley-Chiu): f_r over the squares of the
/// light's opposite and of the eye, in nested boxes, 128 an axis at the finest. A value is the mean
/// of f_r over its box, each direction weighted with its projected solid angle. A box is cut where
/// one of its 16 parts is far from its mean: relative to the largest of R, G and B, times the box's
/// width (1 is the whole axis), farther than the least error, but not below kTreeError, whose file
/// takes at most --size or kTreeBytes.
/// Visible is Y; CIE-u and CIE-v are u' and v' of the box's mean (to_tristimulus), in trees of the
/// same boxes. "Reflection Back" is the cloth's front, as in Radiance. Four million boxes at
/// most, about 90 MB; memory: 300 MB.
///
/// Radiance itself asks with the ray's direction back to the eye as the incident one, which counts
/// only for the paper's f_r, which is not reciprocal.
Format tensor_tree_format();

inline constexpr double kTreeError = 0.001;
/// Of a file, where --size is left out.
inline constexpr std::uint64_t kTreeBytes = 32000000;
/// The smallest --size.
inline constexpr std::uint64_t kLeastTreeBytes = 4096;

// Internal to formats/.

/// The seventh digit of Y, u' and v', times what the way to a saturated colour loses.
inline constexpr StoredPrecision kTensorTreePrecision = {1e-5, 0x1p-149};

/// The table of a file with the structure TensorTree4 (rank 4) or TensorTree3, which is isotropic
/// (rank 3): a pair at the centre of each box of Visible.
Table read_tensor_tree(const WindowFile& file, int rank);

}  // namespace clothbrdf
