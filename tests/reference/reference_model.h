#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <vector>

#include "model/directions.h"
#include "model/material.h"

namespace clothbrdf::test {

// The model a second time, written from the physics in 50 digits, with none of the forms that make
// the first one exact in double. Shares the plain data of a material and of a direction pair with
// it, nothing else.

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                           boost::multiprecision::et_off>;
/// For the steps that cancel in plain forms: half vectors, g - c of Fresnel's formulas, 1 - q.
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                           boost::multiprecision::et_off>;

/// One component, one value a channel.
using ReferenceChannels = std::vector<Real>;

/// f_r in 1/sr by component.
struct ReferenceComponents {
  ReferenceChannels specular;
  ReferenceChannels internal;
  ReferenceChannels diffuse;
};

/// f_r of one material and pair under every convention and path set, whatever the material's own
/// are.
struct ReferenceValues {
  std::array<std::array<ReferenceComponents, 2>, 2> by_convention;  ///< [reflectance][paths]
  Real cos_theta_d;
  std::array<Real, 2> fresnel_reflection;  ///< r of the warp, of the weft

  const ReferenceComponents& of(Reflectance reflectance, Paths paths) const {
    return by_convention[static_cast<std::size_t>(reflectance)][static_cast<std::size_t>(paths)];
  }
};

/// At a pair of directions in degrees, both above the horizon.
ReferenceValues reference_values(const Material& material, const DirectionPair& pair);

/// The mean over the azimuth of the half vector, at half/difference angles in degrees: theta_h,
/// theta_d and phi_d, the azimuth of the light around the half vector (0 where it leans away from
/// the normal). Both directions above the horizon.
ReferenceValues reference_azimuthal_mean(const Material& material, double theta_h, double theta_d,
                                         double phi_d);

/// The building blocks, so that they can be tested on their own.

/// Height of the lobe in the direction of the unit vector h, given in the yarn's frame.
Wide reference_lobe_height(const Wide& h_along, const Wide& h_across, const Wide& h_n,
                           const Wide& along, const Wide& across);

/// The lobe's height times h_n, integrated over the hemisphere.
Real reference_lobe_integral(const Real& along, const Real& across);

/// One yarn's interface: reflectance and the cosine inside.
struct ReferenceInterface {
  Wide reflected;
  Wide cos_theta_t;
};
ReferenceInterface reference_fresnel(const Wide& cos_theta_d, const Wide& refractive_index);

/// What one passage through a yarn layer leaves.
Real reference_passage(const Real& absorption, const Real& cos_theta_t);

/// All the light that comes out of a pile of layers, without the surface reflection: beside that,
/// strongly absorbed light would be lost even in 50 digits.
Real reference_pile_inside(int layers, const Real& reflected, const Real& passage);

/// Light by the number of its events: weights[E] leaves after E events, weights[0] = 0, weights[1]
/// the surface reflection. The last one, E = 1025, is all that is left then, too. Shorter where
/// nothing more comes out: below 1e-60 of what did.
std::vector<Real> reference_walk(int layers, const Real& reflected, const Real& passage);

}  // namespace clothbrdf::test
