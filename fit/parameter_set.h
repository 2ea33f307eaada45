#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fit/options.h"
#include "model/material.h"

namespace clothbrdf {

/// The columns of a residual's derivative: the parameters that one channel depends on. Other
/// channels' absorption has none.
enum LocalColumn : std::size_t {
  kAlong,  ///< lobe_axes[0] of the warp; those of the weft follow at kYarnColumns
  kAcross,
  kIndex,
  kScatter,
  kAbsorption,  ///< of the channel
  kYarnColumns,
  kRotation = 2 * kYarnColumns,  ///< degrees
  kSpecular,
  kInternal,
  kDiffuse,
  kDiffusePath,
  kFraction,
  kLocalColumns,
};

/// One numeric parameter of a material.
struct FitParameter {
  std::string name;  ///< "warp.lobe_axes.0"
  std::string unit;
  std::size_t yarn = 0;         ///< 0 warp, 1 weft; of yarn parameters
  LocalColumn column = kAlong;  ///< of the warp where it is a yarn's
  bool of_yarn = false;
  std::size_t channel = 0;  ///< of absorption values
  double lowest = 0;        ///< bounds
  double highest = 0;
  double widest_low = 0;  ///< bounds where none are asked for
  double widest_high = 0;
  double scatter_low = 0;   ///< scattered starts are drawn from here ...
  double scatter_high = 0;  ///< ... to here, evenly in the coordinate
  double log_offset = -1;   ///< coordinate log(value + offset); plain value where negative

  double to_coordinate(double value) const;
  double to_value(double coordinate) const;
  double value_slope(double value) const;  ///< d value / d coordinate
};

/// All parameters of a material with so many channels, warp before weft.
std::vector<FitParameter> fit_parameters(std::size_t channels);

double parameter_value(const Material& material, const FitParameter& parameter);
void set_parameter(Material& material, const FitParameter& parameter, double value);

/// Which parameters are fitted, and how their values lie in the solver's vector of coordinates.
class ParameterSet {
 public:
  enum class State { kFree, kFixed, kTied };

  /// `rotatable`: the table has phi_h, so the rotation can be fitted. Throws InputError for wishes
  /// that name no parameter or ask for what is out of range.
  ParameterSet(const FitOptions& options, std::size_t channels, bool rotatable);

  std::size_t channels() const { return channels_; }
  const std::vector<FitParameter>& parameters() const { return parameters_; }
  State state(std::size_t parameter) const { return states_[parameter]; }

  /// Where each parameter starts, for starts without a guess of it.
  const Material& defaults() const { return defaults_; }
  /// Whether a start value was asked for.
  bool has_start(std::size_t parameter) const { return started_[parameter]; }

  /// The free ones, by index into parameters().
  const std::vector<std::size_t>& free() const { return free_; }

  /// Whether a layer count was fixed; then it is the one of defaults().
  bool layers_fixed(std::size_t yarn) const { return layers_fixed_[yarn]; }
  bool layers_tied() const { return layers_tied_; }
  /// Whether the first start has the count of defaults().
  bool layers_started(std::size_t yarn) const { return layers_started_[yarn]; }

  /// The same with one more parameter fixed, where the material has it.
  ParameterSet with_fixed(std::size_t parameter) const;

  std::vector<double> coordinates(const Material& material) const;
  double lowest_coordinate(std::size_t free) const;
  double highest_coordinate(std::size_t free) const;

  /// A material with the free values of `coordinates`, tied ones equal to them, and the others of
  /// `base`.
  Material material(std::span<const double> coordinates, const Material& base) const;

  /// A derivative for a channel's column by a coordinate: value = scale * d/d column.
  struct Slope {
    std::size_t free;
    std::size_t column;
    double scale;
  };
  std::vector<Slope> slopes(const Material& material, std::size_t channel) const;

 private:
  void apply(const ParameterWish& wish);
  void tie_layers();
  std::size_t partner(std::size_t warp) const;  // of the weft
  void index_free();

  std::size_t channels_;
  std::vector<FitParameter> parameters_;
  std::vector<State> states_;
  std::vector<bool> started_;
  std::array<bool, 2> layers_fixed_{};
  std::array<bool, 2> layers_started_{};
  bool layers_tied_ = false;
  Material defaults_;
  std::vector<std::size_t> free_;
};

}  // namespace clothbrdf
