#pragma once

#include "formats/format.h"

namespace clothbrdf {

/// NVIDIA MDL `.mbsdf`, version 1 (MDL specification 1.10, appendix B): an isotropic table of
/// n_theta x n_theta x n_phi nodes over theta_i and theta_o from 0 to 90 degrees and phi from 0 to
/// 180 (0: light and eye on one side), 32-bit floats, one number or R, G and B each. f_r, without
/// the cosine. 45 x 45 x 90 nodes where --size is left out, else n x n x 2 n.
///
/// Nodes are the centres of equal steps. Readers take the mean of f(i, o) and f(o, i) and go by
/// |phi_o - phi_i|, so that is what is written, whatever the source. Between nodes f_r is linear in
/// the three angles, and constant beyond the outermost nodes: as the GPU readers of the MDL SDK do
/// it. (Its CPU reader takes a node for the lower end of its step: half a step off.)
///
/// A reader's note holds the file's keys, and says where a block of transmission was left out or
/// where values of both orders differed. Files of transmission alone are refused. A file of one
/// number a node has the channel "mono".
Format mdl_format();

}  // namespace clothbrdf
