#pragma once

#include <span>
#include <vector>

#include "model/reflectance.h"
#include "support/progress.h"

namespace clothbrdf {

/// The separable structure of the model (model.md section 8.1): apart from the directional factor
/// and the diffuse term, f depends on the half vector through lobe densities and on cos_theta_d
/// through path weights. f is
///
///     factor(wi, wo) * sum_j density_j(h) * weight_j(cos_theta_d) + diffuse
///
/// with k_s and k_i in the weights, yarn shares and lobe norms in the densities. Equal yarns share
/// their weights, and their densities are added.
class PathMatrix {
 public:
  /// Weights at the given incidence cosines, computed by the workers. Keeps a reference to the
  /// model. Throws Cancelled.
  PathMatrix(const ClothModel<double>& model, std::vector<double> cos_theta_d, Workers workers);

  /// Number of incidence cosines.
  std::size_t size() const { return size_; }

  /// Length of a density vector.
  std::size_t lobe_count() const { return lobe_count_; }

  /// Lobe densities at a half vector of the weave's frame.
  void densities(double h_weft, double h_warp, double h_n, std::span<double> density) const;

  /// Their mean over the azimuth of h.
  void mean_densities(const SinCos<double>& theta_h, std::span<double> density) const;

  /// Their mean over azimuths of h from `from` to `to`, radians in the weave's frame (0 = along the
  /// weft), at most pi apart.
  void mean_densities(const SinCos<double>& theta_h, double from, double to,
                      std::span<double> density) const;

  /// The sums over lobes for one half vector at the incidence cosines first, first + 1, ...:
  /// specular[k] and internal[colour][k].
  void sums(std::span<const double> density, std::size_t first, std::span<double> specular,
            std::span<double> internal) const;

 private:
  std::size_t distinct_yarns() const { return model_->equal_yarns() ? 1 : model_->yarns().size(); }
  void fill_weights(std::size_t k, double cos_theta_d);
  template <class LobeDensity>
  void fill_densities(std::span<double> density, const LobeDensity& lobe_density) const;

  const ClothModel<double>* model_;
  std::size_t size_;
  std::size_t lobe_count_ = 0;
  // [k][colour][lobe]. Lobes: the surface reflection of each yarn, then the other lobes of each.
  std::vector<double> weights_;
};

}  // namespace clothbrdf
