#pragma once

#include "formats/format.h"

namespace clothbrdf {

/// RGL's tensor files `.bsdf` (Dupuy and Jakob 2018), which renderers also sample from: f_r times
/// the cosine of the light, divided by a distribution of half vectors and a projected area, on
/// nodes that each direction to the eye places for itself. RGB or, with Flavour::kSpectral, any
/// wavelengths; isotropic (one azimuth of the eye) where the table is.
///
/// Nodes: phi of the eye uniform once around, its theta from 0 to 89 degrees, about as many nodes
/// along each axis of the light's square. As many of them as `bytes` allow (5 MB where left out,
/// at most 2 GiB). Values are 32-bit floats. Between nodes readers go linearly, so node values are
/// set for the least error between them, not for none at them.
///
/// Reading takes any file of the family: both parities of the colours, isotropic or not, of full,
/// half (turned by 180 degrees) or quarter (mirrored) circles of azimuths. Its table holds every
/// node, and follows the readers' rule between them. Values are not clamped.
Format rgl_format();

}  // namespace clothbrdf
