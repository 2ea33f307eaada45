#include "fit/rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/threads.h"
#include "tabulate/dot.h"
#include "tabulate/vectorise.h"

namespace clothbrdf {
namespace {

CLOTHBRDF_VECTORISE void subtract(double* a, const double* b, double times, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) a[i] -= times * b[i];
}

// The fitted values of a group: those of its sites, by their factors, and the diffuse term.
CLOTHBRDF_VECTORISE void add_site(const double* factors, double value, std::size_t count,
                                  double* fitted) {
  for (std::size_t i = 0; i < count; ++i) fitted[i] += factors[i] * value;
}

CLOTHBRDF_VECTORISE void relative_weights(const double* fitted, double floor, std::size_t count,
                                          double* root_weights) {
  for (std::size_t i = 0; i < count; ++i) {
    root_weights[i] = 1 / (fitted[i] > floor ? fitted[i] : floor);
  }
}

// What a bundle adds to the rows; joined in order, so that sums do not depend on the threads.
struct BundlePart {
  std::vector<Rows::Block> blocks;
  std::vector<double> numbers;
  std::vector<Rows::Diffuse> diffuse;
  double constant = 0;
  double target_square = 0;
  std::size_t values = 0;
  std::size_t masked = 0;
};

class BundleRows {
 public:
  BundleRows(const Observations& observations, const ValueSource& source, const RowWeights& weights,
             const ModelValues* fit, double floor, bool reduce, BundlePart& part)
      : observations_(observations),
        source_(source),
        weights_(weights),
        fit_(fit),
        floor_(floor),
        reduce_(reduce),
        part_(part) {
    part_.diffuse.resize(observations.channels);
  }

  void add(std::size_t group_index, std::size_t channel) {
    group_ = &observations_.groups[group_index];
    const std::size_t samples = group_->samples;
    values_.resize(samples);
    source_(group_index, channel, values_);
    keep_measured();
    if (count_ == 0) return;
    fitted_values(channel);
    weigh();
    part_.values += count_;
    part_.target_square += dot(columns_.back().data(), columns_.back().data(), count_);
    const auto first = part_.numbers.size();
    const std::size_t rows = reduce_ ? reduced_rows(channel) : all_rows();
    if (rows > 0) {
      part_.blocks.push_back({static_cast<std::uint32_t>(group_index),
                              static_cast<std::uint32_t>(channel), static_cast<std::uint32_t>(rows),
                              first});
    }
  }

 private:
  // columns_ become the factors of each site, 1 and the value, of the measured samples.
  void keep_measured() {
    const std::size_t sites = group_->sites;
    const std::size_t samples = group_->samples;
    columns_.resize(sites + 2);
    for (std::vector<double>& column : columns_) column.resize(samples);
    count_ = 0;
    const double* const factors = observations_.factors.data() + group_->first_factor;
    const bool log = weights_.weighting == Weighting::kLogarithmic;
    for (std::size_t k = 0; k < samples; ++k) {
      bool above = false;
      for (std::size_t s = 0; s < sites; ++s) above = above || factors[s * samples + k] > 0;
      if (!above) continue;
      const double value = values_[k];
      if (!std::isfinite(value) || value < 0 || (log && value == 0)) {
        ++part_.masked;
        continue;
      }
      for (std::size_t s = 0; s < sites; ++s) columns_[s][count_] = factors[s * samples + k];
      columns_[sites][count_] = 1;
      columns_[sites + 1][count_] = value;
      ++count_;
    }
  }

  void fitted_values(std::size_t channel) {
    const std::size_t sites = group_->sites;
    fitted_.assign(count_, fit_ != nullptr ? fit_->diffuse[channel] : 0.0);
    if (fit_ != nullptr) {
      for (std::size_t s = 0; s < sites; ++s) {
        const double value =
            fit_->site[(group_->first_site + s) * observations_.channels + channel];
        add_site(columns_[s].data(), value, count_, fitted_.data());
      }
    } else {
      smooth();
    }
  }

  // A straight line over the first site's factor, for want of a fit; not far below the mean.
  void smooth() {
    const std::vector<double>& value = columns_.back();
    const std::vector<double>& factor = columns_.front();
    double mean_value = 0;
    double mean_factor = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      mean_value += value[k];
      mean_factor += factor[k];
    }
    mean_value /= static_cast<double>(count_);
    mean_factor /= static_cast<double>(count_);
    double square = 0;
    double product = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      square += (factor[k] - mean_factor) * (factor[k] - mean_factor);
      product += (factor[k] - mean_factor) * (value[k] - mean_value);
    }
    const double slope = count_ > 3 && square > 0 ? product / square : 0;
    constexpr double kLowest = 0.1;
    for (std::size_t k = 0; k < count_; ++k) {
      fitted_[k] = std::max(mean_value + slope * (factor[k] - mean_factor), kLowest * mean_value);
    }
  }

  void weigh() {
    root_weights_.resize(count_);
    std::vector<double>& value = columns_.back();
    if (weights_.weighting == Weighting::kAbsolute) {
      std::fill(root_weights_.begin(), root_weights_.end(), 1.0);
    } else {
      relative_weights(fitted_.data(), floor_, count_, root_weights_.data());
    }
    if (weights_.weighting == Weighting::kLogarithmic) {
      // With these values the weighted residual's derivative is that of log(fit / value).
      for (std::size_t k = 0; k < count_; ++k) {
        const double fitted = std::max(fitted_[k], floor_);
        value[k] = fitted * (1 + std::log(value[k] / fitted));
      }
    }
    if (weights_.loss != Loss::kSquared && weights_.noise > 0) {
      for (std::size_t k = 0; k < count_; ++k) {
        const double r = std::abs(value[k] - fitted_[k]) * root_weights_[k] / weights_.noise;
        constexpr double kHuberScale = 1.345;
        constexpr double kCauchyScale = 2.385;
        if (weights_.loss == Loss::kHuber) {
          if (r > kHuberScale) root_weights_[k] *= std::sqrt(kHuberScale / r);
        } else {
          root_weights_[k] /= std::hypot(1, r / kCauchyScale);
        }
      }
    }
    for (std::vector<double>& column : columns_) {
      for (std::size_t k = 0; k < count_; ++k) column[k] *= root_weights_[k];
    }
  }

  std::size_t all_rows() {
    for (std::size_t k = 0; k < count_; ++k) {
      for (const std::vector<double>& column : columns_) part_.numbers.push_back(column[k]);
    }
    return count_;
  }

  // Modified Gram-Schmidt over the sites' columns, then that of D, then the values.
  std::size_t reduced_rows(std::size_t channel) {
    const std::size_t width = columns_.size();
    std::size_t rows = 0;
    for (std::size_t k = 0; k + 1 < width; ++k) {
      double* const q = columns_[k].data();
      const double norm = std::sqrt(dot(q, q, count_));
      constexpr double kRounding = 1e-13;
      // What is left of a column that depends on those before it says nothing.
      if (!(norm > kRounding * column_size(k))) continue;
      for (std::size_t i = 0; i < count_; ++i) q[i] /= norm;
      const bool last = k + 2 == width;
      if (!last) part_.numbers.insert(part_.numbers.end(), k, 0.0);
      if (!last) part_.numbers.push_back(norm);
      for (std::size_t j = k + 1; j < width; ++j) {
        const double product = dot(q, columns_[j].data(), count_);
        subtract(columns_[j].data(), q, product, count_);
        if (!last) {
          part_.numbers.push_back(product);
        } else {  // a row of D alone: all of a channel are one
          part_.constant += part_.diffuse[channel].add({norm, product});
        }
      }
      if (!last) ++rows;
    }
    part_.constant += dot(columns_.back().data(), columns_.back().data(), count_);
    return rows;
  }

  // The size of a weighted column before anything was taken off.
  double column_size(std::size_t k) const {
    const double* const factors = observations_.factors.data() + group_->first_factor;
    if (k == group_->sites)
      return std::sqrt(dot(root_weights_.data(), root_weights_.data(), count_));
    double largest = 0;
    for (std::size_t i = 0; i < group_->samples; ++i) {
      largest = std::max(largest, factors[k * group_->samples + i]);
    }
    return largest * std::sqrt(dot(root_weights_.data(), root_weights_.data(), count_));
  }

  const Observations& observations_;
  const ValueSource& source_;
  RowWeights weights_;
  const ModelValues* fit_;
  double floor_;
  bool reduce_;
  BundlePart& part_;
  const Observations::Group* group_ = nullptr;
  std::size_t count_ = 0;
  std::vector<double> values_;
  std::vector<std::vector<double>> columns_;
  std::vector<double> fitted_;
  std::vector<double> root_weights_;
};

// Relative weights stop growing below this. With a fit only a black channel is that dark; without
// one it keeps single dark values from ruling.
double weight_floor(const Observations& observations, const ValueSource& source,
                    const ModelValues* fit) {
  constexpr double kSmallest = std::numeric_limits<double>::min();
  if (fit != nullptr) {
    double largest = 0;
    for (const double d : fit->diffuse) largest = std::max(largest, d);
    for (const double b : fit->site) largest = std::max(largest, b);
    return std::max(1e-9 * largest, kSmallest);
  }
  double sum = 0;
  std::size_t count = 0;
  std::vector<double> values;
  const std::size_t step = std::max<std::size_t>(1, observations.groups.size() / 1000);
  for (std::size_t g = 0; g < observations.groups.size(); g += step) {
    values.resize(observations.groups[g].samples);
    for (std::size_t c = 0; c < observations.channels; ++c) {
      source(g, c, values);
      for (const double v : values) {
        if (!std::isfinite(v) || !(v > 0)) continue;
        sum += std::log(v);
        ++count;
      }
    }
  }
  constexpr double kShare = 0.01;
  return count > 0 ? std::max(kShare * std::exp(sum / static_cast<double>(count)), kSmallest) : 1;
}

}  // namespace

double Rows::Diffuse::add(const Diffuse& row) {
  const double norm = std::hypot(coefficient, row.coefficient);
  if (!(norm > 0)) return row.target * row.target;
  const double left = (coefficient * row.target - row.coefficient * target) / norm;
  target = (coefficient * target + row.coefficient * row.target) / norm;
  coefficient = norm;
  return left * left;
}

std::size_t Rows::row_count() const {
  std::size_t count = diffuse.size();
  for (const Block& block : blocks) count += block.count;
  return count;
}

Rows make_rows(const Observations& observations, const ValueSource& source,
               const RowWeights& weights, const ModelValues* fit, bool reduce, Workers workers) {
  const double floor = weight_floor(observations, source, fit);
  std::vector<BundlePart> parts(observations.bundles.size());
  run_parallel(parts.size(), workers, [&](std::size_t b) {
    workers.check();
    const Observations::Bundle& bundle = observations.bundles[b];
    BundleRows rows(observations, source, weights, fit, floor, reduce, parts[b]);
    for (std::size_t g = bundle.first_group; g < bundle.end_group; ++g) {
      for (std::size_t c = 0; c < observations.channels; ++c) rows.add(g, c);
    }
  });
  Rows all;
  all.diffuse.resize(observations.channels);
  std::size_t numbers = 0;
  for (const BundlePart& part : parts) numbers += part.numbers.size();
  all.numbers.reserve(numbers);
  for (BundlePart& part : parts) {
    all.bundle_block.push_back(all.blocks.size());
    for (Rows::Block block : part.blocks) {
      block.first += all.numbers.size();
      all.blocks.push_back(block);
    }
    all.numbers.insert(all.numbers.end(), part.numbers.begin(), part.numbers.end());
    for (std::size_t c = 0; c < all.diffuse.size(); ++c) {
      all.constant += all.diffuse[c].add(part.diffuse[c]);
    }
    all.constant += part.constant;
    all.target_square += part.target_square;
    all.values += part.values;
    all.masked += part.masked;
    part = BundlePart();
  }
  all.bundle_block.push_back(all.blocks.size());
  return all;
}

}  // namespace clothbrdf
