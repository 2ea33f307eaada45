#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "model/material.h"

namespace clothbrdf {

/// One numeric parameter of a material, as the user meets it. The schema and the documentation are
/// tested against this table.
struct ParameterInfo {
  std::string_view pointer;  ///< JSON pointer in a material; that of the warp for yarn parameters
  std::string_view unit;
  double lowest;
  double highest;
  std::optional<double> default_value;  ///< none: required, or it depends on another parameter
  std::string_view meaning;
};

inline constexpr double kNoLimit = 1.797693134862315708e308;

/// Most channels of a material: five times what the spectral databases hold (195), so more is a
/// mistake.
inline constexpr std::size_t kMaxChannels = 1024;

inline constexpr ParameterInfo kParameters[] = {
    {"/weights/specular", "1", 0, 100, std::nullopt, "weight k_s of the surface reflection"},
    {"/weights/internal", "1", 0, 100, std::nullopt,
     "weight k_i of the reflection from inside the layers"},
    {"/weights/diffuse", "1", 0, 100, std::nullopt, "weight k_d of the light without direction"},
    {"/diffuse_path", "layers", 0, 100, 1.0,
     "path of the diffuse light in the yarn, in layer thicknesses"},
    {"/warp_fraction", "1", 0, 1, 0.5, "share of the surface that shows warp"},
    {"/rotation_deg", "deg", -kNoLimit, kNoLimit, 0.0,
     "rotation of the weave, counter-clockwise from above"},
    {"/warp/lobe_axes/0", "1", 1e-6, 1, std::nullopt, "semi-axis of the lobe along the yarn"},
    {"/warp/lobe_axes/1", "1", 1e-6, 1, std::nullopt, "semi-axis of the lobe across the yarn"},
    {"/warp/absorption/0", "1", 0, 1e6, std::nullopt,
     "absorbance of one layer, natural logarithm, per channel"},
    {"/warp/layers", "layers", 0, 64, std::nullopt, "number of stacked yarn layers, an integer"},
    {"/warp/refractive_index", "1", 1, 3, std::nullopt, "refractive index of the yarn"},
    {"/warp/scatter", "1", 0, 1, 0.0,
     "share of directionality lost with each reflection or transmission"},
    {"/warp/scatter_limit", "1", 1e-6, 1, std::nullopt,
     "radius of the circle that scatter tends to, not below either lobe axis; default the wider "
     "axis"},
};

/// A number as messages and material files show it: the shortest text that reads back to the same
/// double, without an exponent for whole numbers below 1e15.
std::string number_text(double value);

/// What is wrong with one value of a material.
struct MaterialProblem {
  std::string pointer;  ///< JSON pointer of the value
  std::string value;
  std::string allowed;
};

/// The first value outside its range, or that contradicts another; none for a valid material.
std::optional<MaterialProblem> find_problem(const Material& material);

/// Throws std::invalid_argument with pointer, value and what is allowed, for materials built in
/// code.
void check_material(const Material& material);

}  // namespace clothbrdf
