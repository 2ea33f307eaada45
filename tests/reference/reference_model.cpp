#include "tests/reference/reference_model.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <functional>

namespace clothbrdf::test {
namespace {

constexpr int kMostEvents = 1025;
/// Light inside, as a share of what came out, that no later lobe can make count.
const Real kNegligibleLight("1e-60");
/// Directionality q that no axis notices: axes off by 1e-39 of themselves at worst, where they are
/// 1e-6.
const Wide kNegligibleDirectionality("1e-45");

/// Height of the lobe of the given axes towards the half vector at hand; its yarn is 0 for the
/// warp, 1 for the weft.
using Height = std::function<Wide(int yarn, const Wide& along, const Wide& across)>;

Wide radians(const Wide& degrees) { return degrees * boost::math::constants::pi<Wide>() / 180; }

struct Vector {
  Wide x;
  Wide y;
  Wide z;
};

Vector direction(double theta_deg, const Wide& phi_deg) {
  const Wide theta = radians(theta_deg);
  const Wide phi = radians(phi_deg);
  return {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
}

Wide dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Newton's steps on 1 / sqrt from double to 50 digits: three times as fast as the library's, which
/// goes bit by bit. The arguments here lie between 1e-12 and 2.
Real newton_sqrt(const Real& x) {
  Real inverse = 1 / std::sqrt(static_cast<double>(x));
  for (int step = 0; step < 2; ++step) inverse += inverse * (1 - x * inverse * inverse) / 2;
  const Real root = x * inverse;
  return root + inverse * (x - root * root) / 2;
}

/// Carlson's R_D by his duplication theorem alone: his series' leading terms end it when the
/// arguments agree to eight digits, the first one left out being of the sixth order and below
/// 1e-48. Held to Boost's ellint_rd by a test.
Real duplicated_rd(Real x, Real y, Real z) {
  Real sum = 0;
  Real scale = 1;
  const Real quarter("0.25");
  while (true) {
    const Real mean = (x + y + 3 * z) / 5;
    const Real dx = 1 - x / mean;
    const Real dy = 1 - y / mean;
    const Real dz = -(dx + dy) / 3;
    if (abs(dx) + abs(dy) < 1e-8) {
      const Real e2 = dx * dy - 6 * dz * dz;
      const Real e3 = (3 * dx * dy - 8 * dz * dz) * dz;
      const Real e4 = 3 * (dx * dy - dz * dz) * dz * dz;
      const Real e5 = dx * dy * dz * dz * dz;
      const Real series = 1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 -
                          9 * e2 * e3 / 52 + 3 * e5 / 26;
      return 3 * sum + scale * series / (mean * newton_sqrt(mean));
    }
    const Real root_x = newton_sqrt(x);
    const Real root_y = newton_sqrt(y);
    const Real root_z = newton_sqrt(z);
    const Real lambda = root_x * root_y + root_y * root_z + root_z * root_x;
    sum += scale / (root_z * (z + lambda));
    scale *= quarter;
    x = (x + lambda) * quarter;
    y = (y + lambda) * quarter;
    z = (z + lambda) * quarter;
  }
}

/// What a yarn needs of its walks, as sums over E of W_E alpha_E / Z_E and of W_E alpha_E.
struct YarnSums {
  Real specular;
  ReferenceChannels internal;
};

/// Weights by the number of events for one channel and path set.
std::vector<Real> single_weights(int layers, const Real& r, const Real& passage) {
  std::vector<Real> weights(static_cast<std::size_t>(4 * layers), Real(0));
  if (layers == 0) return {Real(0), r};
  weights[1] = r;
  for (int k = 1; k <= layers; ++k) {
    weights[static_cast<std::size_t>(4 * k - 1)] =
        r * pow(Real(1 - r), 4 * k - 2) * pow(passage, 2 * k);
  }
  return weights;
}

/// Sums for [reflectance][paths].
using YarnTable = std::array<std::array<YarnSums, 2>, 2>;

YarnTable yarn_sums(const Yarn& yarn, const ReferenceInterface& interface,
                    const std::function<Wide(const Wide&, const Wide&)>& height) {
  const Real r(interface.reflected);
  std::array<std::vector<std::vector<Real>>, 2> weights;  // [paths][channel][E]
  std::size_t longest = 0;
  for (const double absorption : yarn.absorption) {
    const Real passage = reference_passage(absorption, Real(interface.cos_theta_t));
    weights[static_cast<std::size_t>(Paths::kAll)].push_back(
        reference_walk(yarn.layers, r, passage));
    weights[static_cast<std::size_t>(Paths::kSingle)].push_back(
        single_weights(yarn.layers, r, passage));
  }
  for (const auto& set : weights) {
    for (const auto& channel : set) longest = std::max(longest, channel.size());
  }

  const Wide a = yarn.lobe_axes[0];
  const Wide b = yarn.lobe_axes[1];
  const Wide c = yarn.scatter_limit ? Wide(*yarn.scatter_limit) : (a > b ? a : b);
  const Wide kept = 1 - Wide(yarn.scatter);
  Wide q = 1;  // after one event
  YarnTable table;
  for (auto& row : table) {
    for (YarnSums& sums : row) sums.internal.assign(yarn.absorption.size(), Real(0));
  }
  Real alpha = 0;
  Real over_z = 0;
  bool changes = true;
  for (std::size_t e = 1; e < longest; e += 2) {  // light leaves after odd numbers of events only
    if (changes) {
      const Wide along = c - (c - a) * q;
      const Wide across = c - (c - b) * q;
      alpha = Real(height(along, across));
      over_z = alpha / reference_lobe_integral(Real(along), Real(across));
      changes = yarn.scatter > 0 && q > kNegligibleDirectionality;
    }
    for (std::size_t paths = 0; paths < 2; ++paths) {
      for (std::size_t reflectance = 0; reflectance < 2; ++reflectance) {
        const bool microfacet = reflectance == static_cast<std::size_t>(Reflectance::kMicrofacet);
        const Real& height_here = microfacet ? over_z : alpha;
        YarnSums& sums = table[reflectance][paths];
        if (e == 1) sums.specular = r * height_here;
        for (std::size_t channel = 0; e > 1 && channel < sums.internal.size(); ++channel) {
          const std::vector<Real>& w = weights[paths][channel];
          if (e < w.size()) sums.internal[channel] += w[e] * height_here;
        }
      }
    }
    q *= kept * kept;
  }
  return table;
}

/// Section 7, given the cosines and the lobes' heights.
ReferenceValues assemble(const Material& material, const Wide& h_n, const Wide& x, const Wide& c_i,
                         const Wide& c_o, const Height& height) {
  const std::array<const Yarn*, 2> yarns = {&material.warp, &material.weft};
  const std::array<Real, 2> shares = {Real(material.warp_fraction),
                                      Real(1 - Wide(material.warp_fraction))};
  Wide shadowing = 1;
  for (const Wide& cosine : {c_i, c_o}) {
    const Wide blocked = 2 * h_n * cosine / x;
    if (blocked < shadowing) shadowing = blocked;
  }
  const Real microfacet_factor(shadowing / (4 * c_i * c_o));
  const Real paper_factor(1 / c_i);

  ReferenceValues values;
  values.cos_theta_d = Real(x);
  std::array<YarnTable, 2> tables;
  for (std::size_t y = 0; y < 2; ++y) {
    const ReferenceInterface interface = reference_fresnel(x, yarns[y]->refractive_index);
    values.fresnel_reflection[y] = Real(interface.reflected);
    tables[y] = yarn_sums(*yarns[y], interface, [&](const Wide& along, const Wide& across) {
      return height(static_cast<int>(y), along, across);
    });
  }
  for (std::size_t reflectance = 0; reflectance < 2; ++reflectance) {
    const bool microfacet = reflectance == static_cast<std::size_t>(Reflectance::kMicrofacet);
    const Real factor = microfacet ? microfacet_factor : paper_factor;
    // The paper's L_D has the light's cosine in, f_r has it out again.
    const Real diffuse_factor = microfacet ? 1 / boost::math::constants::pi<Real>() : Real(1);
    for (std::size_t paths = 0; paths < 2; ++paths) {
      ReferenceComponents& f = values.by_convention[reflectance][paths];
      for (std::size_t channel = 0; channel < material.channel_count(); ++channel) {
        Real specular = 0;
        Real internal = 0;
        Real diffuse = 0;
        for (std::size_t y = 0; y < 2; ++y) {
          const YarnSums& sums = tables[y][reflectance][paths];
          specular += shares[y] * sums.specular;
          internal += shares[y] * sums.internal[channel];
          diffuse +=
              shares[y] * exp(-Real(yarns[y]->absorption[channel]) * Real(material.diffuse_path));
        }
        f.specular.push_back(Real(material.weights.specular) * specular * factor);
        f.internal.push_back(Real(material.weights.internal) * internal * factor);
        f.diffuse.push_back(Real(material.weights.diffuse) * diffuse * diffuse_factor);
      }
    }
  }
  return values;
}

}  // namespace

Wide reference_lobe_height(const Wide& h_along, const Wide& h_across, const Wide& h_n,
                           const Wide& along, const Wide& across) {
  return h_n / (h_along * h_along / (along * along) + h_across * h_across / (across * across) +
                h_n * h_n);
}

Real reference_lobe_integral(const Real& along, const Real& across) {
  return 2 * boost::math::constants::pi<Real>() / 3 * along * across *
         duplicated_rd(Real(along * along), Real(across * across), Real(1));
}

ReferenceInterface reference_fresnel(const Wide& cos_theta_d, const Wide& refractive_index) {
  if (refractive_index == 1) return {Wide(0), cos_theta_d};
  const Wide& c = cos_theta_d;
  const Wide g = sqrt(refractive_index * refractive_index - 1 + c * c);
  const Wide ratio = (g - c) / (g + c);
  const Wide other = (c * (g + c) - 1) / (c * (g - c) + 1);
  // Snell's law.
  const Wide sin_t = sqrt(1 - c * c) / refractive_index;
  return {ratio * ratio / 2 * (1 + other * other), sqrt(1 - sin_t * sin_t)};
}

Real reference_passage(const Real& absorption, const Real& cos_theta_t) {
  if (absorption == 0) return 1;
  return cos_theta_t == 0 ? Real(0) : Real(exp(-absorption / cos_theta_t));
}

Real reference_pile_inside(int layers, const Real& reflected, const Real& passage) {
  // Add one surface after the other on top of the pile below it; yarn and air alternate, yarn under
  // the topmost.
  const Real transmitted = 1 - reflected;
  Real below = 0;
  Real through = 0;
  for (int surface = 2 * layers; surface >= 1; --surface) {
    if (surface % 2 == 1) below *= passage * passage;
    through = transmitted * transmitted * below / (1 - reflected * below);
    below = reflected + through;
  }
  return through;
}

std::vector<Real> reference_walk(int layers, const Real& reflected, const Real& passage) {
  const Real& r = reflected;
  const Real t = 1 - r;
  if (layers == 0) return {Real(0), r};
  const std::size_t surfaces = static_cast<std::size_t>(2 * layers);
  // Light about to meet surface 1..2N, on its way down and on its way up. Between surfaces i and i
  // + 1 lies yarn where i is odd.
  std::vector<Real> down(surfaces + 2, Real(0));
  std::vector<Real> up(surfaces + 2, Real(0));
  down[1] = 1;
  std::vector<Real> left = {Real(0)};
  Real left_inside = 0;  // without the surface reflection
  for (int event = 1; event < kMostEvents; ++event) {
    std::vector<Real> next_down(surfaces + 2, Real(0));
    std::vector<Real> next_up(surfaces + 2, Real(0));
    for (std::size_t i = 1; i <= surfaces; ++i) {
      if (down[i] == 0 && up[i] == 0) continue;
      Real goes_up = r * down[i] + t * up[i];
      Real goes_down = t * down[i] + r * up[i];
      if (i % 2 == 1) {
        goes_down *= passage;
      } else {
        goes_up *= passage;
      }
      next_up[i - 1] += goes_up;
      next_down[i + 1] += goes_down;
    }
    left.push_back(next_up[0]);
    if (event > 1) left_inside += next_up[0];
    next_up[0] = 0;
    next_down[surfaces + 1] = 0;  // through the bottom
    down = std::move(next_down);
    up = std::move(next_up);
    if (event % 16 == 0) {
      Real inside = 0;
      for (std::size_t i = 1; i <= surfaces; ++i) inside += down[i] + up[i];
      if (inside <= kNegligibleLight * left_inside) return left;
    }
  }
  left.push_back(reference_pile_inside(layers, r, passage) - left_inside);
  return left;
}

ReferenceValues reference_values(const Material& material, const DirectionPair& pair) {
  const Vector i = direction(pair.theta_i, pair.phi_i);
  const Vector o = direction(pair.theta_o, pair.phi_o);
  Vector h = {i.x + o.x, i.y + o.y, i.z + o.z};
  const Wide length = sqrt(dot(h, h));
  h = {h.x / length, h.y / length, h.z / length};
  const Wide turn = radians(material.rotation_deg);
  const Vector weft = {cos(turn), sin(turn), Wide(0)};
  const Vector warp = {-sin(turn), cos(turn), Wide(0)};
  const Wide h_weft = dot(h, weft);
  const Wide h_warp = dot(h, warp);
  return assemble(material, h.z, dot(i, h), i.z, o.z,
                  [&](int yarn, const Wide& along, const Wide& across) {
                    return yarn == 0 ? reference_lobe_height(h_warp, h_weft, h.z, along, across)
                                     : reference_lobe_height(h_weft, h_warp, h.z, along, across);
                  });
}

ReferenceValues reference_azimuthal_mean(const Material& material, double theta_h, double theta_d,
                                         double phi_d) {
  // The light in the frame whose pole is the half vector, then the half vector is tilted to where
  // it is.
  const Vector light = direction(theta_d, phi_d);
  const Wide sin_h = sin(radians(theta_h));
  const Wide cos_h = cos(radians(theta_h));
  const Wide c_i = cos_h * light.z - sin_h * light.x;
  const Wide c_o = cos_h * light.z + sin_h * light.x;
  return assemble(material, cos_h, light.z, c_i, c_o,
                  [&](int, const Wide& along, const Wide& across) {
                    // The mean of 1 / (A cos^2 + B sin^2) over a turn is 1 / sqrt(A B).
                    const Wide big_a = sin_h * sin_h / (along * along) + cos_h * cos_h;
                    const Wide big_b = sin_h * sin_h / (across * across) + cos_h * cos_h;
                    return Wide(cos_h / sqrt(big_a * big_b));
                  });
}

}  // namespace clothbrdf::test
