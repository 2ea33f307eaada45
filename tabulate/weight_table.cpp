#include "tabulate/weight_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "support/threads.h"

namespace clothbrdf {
namespace {

constexpr int kMostPieceBits = 7;
constexpr int kOctaves = -kFirstOctave;  // and a little of the next one, for cos_theta_d near 1
constexpr double kLastOctaveEnd = 1 + 0x1p-3;

using Row = std::vector<double>;  // [channel][lane]

/// Weights in whole octaves of y, interpolated at Chebyshev points of each.
class Octaves {
 public:
  Octaves(const LobeLanes& lanes, std::size_t nodes, Workers workers)
      : nodes_(nodes), row_size_(lanes.size() * lanes.channels().size()) {
    rows_.resize(kOctaves * nodes, Row(row_size_));
    with_threads(workers.threads, [&] {
      run_parallel(rows_.size(), workers, [&](std::size_t k) {
        workers.check();
        const double y = place(static_cast<int>(k / nodes_), node(k % nodes_));
        lanes.weights(cosine(y), rows_[k]);
      });
    });
  }

  static double cosine(double y) { return std::max(0.0, y - kWeightShift); }

  /// y at a share, 0 to 1, of an octave's panel.
  static double place(int octave, double share) {
    const double low = std::ldexp(1.0, kFirstOctave + octave);
    const double high = octave == kOctaves - 1 ? kLastOctaveEnd : 2 * low;
    return low + share * (high - low);
  }

  Row at(double y) const {
    const int octave = std::clamp(std::ilogb(y) - kFirstOctave, 0, kOctaves - 1);
    const double low = place(octave, 0);
    const double share = (y - low) / (place(octave, 1) - low);
    // Barycentric Lagrange at Chebyshev points of the first kind.
    Row sum(row_size_, 0.0);
    double all = 0;
    for (std::size_t k = 0; k < nodes_; ++k) {
      const Row& row = rows_[static_cast<std::size_t>(octave) * nodes_ + k];
      const double off = share - node(k);
      if (off == 0) return row;
      const double sign = k % 2 == 0 ? 1 : -1;
      const double weight = sign * std::sin(angle(k)) / off;
      all += weight;
      for (std::size_t i = 0; i < row_size_; ++i) sum[i] += weight * row[i];
    }
    for (double& s : sum) s /= all;
    return sum;
  }

 private:
  double angle(std::size_t k) const {
    return pi<double>() * (static_cast<double>(k) + 0.5) / static_cast<double>(nodes_);
  }
  double node(std::size_t k) const { return (1 - std::cos(angle(k))) / 2; }

  std::size_t nodes_;
  std::size_t row_size_;
  std::vector<Row> rows_;  // [octave][node]
};

/// How far two rows of weights put f apart, at half vectors of every tilt and a few azimuths.
/// Internal light vanishes with cos_theta_d^2: below kLeastCosine its error is seen relative to the
/// value there.
class Measure {
 public:
  explicit Measure(const LobeLanes& lanes)
      : lanes_(lanes.size()),
        channels_(lanes.channels().size()),
        least_(lanes.size() * lanes.channels().size()) {
    lanes.weights(kLeastCosine, least_);
    for (double tilt : {0.0, 1e-3, 1e-2, 0.05, 0.2, 0.7, 2.0, 10.0, 100.0}) {
      for (const double along_weft : {0.0, 0.3, 1.0}) {
        const double tangent2 = tilt * tilt;
        Row densities;
        for (std::size_t l = 0; l < lanes_; ++l) {
          densities.push_back(
              1 /
              (tangent2 * (along_weft * lanes.weft()[l] + (1 - along_weft) * lanes.warp()[l]) + 1));
        }
        densities_.push_back(densities);
      }
    }
  }

  double operator()(double y, const Row& approximate, const Row& exact) const {
    const Row& reference = Octaves::cosine(y) < kLeastCosine ? least_ : exact;
    double largest = 0;
    for (const Row& density : densities_) {
      for (std::size_t c = 0; c < channels_; ++c) {
        double off = 0;
        double sum = 0;
        for (std::size_t l = 0; l < lanes_; ++l) {
          const std::size_t i = c * lanes_ + l;
          off += (approximate[i] - exact[i]) * density[l];
          sum += reference[i] * density[l];
        }
        if (off != 0) largest = std::max(largest, sum != 0 ? std::abs(off / sum) : HUGE_VAL);
      }
    }
    return largest;
  }

 private:
  std::size_t lanes_;
  std::size_t channels_;
  Row least_;  // weights at kLeastCosine
  std::vector<Row> densities_;
};

double octave_error(const Octaves& octaves, const LobeLanes& lanes, const Measure& measure,
                    Workers workers) {
  constexpr std::array<double, 2> kBetween = {0.013, 0.52};  // of an octave, between nodes
  std::vector<double> errors(kOctaves * kBetween.size());
  with_threads(workers.threads, [&] {
    run_parallel(errors.size(), workers, [&](std::size_t k) {
      workers.check();
      const double y =
          Octaves::place(static_cast<int>(k / kBetween.size()), kBetween[k % kBetween.size()]);
      Row exact(lanes.size() * lanes.channels().size());
      lanes.weights(Octaves::cosine(y), exact);
      errors[k] = measure(y, octaves.at(y), exact);
    });
  });
  return *std::max_element(errors.begin(), errors.end());
}

/// The powers' coefficients of the polynomial through values at Chebyshev points t in [-1, 1]: a
/// matrix [power][point].
template <int degree>
std::array<std::array<double, degree + 1>, degree + 1> power_matrix(
    const std::array<double, degree + 1>& points) {
  std::array<std::array<double, degree + 1>, degree + 1> matrix{};
  for (std::size_t p = 0; p < points.size(); ++p) {
    // Lagrange's polynomial of point p, multiplied out.
    std::array<double, degree + 1> power{1};
    std::size_t order = 0;
    for (std::size_t q = 0; q < points.size(); ++q) {
      if (q == p) continue;
      ++order;
      for (std::size_t k = order + 1; k-- > 0;) {
        power[k] = ((k > 0 ? power[k - 1] : 0) - points[q] * power[k]) / (points[p] - points[q]);
      }
    }
    for (std::size_t k = 0; k <= degree; ++k) matrix[k][p] = power[k];
  }
  return matrix;
}

// Of a table; hundreds of channels would fill the memory.
constexpr double kMostBytes = 256e6;

template <class T>
double table_bytes(const LobeLanes& lanes, int bits) {
  return std::ldexp(kOctaves, bits) * static_cast<double>(lanes.size() * lanes.channels().size()) *
         (kWeightDegree<T> + 1) * sizeof(T);
}

template <class T>
class Pieces {
 public:
  static constexpr int kDegree = kWeightDegree<T>;

  Pieces(const Octaves& octaves, const LobeLanes& lanes, const Measure& measure, int bits,
         Workers workers)
      : lanes_(lanes.size()),
        padded_((lanes_ + kLanePadding<T> - 1) / kLanePadding<T> * kLanePadding<T>) {
    std::array<double, kDegree + 1> points;
    for (int p = 0; p <= kDegree; ++p)
      points[static_cast<std::size_t>(p)] = -std::cos(pi<double>() * (p + 0.5) / (kDegree + 1));
    const auto matrix = power_matrix<kDegree>(points);
    table.lanes = padded_;
    table.channels = lanes.channels().size();
    table.piece_bits = bits;
    const std::size_t pieces = (std::size_t{kOctaves} << bits) + 1;
    table.coefficients.assign(pieces * table.row_size(), T(0));
    std::vector<double> errors(pieces);
    const auto make = [&](std::size_t piece) {
      workers.check();
      const int octave = static_cast<int>(piece >> bits);
      const double width = std::ldexp(1.0, kFirstOctave + octave - bits);
      const double low = std::ldexp(1.0, kFirstOctave + octave) +
                         width * static_cast<double>(piece & ((std::size_t{1} << bits) - 1));
      const auto y_at = [&](double t) { return low + width * (t + 1) / 2; };
      std::array<Row, kDegree + 1> values;
      for (std::size_t p = 0; p < values.size(); ++p) values[p] = octaves.at(y_at(points[p]));
      T* const to = table.coefficients.data() + piece * table.row_size();
      fill(matrix, values, to);
      for (const double t : {-1.0, 0.0, 0.93}) {
        errors[piece] =
            std::max(errors[piece], measure(y_at(t), evaluate(to, t), octaves.at(y_at(t))));
      }
    };
    with_threads(workers.threads, [&] { run_parallel(pieces, workers, make); });
    error = *std::max_element(errors.begin(), errors.end());
  }

  WeightTable<T> table;
  double error = 0;

 private:
  template <class Matrix, class Values>
  void fill(const Matrix& matrix, const Values& values, T* to) const {
    for (std::size_t c = 0; c < table.channels; ++c) {
      for (std::size_t k = 0; k <= kDegree; ++k) {
        for (std::size_t l = 0; l < lanes_; ++l) {
          double sum = 0;
          for (std::size_t p = 0; p < values.size(); ++p)
            sum += matrix[k][p] * values[p][c * lanes_ + l];
          to[(c * (kDegree + 1) + k) * padded_ + l] = static_cast<T>(sum);
        }
      }
    }
  }

  Row evaluate(const T* row, double t) const {
    Row values;
    for (std::size_t c = 0; c < table.channels; ++c) {
      for (std::size_t l = 0; l < lanes_; ++l) {
        double sum = 0;
        for (std::size_t k = kDegree + 1; k-- > 0;)
          sum = sum * t + static_cast<double>(row[(c * (kDegree + 1) + k) * padded_ + l]);
        values.push_back(sum);
      }
    }
    return values;
  }

  std::size_t lanes_;
  std::size_t padded_;
};

}  // namespace

template <class T>
std::size_t WeightTable<T>::row_size() const {
  return channels * (kWeightDegree<T> + 1) * lanes;
}

template <class T>
WeightTable<T> weight_table(const LobeLanes& lanes, double tolerance, Workers workers) {
  const Measure measure(lanes);
  for (const std::size_t nodes : {12U, 20U, 32U, 48U}) {
    const Octaves octaves(lanes, nodes, workers);
    const double octave_share = octave_error(octaves, lanes, measure, workers);
    if (octave_share > tolerance / 2) continue;
    for (int bits = 3; bits <= kMostPieceBits; ++bits) {
      if (table_bytes<T>(lanes, bits) > kMostBytes) return {};
      Pieces<T> pieces(octaves, lanes, measure, bits, workers);
      if (pieces.error + octave_share <= tolerance) return std::move(pieces.table);
    }
    return {};
  }
  return {};
}

template struct WeightTable<float>;
template struct WeightTable<double>;
template WeightTable<float> weight_table<float>(const LobeLanes&, double, Workers);
template WeightTable<double> weight_table<double>(const LobeLanes&, double, Workers);

}  // namespace clothbrdf
