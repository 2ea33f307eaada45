#pragma once

#include <span>
#include <vector>

#include "model/reflectance.h"
#include "table/reached_cells.h"
#include "table/table_spec.h"

namespace clothbrdf {

/// How exactly a kernel works.
enum class Precision {
  kDouble,  ///< as the model, to rounding
  kSingle,  ///< for files of 32-bit floats: in/out points and pairs are evaluated in floats
            ///< (batch.h), unless lobes are too narrow (floats_do)
};

/// Values of one kind of grid: the grid's part of a Producer.
class Kernel {
 public:
  virtual ~Kernel() = default;

  /// A row's values[channel][column] in some ranges of columns, at least one; others may be left as
  /// they are. The same bits whichever other columns are asked for.
  virtual void fill_row(std::size_t row, std::span<const ColumnRange> columns,
                        std::span<double> values) const = 0;
};

/// The narrowest lobe axis of both yarns.
double narrowest_axis(const ClothModel<double>& model);

/// Whether floats are good enough for a file of floats: narrow lobes magnify the rounding of
/// directions beyond that.
bool floats_do(const ClothModel<double>& model);

/// The value of a channel.
template <class T>
T channel_value(const BasicComponents<T>& f, const Channel& channel) {
  switch (channel.part) {
    case Part::kSpecular: return f.specular[channel.colour];
    case Part::kInternal: return f.internal[channel.colour];
    case Part::kDiffuse: return f.diffuse[channel.colour];
    case Part::kTotal: break;
  }
  return f.total(channel.colour);
}

/// The sums over lobes and the diffuse term for one half vector, ready for the channels of a table:
/// f = factor * sums(channel)[k] + diffuse(channel).
class ChannelSums {
 public:
  ChannelSums(const ClothModel<double>& model, std::size_t count);

  std::span<double> specular() { return specular_; }
  std::span<double> internal() { return internal_; }

  /// f of a channel for incidence cosine k: the part to be multiplied by the directional factor.
  double directional(const Channel& channel, std::size_t k) const;
  /// The part that is the same for all directions above the horizon.
  double constant(const Channel& channel) const;

 private:
  std::size_t count_;
  std::vector<double> specular_;  // [k]
  std::vector<double> internal_;  // [colour][k]
  std::vector<double> diffuse_;   // [colour]
};

}  // namespace clothbrdf
