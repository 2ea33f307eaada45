#include <array>
#include <boost/math/constants/constants.hpp>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "formats/format.h"
#include "formats/material_json.h"
#include "tabulate/model_producer.h"
#include "tests/catch.h"
#include "tests/reference/reference_model.h"
#include "tests/support/random_inputs.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

// Directions and colours lose at most a few hundred eps beside the horizon; 1e-12 is the promise.
constexpr double kMerlPromise = 1e-12;
constexpr int kCellsEach = 6667;  // three materials: 20,000 cells

Wide sine(const Wide& degrees) { return sin(degrees * boost::math::constants::pi<Wide>() / 180); }
Wide cosine(const Wide& degrees) { return cos(degrees * boost::math::constants::pi<Wide>() / 180); }

// The 50-digit azimuthal mean on MERL's nodes. What cells share is computed once: walks by
// theta_d, lobes by theta_h.
class MerlReference {
 public:
  explicit MerlReference(const Material& material) : material_(material) {
    for (int k = 0; k < 90; ++k) {
      by_theta_d_.push_back(walks((Wide(k) + Wide(0.5))));
      const Wide index = (Wide(k) + Wide(0.5)) / 90;
      by_theta_h_.push_back(lobes(index * index * 90));
    }
  }

  Wide light_cosine(int theta_h, int theta_d, int phi_d, int sign) const {
    const Lobes& h = by_theta_h_[static_cast<std::size_t>(theta_h)];
    const Walks& d = by_theta_d_[static_cast<std::size_t>(theta_d)];
    return h.cos * d.cos - sign * h.sin * d.sin * cosine(Wide(phi_d) + Wide(0.5));
  }

  Real f(int theta_h, int theta_d, int phi_d, std::size_t channel) const {
    const Wide c_i = light_cosine(theta_h, theta_d, phi_d, 1);
    const Wide c_o = light_cosine(theta_h, theta_d, phi_d, -1);
    if (c_i <= 0 || c_o <= 0) return 0;
    const Lobes& h = by_theta_h_[static_cast<std::size_t>(theta_h)];
    const Walks& d = by_theta_d_[static_cast<std::size_t>(theta_d)];
    Wide shadowing = 1;
    for (const Wide& c : {c_i, c_o}) shadowing = std::min(shadowing, Wide(2 * h.cos * c / d.cos));
    Real directional = 0;
    Real diffuse = 0;
    for (std::size_t y = 0; y < 2; ++y) {
      const Real share = y == 0 ? Real(material_.warp_fraction) : 1 - Real(material_.warp_fraction);
      const std::vector<Real>& weights = d.weights[y][channel];
      for (std::size_t e = 1; e < weights.size(); e += 2) {
        const double k = e == 1 ? material_.weights.specular : material_.weights.internal;
        directional += share * k * weights[e] * h.densities[y][e / 2];
      }
      const Yarn& yarn = y == 0 ? material_.warp : material_.weft;
      diffuse += share * material_.weights.diffuse *
                 exp(-Real(yarn.absorption[channel]) * Real(material_.diffuse_path));
    }
    return directional * Real(shadowing / (4 * c_i * c_o)) +
           diffuse / boost::math::constants::pi<Real>();
  }

 private:
  struct Walks {
    Wide sin;
    Wide cos;
    std::array<std::vector<std::vector<Real>>, 2> weights;  // [yarn][channel][E]
  };
  struct Lobes {
    Wide sin;
    Wide cos;
    std::array<std::vector<Real>, 2> densities;  // [yarn][(E - 1) / 2]
  };

  Walks walks(const Wide& theta_d) const {
    Walks result{sine(theta_d), cosine(theta_d), {}};
    for (std::size_t y = 0; y < 2; ++y) {
      const Yarn& yarn = y == 0 ? material_.warp : material_.weft;
      const ReferenceInterface interface = reference_fresnel(result.cos, yarn.refractive_index);
      for (const double absorption : yarn.absorption) {
        result.weights[y].push_back(
            reference_walk(yarn.layers, Real(interface.reflected),
                           reference_passage(absorption, Real(interface.cos_theta_t))));
      }
    }
    return result;
  }

  Lobes lobes(const Wide& theta_h) {
    Lobes result{sine(theta_h), cosine(theta_h), {}};
    for (std::size_t y = 0; y < 2; ++y) {
      const Yarn& yarn = y == 0 ? material_.warp : material_.weft;
      const Real a = yarn.lobe_axes[0];
      const Real b = yarn.lobe_axes[1];
      const Real c = yarn.scatter_limit ? Real(*yarn.scatter_limit) : std::max(a, b);
      Real q = 1;
      for (std::size_t j = 0; j <= 512; ++j) {
        const Real along = c - (c - a) * q;
        const Real across = c - (c - b) * q;
        if (integrals_[y].size() <= j) {
          integrals_[y].push_back(reference_lobe_integral(along, across));
        }
        const Real s(result.sin);
        const Real n(result.cos);
        // The mean of 1 / (A cos^2 + B sin^2) over a turn is 1 / sqrt(A B).
        const Real big_a = s * s / (along * along) + n * n;
        const Real big_b = s * s / (across * across) + n * n;
        result.densities[y].push_back(n / sqrt(Real(big_a * big_b)) / integrals_[y][j]);
        const Real kept = 1 - Real(yarn.scatter);
        q *= kept * kept;
      }
    }
    return result;
  }

  const Material& material_;
  std::vector<Walks> by_theta_d_;
  std::vector<Lobes> by_theta_h_;
  std::array<std::vector<Real>, 2> integrals_;
};

double stored(const std::string& file, int theta_h, int theta_d, int phi_d, std::size_t channel) {
  const std::size_t index = static_cast<std::size_t>((theta_h * 90 + theta_d) * 180 + phi_d);
  double value = 0;
  std::memcpy(&value, file.data() + 12 + 8 * (channel * 1458000 + index), sizeof value);
  return value;
}

}  // namespace

TEST_CASE("20000 random cells of MERL files hold the azimuthal mean at their centres to 1e-12") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  const std::array<double, 3> scale = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
  int visible = 0;
  int below = 0;
  for (const char* name : {"silk", "cotton", "tamamushi"}) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "table.binary";
    const Material material = read_material(preset(name));
    AtomicFile file(path);
    format_for(path).write(*make_producer(material_spec(material, {}, halfdiff3d()), 1), file, {});
    file.commit();
    const std::string bytes = read_file(path);
    REQUIRE(bytes.size() == 34992012);
    const std::array<std::int32_t, 3> sizes = {90, 90, 180};
    REQUIRE(std::memcmp(bytes.data(), sizes.data(), sizeof sizes) == 0);

    const MerlReference reference(material);
    double worst = 0;
    std::string where;
    for (int n = 0; n < kCellsEach; ++n) {
      const int h = random.integer(0, 89);
      const int d = random.integer(0, 89);
      const int p = random.integer(0, 179);
      const auto channel = static_cast<std::size_t>(random.integer(0, 2));
      const Real exact = reference.f(h, d, p, channel);
      const double value = stored(bytes, h, d, p, channel);
      if (exact == 0) {
        CHECK(value == 0);
        ++below;
        continue;
      }
      ++visible;
      const auto error = static_cast<double>(abs(Real(value) * Real(scale[channel]) / exact - 1));
      if (!(error <= worst)) {
        worst = error;
        where = std::to_string(h) + ", " + std::to_string(d) + ", " + std::to_string(p);
      }
    }
    std::cout << name << ".binary: worst relative error " << worst << " at cell " << where
              << " (seed " << seed << ")\n";
    CHECK(worst <= kMerlPromise);
  }
  CHECK(visible > 10000);
  CHECK(below > 1000);
}

}  // namespace clothbrdf::test
