#pragma once

#include "model/reflectance.h"
#include "table/table_spec.h"

namespace clothbrdf::test {

/// What a channel holds of f_r; not by the code under test.
inline double part_of(const Components& f, const Channel& channel) {
  switch (channel.part) {
    case Part::kSpecular: return f.specular[channel.colour];
    case Part::kInternal: return f.internal[channel.colour];
    case Part::kDiffuse: return f.diffuse[channel.colour];
    case Part::kTotal: break;
  }
  return f.total(channel.colour);
}

}  // namespace clothbrdf::test
