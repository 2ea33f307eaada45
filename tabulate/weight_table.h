#pragma once

#include <cstddef>
#include <cstdint>

#include "support/progress.h"
#include "tabulate/aligned_vector.h"
#include "tabulate/lobe_lanes.h"

namespace clothbrdf {

/// The weights of LobeLanes as piecewise polynomials of cos_theta_d. Pieces are equal parts of the
/// octaves of y = cos_theta_d + kWeightShift, so that a piece and the place in it are bits of y:
/// weights change fastest at grazing incidence (model.md 8.2).
template <class T>
struct WeightTable {
  std::size_t lanes = 0;  ///< padded with weights of 0 to a multiple of kLanePadding
  std::size_t channels = 0;
  int piece_bits = 0;             ///< 2^piece_bits pieces an octave
  AlignedVector<T> coefficients;  ///< [piece][channel][power][lane]

  std::size_t row_size() const;  ///< values of a piece
};

/// y = cos_theta_d + 2^kFirstOctave lies in the octaves that start at 2^kFirstOctave ... 2^0.
inline constexpr int kFirstOctave = -8;
inline constexpr double kWeightShift = 0x1p-8;

/// Below this cos_theta_d errors are relative to the value at it.
inline constexpr double kLeastCosine = 0x1p-12;

/// Lanes of a vector register of 256 bits, the widest that sums over lanes use.
template <class T>
inline constexpr std::size_t kLanePadding = 32 / sizeof(T);

/// Degree of the polynomials.
template <class T>
inline constexpr int kWeightDegree = sizeof(T) == sizeof(float) ? 3 : 9;

/// The table whose interpolation changes f by less than the tolerance, relative, as measured in all
/// pieces and at half vectors of every tilt (below kLeastCosine relative to f there). Empty (no
/// lanes) where none does: where weights jump at grazing incidence (a refractive index near 1 with
/// absorption), where a channel is next to black (a dozen absorption lengths), or where channels
/// are so many that it would fill the memory.
template <class T>
WeightTable<T> weight_table(const LobeLanes& lanes, double tolerance, Workers workers);

}  // namespace clothbrdf
