#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "model/material.h"
#include "support/image.h"
#include "table/table.h"

namespace clothbrdf {

/// f_r of linear R, G and B at a pair of directions of the cloth's frame; 0 on or below the
/// horizon. May be called from several threads at once.
using Shading = std::function<Rgb(const Directions&)>;

/// What pictures are made of: a material or a table.
class Cloth {
 public:
  virtual ~Cloth() = default;

  /// Whether the component can be shown on its own.
  virtual bool has(Part part) const = 0;

  /// A part of f_r. `cos_theta_d` is given where it is the same for all directions that will be
  /// asked, which saves most of the work for a material.
  virtual Shading shading(Part part, std::optional<double> cos_theta_d) const = 0;
};

/// Throws InputError, starting with `name`, for a material that is not of R, G and B.
std::unique_ptr<Cloth> material_cloth(const Material& material, const std::string& name);

/// Interpolated between the table's nodes (Table::interpolate). Throws InputError, starting with
/// `name`, where the table has no channels R, G and B or is no grid.
std::unique_ptr<Cloth> table_cloth(Table table, const std::string& name);

/// The same cloth with its weave turned, counter-clockwise seen from the normal.
Shading turned(const Shading& shading, double turn_deg);

}  // namespace clothbrdf
