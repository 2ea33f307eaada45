#include "tabulate/path_matrix.h"

#include <algorithm>

#include "support/threads.h"
#include "tabulate/dot.h"

namespace clothbrdf {

PathMatrix::PathMatrix(const ClothModel<double>& model, std::vector<double> cos_theta_d,
                       Workers workers)
    : model_(&model), size_(cos_theta_d.size()) {
  for (std::size_t y = 0; y < distinct_yarns(); ++y) lobe_count_ += model.yarns()[y].lobes.size();
  weights_.resize(cos_theta_d.size() * model.channel_count() * lobe_count_);
  with_threads(workers.threads, [&] {
    run_parallel(cos_theta_d.size(), workers, [&](std::size_t k) {
      workers.check();
      fill_weights(k, cos_theta_d[k]);
    });
  });
}

void PathMatrix::fill_weights(std::size_t k, double cos_theta_d) {
  const Weights& weights = model_->material().weights;
  std::vector<double> path;
  for (std::size_t c = 0; c < model_->channel_count(); ++c) {
    double* const to = weights_.data() + (k * model_->channel_count() + c) * lobe_count_;
    double* next = to + distinct_yarns();
    for (std::size_t y = 0; y < distinct_yarns(); ++y) {
      const PreparedYarn<double>& yarn = model_->yarns()[y];
      path.resize(yarn.lobes.size());
      path_weights(yarn.yarn, yarn.paths,
                   fresnel(model_->incidence_cosine(cos_theta_d), yarn.yarn.refractive_index),
                   yarn.yarn.absorption[c], std::span<double>(path));
      to[y] = path[0] * weights.specular;
      next = std::transform(path.begin() + 1, path.end(), next,
                            [&](double w) { return w * weights.internal; });
    }
  }
}

template <class LobeDensity>
void PathMatrix::fill_densities(std::span<double> density, const LobeDensity& lobe_density) const {
  std::size_t next = distinct_yarns();
  for (std::size_t y = 0; y < model_->yarns().size(); ++y) {
    const PreparedYarn<double>& yarn = model_->yarns()[y];
    const bool add = model_->equal_yarns() && y == 1;
    if (add) next = 1;
    for (std::size_t j = 0; j < yarn.lobes.size(); ++j) {
      const Lobe<double>& lobe = yarn.lobes[j];
      double& to = density[j > 0 ? next++ : (add ? 0 : y)];
      to = (add ? to : 0) + yarn.share * lobe_density(yarn, lobe.axes) / lobe.norm;
    }
  }
}

void PathMatrix::densities(double h_weft, double h_warp, double h_n,
                           std::span<double> density) const {
  fill_densities(density, [&](const PreparedYarn<double>& yarn, const LobeAxes<double>& axes) {
    return model_->height(yarn, axes, h_weft, h_warp, h_n);
  });
}

void PathMatrix::mean_densities(const SinCos<double>& theta_h, std::span<double> density) const {
  fill_densities(density, [&](const PreparedYarn<double>&, const LobeAxes<double>& axes) {
    return lobe_azimuthal_mean(theta_h.sin, theta_h.cos, axes);
  });
}

void PathMatrix::mean_densities(const SinCos<double>& theta_h, double from, double to,
                                std::span<double> density) const {
  if (!model_->effects().anisotropy) {
    mean_densities(theta_h, density);
    return;
  }
  fill_densities(density, [&](const PreparedYarn<double>& yarn, const LobeAxes<double>& axes) {
    const double along =
        yarn.warp ? pi<double>() / 2 : 0.0;  // azimuth of the yarn: the warp lies along y
    return lobe_azimuthal_mean(theta_h.sin, theta_h.cos, axes, from - along, to - along);
  });
}

void PathMatrix::sums(std::span<const double> density, std::size_t first,
                      std::span<double> specular, std::span<double> internal) const {
  const std::size_t count = specular.size();
  const std::size_t colours = model_->channel_count();
  const std::size_t yarns = distinct_yarns();
  const double* weights = weights_.data() + first * colours * lobe_count_;
  for (std::size_t k = 0; k < count; ++k) {
    specular[k] = dot(density.data(), weights, yarns);
    for (std::size_t c = 0; c < colours; ++c) {
      internal[c * count + k] = dot(density.data() + yarns, weights + yarns, lobe_count_ - yarns);
      weights += lobe_count_;
    }
  }
}

}  // namespace clothbrdf
