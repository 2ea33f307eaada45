#include "fit/observations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "model/reflectance.h"
#include "support/errors.h"
#include "tabulate/factor_arc.h"

namespace clothbrdf {
namespace {

struct Node {
  double angle_deg;
  double weight;  // shares of 1
};

// Gauss-Legendre over a cell, or its node.
std::vector<Node> cell_nodes(const Axis& axis, int k, bool average) {
  if (!average) return {{axis.node_deg(k), 1}};
  const double low = axis.edge_deg(k);
  const double high = axis.edge_deg(k + 1);
  const double half = std::sqrt(0.6) / 2;
  std::vector<Node> nodes;
  nodes.reserve(kCellNodes);
  const double share[kCellNodes] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (int n = 0; n < kCellNodes; ++n) {
    nodes.push_back({low + (high - low) * (0.5 + (n - 1) * half), share[n]});
  }
  return nodes;
}

// What one pair of directions is multiplied by; 0 below the horizon.
double factor_at(Reflectance reflectance, bool folded, double h_n, double x, double cos_i,
                 double cos_o) {
  if (!(cos_i > 0) || !(cos_o > 0)) return 0;
  const double factor = directional_factor(reflectance, h_n, x, cos_i, cos_o);
  if (reflectance != Reflectance::kPaper || !folded) return factor;
  return (factor + directional_factor(reflectance, h_n, x, cos_o, cos_i)) / 2;
}

// The directional factor along the cells of phi_d, at one theta_h and theta_d.
class PhiCells {
 public:
  PhiCells(const Grid& grid, bool average, Reflectance reflectance)
      : folded_(grid.folds_orders()), reflectance_(reflectance) {
    const Axis& phi_d = grid.axes.back();
    for (int k = 0; k < phi_d.size; ++k) {
      if (!average) {
        cos_phi_.push_back(sincosd(phi_d.node_deg(k)).cos);
        continue;
      }
      // Arcs count chi from the right angle; beyond 180 degrees cos phi_d runs back.
      for (int e = 0; e <= 1; ++e) {
        const double phi = phi_d.edge_deg(k + e);
        const double chi = (phi > 180 ? phi - 270 : 90 - phi) * (pi<double>() / 180);
        edges_.emplace_back(std::clamp(chi, -pi<double>() / 2, pi<double>() / 2));
      }
      cos_phi_.push_back(std::max(edges_[edges_.size() - 2].sin, edges_.back().sin));
    }
  }

  // Whether the horizon cuts the k-th cell of a box of averages, or the box touches grazing
  // incidence: the node nearest to it does not tell. The corner with the largest angles is the
  // lowest one.
  bool cut(const SinCos<double>& highest_h, const SinCos<double>& highest_d, std::size_t k) const {
    return !edges_.empty() &&
           highest_h.cos * highest_d.cos <= highest_h.sin * highest_d.sin * cos_phi_[k];
  }

  // Adds to the measure of each cell above the horizon; of averages the integral of the factor,
  // by the same measure, goes to `factors`.
  void fill(const SinCos<double>& h, const SinCos<double>& d, double weight, double* factors,
            float* lower_cosines, double* measure) const {
    if (edges_.empty()) {
      for (std::size_t k = 0; k < cos_phi_.size(); ++k) {
        const IncidenceCosines<double> c = incidence_cosines(h, d, cos_phi_[k]);
        factors[k] = factor_at(reflectance_, folded_, h.cos, d.cos, c.i, c.o);
        lower_cosines[k] = static_cast<float>(std::min(c.i, c.o));
        measure[k] += factors[k] > 0 ? 1 : 0;
      }
      return;
    }
    const FactorArc arc(h, d);
    const double size = weight * h.sin * d.sin * d.cos;
    for (std::size_t k = 0; k < edges_.size() / 2; ++k) {
      const FactorArc::Edge& from = edges_[2 * k];
      const FactorArc::Edge& to = edges_[2 * k + 1];
      const FactorArc::Integral a = arc.from_right_angle(from);
      const FactorArc::Integral b = arc.from_right_angle(to);
      const double length = std::abs(b.length - a.length);
      factors[k] = size * std::abs(b.factor - a.factor);
      const IncidenceCosines<double> c = incidence_cosines(h, d, std::sin((from.chi + to.chi) / 2));
      lower_cosines[k] = static_cast<float>(std::min(c.i, c.o));
      measure[k] += size * length;
    }
  }

 private:
  bool folded_;
  Reflectance reflectance_;
  std::vector<double> cos_phi_;         // of the node; of averages the largest one's size
  std::vector<FactorArc::Edge> edges_;  // two a cell
};

void observe_half_difference(const TableSpec& spec, Reflectance reflectance, Observations& out) {
  const Grid& grid = spec.grid();
  const bool average = spec.cells.average;
  const bool with_phi_h = grid.kind == GridKind::kHalfDifference4d;
  const Axis& theta_h = grid.axes[0];
  const Axis& theta_d = grid.axes[grid.axes.size() - 2];
  const Axis& phi_d = grid.axes.back();

  const auto phi_h_count = static_cast<std::size_t>(with_phi_h ? grid.axes[1].size : 1);
  const auto d_count = static_cast<std::size_t>(theta_d.size);
  const auto samples = static_cast<std::size_t>(phi_d.size);
  out.value_stride = grid.column_count();

  std::vector<double> measure(samples);
  std::vector<std::vector<Node>> d_nodes;
  for (int d = 0; d < theta_d.size; ++d) {
    d_nodes.push_back(cell_nodes(theta_d, d, average));
    for (const Node& node : d_nodes.back()) {
      out.cos_theta_d.push_back(sincosd(node.angle_deg).cos);
    }
  }
  const PhiCells cells(grid, average, reflectance);
  for (int h = 0; h < theta_h.size; ++h) {
    const std::vector<Node> h_nodes = cell_nodes(theta_h, h, average);
    const std::size_t sites = h_nodes.size() * d_nodes[0].size();
    const std::size_t first_factor = out.factors.size();
    out.factors.resize(first_factor + d_count * sites * samples);
    out.lower_cosines.resize(out.factors.size());
    for (std::size_t d = 0; d < d_count; ++d) {
      double* const factors = out.factors.data() + first_factor + d * sites * samples;
      float* const lower_cosines = out.lower_cosines.data() + first_factor + d * sites * samples;
      std::size_t site = 0;
      std::fill(measure.begin(), measure.end(), 0.0);
      for (const Node& hn : h_nodes) {
        for (const Node& dn : d_nodes[d]) {
          cells.fill(sincosd(hn.angle_deg), sincosd(dn.angle_deg), hn.weight * dn.weight,
                     factors + site * samples, lower_cosines + site * samples, measure.data());
          ++site;
        }
      }
      const SinCos<double> highest_h = sincosd(theta_h.edge_deg(h + 1));
      const SinCos<double> highest_d = sincosd(theta_d.edge_deg(static_cast<int>(d) + 1));
      for (std::size_t p = 0; p < samples; ++p) {
        // No quadrature here follows the horizon through a cell.
        if (cells.cut(highest_h, highest_d, p)) measure[p] = 0;
        if (!(measure[p] > 0)) out.below_horizon += phi_h_count;
        for (std::size_t s = 0; average && s < sites; ++s) {
          factors[s * samples + p] = measure[p] > 0 ? factors[s * samples + p] / measure[p] : 0;
        }
      }
    }
    for (std::size_t p = 0; p < phi_h_count; ++p) {
      const std::size_t row = static_cast<std::size_t>(h) * phi_h_count + p;
      const std::size_t first_half = out.halves.size();
      for (const Node& hn : h_nodes) {
        const SinCos<double> th = sincosd(hn.angle_deg);
        HalfVector half{
            .kind = HalfVector::Kind::kCircle, .sin_theta = th.sin, .cos_theta = th.cos};
        if (with_phi_h) {
          const Axis& axis = grid.axes[1];
          const int k = static_cast<int>(p);
          const SinCos<double> phi = sincosd(axis.node_deg(k));
          half.cos_phi = phi.cos;
          half.sin_phi = phi.sin;
          half.kind = average ? HalfVector::Kind::kArc : HalfVector::Kind::kPoint;
          half.from = axis.edge_deg(k) * (pi<double>() / 180);
          half.to = axis.edge_deg(k + 1) * (pi<double>() / 180);
          if (average && half.to - half.from > pi<double>()) {
            half.kind = HalfVector::Kind::kCircle;
          }
        }
        out.halves.push_back(half);
      }
      const std::size_t first_group = out.groups.size();
      for (std::size_t d = 0; d < d_count; ++d) {
        const std::size_t first_site = out.sites.size();
        for (std::size_t hn = 0; hn < h_nodes.size(); ++hn) {
          for (std::size_t dn = 0; dn < d_nodes[d].size(); ++dn) {
            out.sites.push_back({static_cast<std::uint32_t>(first_half + hn),
                                 static_cast<std::uint32_t>(d * d_nodes[d].size() + dn)});
          }
        }
        out.groups.push_back({first_site, sites, first_factor + d * sites * samples, samples,
                              row * spec.row_values() + d * samples});
      }
      out.bundles.push_back({first_group, out.groups.size(), first_half, out.halves.size()});
    }
  }
}

// Sites of pairs of directions, before equal cos_theta_d are made one.
class PairSites {
 public:
  PairSites(const TableSpec& spec, Reflectance reflectance, Observations& out)
      : isotropic_(spec.isotropic()), reflectance_(reflectance), out_(out) {}

  // A cell by its pairs and their shares of it; nothing where all are below the horizon.
  void add_cell(const std::vector<std::pair<DirectionPair, double>>& pairs,
                std::size_t first_value) {
    const std::size_t first_site = out_.sites.size();
    const std::size_t first_factor = out_.factors.size();
    const std::size_t first_half = out_.halves.size();
    double measure = 0;
    for (const auto& [pair, weight] : pairs) {
      const PairGeometry<double> g = pair_geometry(pair, 0.0);
      if (!g.above_horizon()) {
        measure = -std::numeric_limits<double>::infinity();
        break;
      }
      const double sin_theta = std::hypot(g.h_weft, g.h_warp);
      HalfVector half{.sin_theta = sin_theta, .cos_theta = g.h_n};
      if (isotropic_) {
        half.kind = HalfVector::Kind::kCircle;
      } else if (sin_theta > 0) {
        half.cos_phi = g.h_weft / sin_theta;
        half.sin_phi = g.h_warp / sin_theta;
      } else {
        half.sin_phi = 0;
      }
      out_.sites.push_back({static_cast<std::uint32_t>(out_.halves.size()), 0});
      out_.halves.push_back(half);
      x_.push_back(g.cos_theta_d);
      out_.lower_cosines.push_back(static_cast<float>(std::min(g.cos_theta_i, g.cos_theta_o)));
      out_.factors.push_back(weight * directional_factor(reflectance_, g.h_n, g.cos_theta_d,
                                                         g.cos_theta_i, g.cos_theta_o));
      measure += weight;
    }
    if (!(measure > 0)) {
      out_.sites.resize(first_site);
      out_.halves.resize(first_half);
      out_.factors.resize(first_factor);
      out_.lower_cosines.resize(first_factor);
      x_.resize(first_site);
      ++out_.below_horizon;
      return;
    }
    for (std::size_t k = first_factor; k < out_.factors.size(); ++k) out_.factors[k] /= measure;
    const std::size_t sites = out_.sites.size() - first_site;
    out_.groups.push_back({first_site, sites, first_factor, 1, first_value});
    constexpr std::size_t kGroupsOfBundle = 256;
    if (out_.bundles.empty() ||
        out_.groups.size() - out_.bundles.back().first_group > kGroupsOfBundle) {
      out_.bundles.push_back({out_.groups.size() - 1, 0, first_half, 0});
    }
    out_.bundles.back().end_group = out_.groups.size();
    out_.bundles.back().end_half = out_.halves.size();
  }

  void join_equal_x() {
    std::vector<std::uint32_t> order(x_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return x_[a] < x_[b]; });
    constexpr double kSame = 1e-14;
    for (const std::uint32_t k : order) {
      if (out_.cos_theta_d.empty() || x_[k] - out_.cos_theta_d.back() > kSame) {
        out_.cos_theta_d.push_back(x_[k]);
      }
      out_.sites[k].x = static_cast<std::uint32_t>(out_.cos_theta_d.size() - 1);
    }
  }

 private:
  bool isotropic_;
  Reflectance reflectance_;
  Observations& out_;
  std::vector<double> x_;
};

void observe_in_out(const TableSpec& spec, Reflectance reflectance, Observations& out,
                    Workers workers) {
  const Grid& grid = spec.grid();
  out.value_stride = grid.column_count();
  PairSites sites(spec, reflectance, out);
  std::vector<std::pair<DirectionPair, double>> pairs;
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    if (cell % 4096 == 0) workers.check();
    const std::array<int, 4> k = grid.indices(cell);
    std::vector<Node> nodes[4];
    for (std::size_t a = 0; a < 4; ++a) {
      nodes[a] = cell_nodes(grid.axes[a], k[a], spec.cells.average);
    }
    pairs.clear();
    for (const Node& ti : nodes[0]) {
      for (const Node& pi : nodes[1]) {
        for (const Node& to : nodes[2]) {
          for (const Node& po : nodes[3]) {
            double weight = 1;
            if (spec.cells.average) {
              weight = ti.weight * pi.weight * to.weight * po.weight * sincosd(ti.angle_deg).sin *
                       sincosd(to.angle_deg).sin;
            }
            pairs.push_back({{ti.angle_deg, pi.angle_deg, to.angle_deg, po.angle_deg}, weight});
          }
        }
      }
    }
    const std::size_t columns = grid.column_count();
    sites.add_cell(pairs, cell / columns * spec.row_values() + cell % columns);
  }
  sites.join_equal_x();
}

}  // namespace

Observations observe(const TableSpec& spec, Reflectance reflectance, Workers workers) {
  if (spec.cells.average && reflectance == Reflectance::kPaper) {
    throw InputError("averaged cells: the means of the paper's convention diverge");
  }
  Observations out;
  out.channels = spec.channels.size();
  if (!spec.has_grid()) {
    PairSites sites(spec, reflectance, out);
    out.value_stride = 1;
    // An irrational step favours no part of an ordered list.
    const double step =
        std::max(1.0, static_cast<double>(spec.pairs().size()) / kMostPairs * 1.0000618);
    for (double next = 0; next < static_cast<double>(spec.pairs().size()); next += step) {
      const auto k = static_cast<std::size_t>(next);
      sites.add_cell({{spec.pairs()[k], 1.0}}, k * spec.row_values());
    }
    sites.join_equal_x();
  } else if (spec.grid().kind == GridKind::kInOut) {
    observe_in_out(spec, reflectance, out, workers);
  } else {
    observe_half_difference(spec, reflectance, out);
  }
  return out;
}

Observations thinned(const Observations& all, std::size_t most_x, std::size_t most_groups) {
  constexpr std::uint32_t kGone = ~0U;
  // The cos_theta_d of each group (the first of its sites stands for it) that stay, evenly over
  // those that are sorted by value.
  const auto x_of = [&](const Observations::Group& group) { return all.sites[group.first_site].x; };
  const auto visible = [&](const Observations::Group& group) {
    const auto first = all.factors.begin() + static_cast<std::ptrdiff_t>(group.first_factor);
    return std::any_of(first, first + static_cast<std::ptrdiff_t>(group.samples),
                       [](double factor) { return factor > 0; });
  };
  std::vector<std::uint32_t> order;
  for (const Observations::Group& group : all.groups) {
    if (visible(group)) order.push_back(x_of(group));
  }
  const auto higher = [&](std::uint32_t a, std::uint32_t b) {
    return all.cos_theta_d[a] > all.cos_theta_d[b];
  };
  std::sort(order.begin(), order.end(), higher);
  order.erase(std::unique(order.begin(), order.end()), order.end());
  std::vector<bool> stays(all.cos_theta_d.size(), false);
  const std::size_t x_count = std::min(most_x, order.size());
  for (std::size_t k = 0; k < x_count; ++k) {
    stays[order[x_count == 1 ? 0 : k * (order.size() - 1) / (x_count - 1)]] = true;
  }
  std::vector<std::size_t> candidates;
  for (std::size_t g = 0; g < all.groups.size(); ++g) {
    if (stays[x_of(all.groups[g])] && visible(all.groups[g])) candidates.push_back(g);
  }
  // An irrational step favours no angle of a regular grid.
  const double step =
      candidates.size() <= most_groups
          ? 1
          : static_cast<double>(candidates.size()) / static_cast<double>(most_groups) * 1.0000618;

  Observations few;
  few.value_stride = all.value_stride;
  few.channels = all.channels;
  std::vector<std::uint32_t> half_at(all.halves.size(), kGone);
  std::vector<std::uint32_t> x_at(all.cos_theta_d.size(), kGone);
  for (double next = 0; next < static_cast<double>(candidates.size()); next += step) {
    const Observations::Group& group = all.groups[candidates[static_cast<std::size_t>(next)]];
    Observations::Group copy = group;
    copy.first_site = few.sites.size();
    copy.first_factor = few.factors.size();
    for (std::size_t s = 0; s < group.sites; ++s) {
      const Observations::Site& site = all.sites[group.first_site + s];
      if (half_at[site.half] == kGone) {
        half_at[site.half] = static_cast<std::uint32_t>(few.halves.size());
        few.halves.push_back(all.halves[site.half]);
      }
      if (x_at[site.x] == kGone) {
        x_at[site.x] = static_cast<std::uint32_t>(few.cos_theta_d.size());
        few.cos_theta_d.push_back(all.cos_theta_d[site.x]);
      }
      few.sites.push_back({half_at[site.half], x_at[site.x]});
    }
    const auto from = all.factors.begin() + static_cast<std::ptrdiff_t>(group.first_factor);
    few.factors.insert(few.factors.end(), from,
                       from + static_cast<std::ptrdiff_t>(group.sites * group.samples));
    few.groups.push_back(copy);
  }
  few.bundles.push_back({0, few.groups.size(), 0, few.halves.size()});
  return few;
}

}  // namespace clothbrdf
