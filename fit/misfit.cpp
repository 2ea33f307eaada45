#include "fit/misfit.h"

#include <ceres/jet.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "model/reflectance.h"
#include "support/threads.h"
#include "tabulate/vectorise.h"

namespace clothbrdf {
namespace {

// A row of the derivative and its residual, padded to whole vector registers.
constexpr std::size_t kResidual = kLocalColumns;
constexpr std::size_t kWidth = (kLocalColumns + 1 + 3) / 4 * 4;
using Row = std::array<double, kWidth>;

// Sums of products over the lanes of one yarn.
struct LaneSums {
  double specular, by_along_s, by_across_s, by_rotation_s, by_index_s;
  double internal, by_along, by_across, by_rotation, by_absorption, by_index, by_scatter;
};

CLOTHBRDF_VECTORISE void sum_lanes(const double* density, const double* weight, std::size_t stride,
                                   LaneSums& sums) {
  const double* const a = density + LobeBasis::kByAlong * stride;
  const double* const b = density + LobeBasis::kByAcross * stride;
  const double* const r = density + LobeBasis::kByRotation * stride;
  const double* const k = weight + PathBasis::kByAbsorption * stride;
  const double* const n = weight + PathBasis::kByIndex * stride;
  const double* const s = weight + PathBasis::kByScatter * stride;
  sums.specular = density[0] * weight[0];
  sums.by_along_s = a[0] * weight[0];
  sums.by_across_s = b[0] * weight[0];
  sums.by_rotation_s = r[0] * weight[0];
  sums.by_index_s = density[0] * n[0];
  constexpr std::size_t kLanes = 8;
  double total[7][kLanes] = {};
  for (std::size_t i = 1; i < stride; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double d = density[i + l];
      const double w = weight[i + l];
      total[0][l] += d * w;
      total[1][l] += a[i + l] * w;
      total[2][l] += b[i + l] * w;
      total[3][l] += r[i + l] * w;
      total[4][l] += d * k[i + l];
      total[5][l] += d * n[i + l];
      total[6][l] += d * s[i + l];
    }
  }
  double* const to[7] = {&sums.internal,      &sums.by_along, &sums.by_across, &sums.by_rotation,
                         &sums.by_absorption, &sums.by_index, &sums.by_scatter};
  for (std::size_t q = 0; q < 7; ++q) {
    double sum = 0;
    for (const double lane : total[q]) sum += lane;
    *to[q] = sum;
  }
}

CLOTHBRDF_VECTORISE double sum_values(const double* density, const double* weight,
                                      std::size_t stride) {
  constexpr std::size_t kLanes = 8;
  double total[kLanes] = {};
  for (std::size_t i = 1; i < stride; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) total[l] += density[i + l] * weight[i + l];
  }
  double sum = 0;
  for (const double lane : total) sum += lane;
  return sum;
}

CLOTHBRDF_VECTORISE void add_products(const double* row, double* products) {
  for (std::size_t i = 0; i <= kResidual; ++i) {
    for (std::size_t j = 0; j < kWidth; ++j) products[i * kWidth + j] += row[i] * row[j];
  }
}

CLOTHBRDF_VECTORISE void add_scaled(double* to, const double* from, double times) {
  for (std::size_t j = 0; j < kWidth; ++j) to[j] += times * from[j];
}

// The parts of the model at one material that all sites share.
struct Prepared {
  const Material& material;
  std::size_t channels;
  std::array<double, 2> shares;
  std::array<LobeBasis, 2> lobes;
  std::array<PathBasis, 2> paths;
  std::vector<Row> diffuse;  // D in the place of the residual, and its derivatives

  Prepared(const Observations& observations, const Material& m, Exactness exactness, bool slopes,
           Workers workers)
      : material(m),
        channels(observations.channels),
        shares{m.warp_fraction, 1 - m.warp_fraction},
        lobes{LobeBasis(m.warp, m.paths, m.reflectance, exactness.tolerance),
              LobeBasis(m.weft, m.paths, m.reflectance, exactness.tolerance)},
        paths{PathBasis(m.warp, m.paths, lobes[0], observations.cos_theta_d, exactness.tolerance,
                        slopes, workers),
              PathBasis(m.weft, m.paths, lobes[1], observations.cos_theta_d, exactness.tolerance,
                        slopes, workers)} {
    for (std::size_t c = 0; c < channels; ++c) diffuse.push_back(diffuse_row(c));
  }

  Row diffuse_row(std::size_t channel) const {
    constexpr std::size_t kColumns[] = {kAbsorption, kYarnColumns + kAbsorption, kDiffuse,
                                        kDiffusePath, kFraction};
    using Jet = ceres::Jet<double, 5>;
    BasicMaterial<Jet> jets;
    jets.reflectance = material.reflectance;
    jets.warp.absorption = {Jet(material.warp.absorption[channel], 0)};
    jets.weft.absorption = {Jet(material.weft.absorption[channel], 1)};
    jets.weights.diffuse = Jet(material.weights.diffuse, 2);
    jets.diffuse_path = Jet(material.diffuse_path, 3);
    jets.warp_fraction = Jet(material.warp_fraction, 4);
    const Jet d = diffuse_reflectance(jets, {jets.warp_fraction, Jet(1) - jets.warp_fraction}, 0);
    Row row{};
    row[kResidual] = d.a;
    for (std::size_t k = 0; k < std::size(kColumns); ++k)
      row[kColumns[k]] = d.v[static_cast<int>(k)];
    return row;
  }
};

// Densities at the half vectors of a bundle: [yarn][half][quantity][lane].
class Densities {
 public:
  Densities(const Prepared& prepared, const Observations& observations,
            const Observations::Bundle& bundle, bool slopes)
      : first_(bundle.first_half) {
    const std::size_t quantities = slopes ? LobeBasis::kQuantities : 1;
    for (std::size_t y = 0; y < 2; ++y) {
      stride_[y] = prepared.paths[y].stride();
      step_[y] = quantities * stride_[y];
      values_[y].assign((bundle.end_half - first_) * step_[y], 0.0);
      for (std::size_t h = first_; h < bundle.end_half; ++h) {
        prepared.lobes[y].densities(
            observations.halves[h], y, prepared.material.rotation_deg, slopes,
            std::span(values_[y]).subspan((h - first_) * step_[y], step_[y]), stride_[y]);
      }
    }
  }
  const double* at(std::size_t yarn, std::size_t half) const {
    return values_[yarn].data() + (half - first_) * step_[yarn];
  }

 private:
  std::size_t first_;
  std::array<std::size_t, 2> stride_{}, step_{};
  std::array<std::vector<double>, 2> values_;
};

double site_value(const Prepared& prepared, const Densities& densities,
                  const Observations::Site& site, std::size_t channel) {
  double sum = 0;
  for (std::size_t y = 0; y < 2; ++y) {
    const double* const density = densities.at(y, site.half);
    const double* const weight = prepared.paths[y].at(site.x, channel);
    const auto& k = prepared.material.weights;
    sum +=
        prepared.shares[y] * (k.specular * density[0] * weight[0] +
                              k.internal * sum_values(density, weight, prepared.paths[y].stride()));
  }
  return sum;
}

// B in the place of the residual, and its derivatives.
Row site_row(const Prepared& prepared, const Densities& densities, const Observations::Site& site,
             std::size_t channel) {
  Row row{};
  const double ks = prepared.material.weights.specular;
  const double ki = prepared.material.weights.internal;
  for (std::size_t y = 0; y < 2; ++y) {
    LaneSums s;
    sum_lanes(densities.at(y, site.half), prepared.paths[y].at(site.x, channel),
              prepared.paths[y].stride(), s);
    const double share = prepared.shares[y];
    double* const yarn = row.data() + y * kYarnColumns;
    yarn[kAlong] = share * (ks * s.by_along_s + ki * s.by_along);
    yarn[kAcross] = share * (ks * s.by_across_s + ki * s.by_across);
    yarn[kIndex] = share * (ks * s.by_index_s + ki * s.by_index);
    yarn[kScatter] = share * ki * s.by_scatter;
    yarn[kAbsorption] = share * ki * s.by_absorption;
    row[kRotation] += share * (ks * s.by_rotation_s + ki * s.by_rotation);
    row[kSpecular] += share * s.specular;
    row[kInternal] += share * s.internal;
    const double whole = ks * s.specular + ki * s.internal;
    row[kFraction] += y == 0 ? whole : -whole;
    row[kResidual] += share * whole;
  }
  return row;
}

// Calls take(channel, row) for every row of a bundle; the row's residual in its last place.
template <class Take>
void for_rows(const Prepared& prepared, const Observations& observations, const Rows& rows,
              std::size_t bundle, const Take& take) {
  const Densities densities(prepared, observations, observations.bundles[bundle], true);
  std::vector<Row> sites;
  for (std::size_t b = rows.bundle_block[bundle]; b < rows.bundle_block[bundle + 1]; ++b) {
    const Rows::Block& block = rows.blocks[b];
    const Observations::Group& group = observations.groups[block.group];
    sites.clear();
    for (std::size_t s = 0; s < group.sites; ++s) {
      sites.push_back(
          site_row(prepared, densities, observations.sites[group.first_site + s], block.channel));
    }
    const double* numbers = rows.numbers.data() + block.first;
    for (std::size_t r = 0; r < block.count; ++r) {
      Row row{};
      for (std::size_t s = 0; s < group.sites; ++s) {
        add_scaled(row.data(), sites[s].data(), numbers[s]);
      }
      add_scaled(row.data(), prepared.diffuse[block.channel].data(), numbers[group.sites]);
      row[kResidual] -= numbers[group.sites + 1];
      numbers += group.sites + 2;
      take(block.channel, row);
    }
  }
}

Row diffuse_rows(const Prepared& prepared, const Rows& rows, std::size_t channel) {
  Row row{};
  add_scaled(row.data(), prepared.diffuse[channel].data(), rows.diffuse[channel].coefficient);
  row[kResidual] -= rows.diffuse[channel].target;
  return row;
}

// Runs work(chunk, first bundle, end bundle) over a fixed number of chunks, whatever the threads.
constexpr std::size_t kChunks = 16;
template <class Work>
void for_chunks(std::size_t bundles, Workers workers, const Work& work) {
  const std::size_t chunks = std::min(bundles, kChunks);
  const auto run = [&](std::size_t chunk) {
    workers.check();
    work(chunk, chunk * bundles / chunks, (chunk + 1) * bundles / chunks);
  };
  run_parallel(chunks, workers, run);
}

using Products =
    Eigen::Matrix<double, static_cast<int>(kWidth), static_cast<int>(kWidth), Eigen::RowMajor>;

// From a channel's columns to the free coordinates; the residual stays last.
Eigen::MatrixXd column_map(const ParameterSet& set, const Material& material, std::size_t channel) {
  const auto free = static_cast<Eigen::Index>(set.free().size());
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(kWidth), free + 1);
  for (const ParameterSet::Slope& slope : set.slopes(material, channel)) {
    map(static_cast<Eigen::Index>(slope.column), static_cast<Eigen::Index>(slope.free)) +=
        slope.scale;
  }
  map(static_cast<Eigen::Index>(kResidual), free) = 1;
  return map;
}

}  // namespace

double Misfit::cost(const Material& material) const {
  const Prepared prepared(observations_, material, exactness_, false, workers_);
  std::array<double, kChunks> sums{};
  for_chunks(
      observations_.bundles.size(), workers_,
      [&](std::size_t chunk, std::size_t first, std::size_t end) {
        double sum = 0;
        std::vector<double> sites;
        for (std::size_t u = first; u < end; ++u) {
          const Densities densities(prepared, observations_, observations_.bundles[u], false);
          for (std::size_t b = rows_.bundle_block[u]; b < rows_.bundle_block[u + 1]; ++b) {
            const Rows::Block& block = rows_.blocks[b];
            const Observations::Group& group = observations_.groups[block.group];
            sites.clear();
            for (std::size_t s = 0; s < group.sites; ++s) {
              sites.push_back(site_value(prepared, densities,
                                         observations_.sites[group.first_site + s], block.channel));
            }
            const double d = prepared.diffuse[block.channel][kResidual];
            const double* numbers = rows_.numbers.data() + block.first;
            for (std::size_t r = 0; r < block.count; ++r) {
              double residual = numbers[group.sites] * d - numbers[group.sites + 1];
              for (std::size_t s = 0; s < group.sites; ++s) residual += numbers[s] * sites[s];
              sum += residual * residual;
              numbers += group.sites + 2;
            }
          }
        }
        sums[chunk] = sum;
      });
  double total = 0;
  for (const double sum : sums) total += sum;
  for (std::size_t c = 0; c < observations_.channels; ++c) {
    const double residual =
        rows_.diffuse[c].coefficient * prepared.diffuse[c][kResidual] - rows_.diffuse[c].target;
    total += residual * residual;
  }
  return total;
}

Eigen::MatrixXd Misfit::products(const Material& material, const ParameterSet& set) const {
  const Prepared prepared(observations_, material, exactness_, true, workers_);
  const std::size_t channels = observations_.channels;
  std::vector<Products> sums(kChunks * channels, Products::Zero());
  for_chunks(observations_.bundles.size(), workers_,
             [&](std::size_t chunk, std::size_t first, std::size_t end) {
               for (std::size_t u = first; u < end; ++u) {
                 for_rows(prepared, observations_, rows_, u,
                          [&](std::size_t channel, const Row& row) {
                            add_products(row.data(), sums[chunk * channels + channel].data());
                          });
               }
             });
  const auto size = static_cast<Eigen::Index>(set.free().size()) + 1;
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t c = 0; c < channels; ++c) {
    Products sum = Products::Zero();
    for (std::size_t chunk = 0; chunk < kChunks; ++chunk) sum += sums[chunk * channels + c];
    add_products(diffuse_rows(prepared, rows_, c).data(), sum.data());
    const Eigen::MatrixXd map = column_map(set, material, c);
    total += map.transpose() * sum * map;
  }
  return total;
}

Eigen::MatrixXd Misfit::triangle(const Material& material, const ParameterSet& set) const {
  const Prepared prepared(observations_, material, exactness_, true, workers_);
  const std::size_t channels = observations_.channels;
  const auto width = static_cast<Eigen::Index>(kWidth);
  constexpr Eigen::Index kBatch = 256;
  // For each channel a stack of rows above which lies the factor of all rows before them.
  struct Stack {
    Eigen::MatrixXd rows;
    Eigen::Index filled = 0;
    void reduce() {
      const Eigen::Index size = rows.cols();
      const Eigen::MatrixXd r = Eigen::HouseholderQR<Eigen::MatrixXd>(rows.topRows(filled))
                                    .matrixQR()
                                    .topRows(std::min(size, filled))
                                    .triangularView<Eigen::Upper>();
      rows.topRows(r.rows()) = r;
      filled = r.rows();
    }
    void add(const double* row) {
      if (filled == rows.rows()) reduce();
      rows.row(filled++) = Eigen::Map<const Eigen::RowVectorXd>(row, rows.cols());
    }
  };
  std::vector<Stack> stacks(kChunks * channels);
  for (Stack& stack : stacks) stack.rows.resize(kBatch, width);
  for_chunks(observations_.bundles.size(), workers_,
             [&](std::size_t chunk, std::size_t first, std::size_t end) {
               for (std::size_t u = first; u < end; ++u) {
                 for_rows(prepared, observations_, rows_, u,
                          [&](std::size_t channel, const Row& row) {
                            stacks[chunk * channels + channel].add(row.data());
                          });
               }
             });
  const auto size = static_cast<Eigen::Index>(set.free().size()) + 1;
  Eigen::Index count = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    stacks[c].add(diffuse_rows(prepared, rows_, c).data());
  }
  for (const Stack& stack : stacks) count += stack.filled;
  Eigen::MatrixXd all(std::max(count, size), size);
  all.setZero();
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < stacks.size(); ++k) {
    const Eigen::MatrixXd map = column_map(set, material, k % channels);
    all.middleRows(at, stacks[k].filled) = stacks[k].rows.topRows(stacks[k].filled) * map;
    at += stacks[k].filled;
  }
  return Eigen::HouseholderQR<Eigen::MatrixXd>(all)
      .matrixQR()
      .topRows(size)
      .triangularView<Eigen::Upper>();
}

std::vector<double> Misfit::residuals(const Material& material, const ParameterSet& set,
                                      Eigen::MatrixXd* slopes) const {
  const Prepared prepared(observations_, material, exactness_, true, workers_);
  std::vector<double> residuals;
  const auto free = static_cast<Eigen::Index>(set.free().size());
  if (slopes != nullptr) slopes->setZero(static_cast<Eigen::Index>(rows_.row_count()), free);
  std::vector<Eigen::MatrixXd> maps;
  for (std::size_t c = 0; c < observations_.channels; ++c) {
    maps.push_back(column_map(set, material, c));
  }
  const auto take = [&](std::size_t channel, const Row& row) {
    if (slopes != nullptr) {
      slopes->row(static_cast<Eigen::Index>(residuals.size())) =
          Eigen::Map<const Eigen::RowVectorXd>(row.data(), static_cast<Eigen::Index>(kWidth)) *
          maps[channel].leftCols(free);
    }
    residuals.push_back(row[kResidual]);
  };
  for (std::size_t u = 0; u < observations_.bundles.size(); ++u) {
    for_rows(prepared, observations_, rows_, u, take);
  }
  for (std::size_t c = 0; c < observations_.channels; ++c) {
    take(c, diffuse_rows(prepared, rows_, c));
  }
  return residuals;
}

ModelValues model_values(const Observations& observations, const Material& material,
                         Exactness exactness, Workers workers) {
  const Prepared prepared(observations, material, exactness, false, workers);
  ModelValues values;
  values.site.resize(observations.sites.size() * observations.channels);
  for_chunks(observations.bundles.size(), workers,
             [&](std::size_t, std::size_t first, std::size_t end) {
               for (std::size_t u = first; u < end; ++u) {
                 const Observations::Bundle& bundle = observations.bundles[u];
                 const Densities densities(prepared, observations, bundle, false);
                 for (std::size_t g = bundle.first_group; g < bundle.end_group; ++g) {
                   const Observations::Group& group = observations.groups[g];
                   for (std::size_t s = group.first_site; s < group.first_site + group.sites; ++s) {
                     for (std::size_t c = 0; c < observations.channels; ++c) {
                       values.site[s * observations.channels + c] =
                           site_value(prepared, densities, observations.sites[s], c);
                     }
                   }
                 }
               }
             });
  for (const Row& row : prepared.diffuse) values.diffuse.push_back(row[kResidual]);
  return values;
}

}  // namespace clothbrdf
