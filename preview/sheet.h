#pragma once

#include "model/directions.h"
#include "preview/cloth.h"
#include "support/image.h"
#include "support/progress.h"

namespace clothbrdf {

/// The paper's sheet of cloth (section 5): wrinkled with sine functions, seen from above; x from
/// the left edge, y from the lower edge, [0, 1]. The weft runs along x, the warp along y; where the
/// sheet is tilted, both turn with it, the short way.
struct Slope {
  double x;  ///< dz/dx
  double y;  ///< dz/dy
};
Slope sheet_slope(double x, double y);

/// A direction w, given in the frame of the whole sheet, in the frame of the cloth at a slope.
Vector3<double> to_cloth(const Slope& slope, const Vector3<double>& w);

/// A direction from the normal of the flat sheet, degrees.
struct SheetDirection {
  double theta_deg = 0;  ///< [0, 90)
  double phi_deg = 0;
};

/// How a sheet is lit and seen, both from far away. Every point is drawn where it lies on the flat
/// sheet.
struct SheetView {
  SheetDirection light;
  SheetDirection eye;
  int size = 256;       ///< pixels along an edge
  double exposure = 0;  ///< stops; at 0 a white diffuse sheet that faces the light is 1
};

/// Blue: the colour of directions of which a table made for a scene says nothing.
inline constexpr Rgb kNotInTable = {0.02, 0.05, 0.35};

/// pi f_r cos(theta_i) times the exposure at the middle of each pixel; 0 where the sheet turns away
/// from light or eye, kNotInTable where the shading is no number. Throws Cancelled.
Image render_sheet(const Shading& shading, const SheetView& view, const Workers& workers);

}  // namespace clothbrdf
