#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "model/effects.h"
#include "model/material.h"
#include "support/image.h"
#include "support/progress.h"
#include "table/table.h"

namespace clothbrdf {

/// f_r of linear R, G and B at pairs of directions of the cloth's frame; 0 on or below the horizon,
/// no number where a table made for a scene says nothing.
/// May be called from several threads at once.
class Shading {
 public:
  using Batch = std::function<void(std::span<const Directions> directions, std::span<Rgb> f)>;

  explicit Shading(Batch batch) : batch_(std::move(batch)) {}

  void operator()(std::span<const Directions> directions, std::span<Rgb> f) const {
    batch_(directions, f);
  }
  Rgb operator()(const Directions& directions) const {
    Rgb f{};
    batch_(std::span(&directions, 1), std::span(&f, 1));
    return f;
  }

 private:
  Batch batch_;
};

/// What pictures are made of: a material or a table.
class Cloth {
 public:
  virtual ~Cloth() = default;

  /// Whether the component can be shown on its own.
  virtual bool has(Part part) const = 0;

  /// Whether it lacks directions: a table made for a scene.
  virtual bool for_scene() const { return false; }

  /// A part of f_r.
  virtual Shading shading(Part part) const = 0;
};

/// Evaluated as the model does with these effects, to rounding; a material of wavelengths then by
/// rgb_weights. Throws InputError, starting with `name`, for a material of other channels than R, G
/// and B or wavelengths.
std::unique_ptr<Cloth> material_cloth(const Material& material, const std::string& name,
                                      const Workers& workers = 1, const Effects& effects = {});

/// Interpolated between the table's nodes (Table::interpolate). Throws InputError, starting with
/// `name`, where the table has no channels R, G and B or does not answer
/// all pairs.
std::unique_ptr<Cloth> table_cloth(Table table, const std::string& name);

/// The same cloth with its weave turned, counter-clockwise seen from the normal.
Shading turned(const Shading& shading, double turn_deg);

}  // namespace clothbrdf
