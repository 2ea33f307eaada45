#pragma once

#include <functional>
#include <string>
#include <vector>

#include "model/material.h"

namespace clothbrdf::test {

/// A case of docs/hard-cases.md.
struct HardMaterial {
  std::string name;
  Material material;
};

/// A silk, and what is done to it; each named as in docs/hard-cases.md.
inline std::vector<HardMaterial> hard_materials() {
  Material silk;
  silk.weights = {1, 1, 0.35};
  silk.diffuse_path = 1;
  silk.rotation_deg = 15;
  silk.warp = {{0.08, 0.35}, {0.05, 0.3, 0.6}, 6, 1.55, 0.03, {}};
  silk.weft = {{0.1, 0.4}, {0.6, 0.3, 0.05}, 4, 1.5, 0.05, {}};
  std::vector<HardMaterial> cases;
  const auto add = [&](const std::string& name, const std::function<void(Material&)>& change) {
    cases.push_back({name, silk});
    change(cases.back().material);
  };
  const auto add_yarns = [&](const std::string& name, const std::function<void(Yarn&)>& change) {
    add(name, [&](Material& m) {
      change(m.warp);
      change(m.weft);
    });
  };
  const auto add_axes = [&](const std::string& name, double along, double across) {
    add_yarns(name, [=](Yarn& y) { y.lobe_axes = {along, across}; });
  };
  const auto add_absorption = [&](const std::string& name, double absorption) {
    add_yarns(name, [=](Yarn& y) { y.absorption = {absorption, 0.3, absorption}; });
  };
  add("a silk", [](Material&) {});
  add_axes("axes 1e-6 and 1", 1e-6, 1);
  add_axes("axes 1e-6 and 1e-6", 1e-6, 1e-6);
  add_axes("axes 1 and 1", 1, 1);
  add_axes("axes equal", 0.3, 0.3);
  add_axes("axes 1e-15 apart", 0.3, 0.3 + 1e-15);
  add_yarns("index 1", [](Yarn& y) { y.refractive_index = 1; });
  add_yarns("index 1 + 1e-15", [](Yarn& y) { y.refractive_index = 1 + 1e-15; });
  add_yarns("index 3", [](Yarn& y) { y.refractive_index = 3; });
  add_absorption("absorption 0", 0);
  add_absorption("absorption denormal", 5e-324);
  add_absorption("absorption 1e-300", 1e-300);
  add_absorption("absorption 700", 700);
  add_absorption("absorption 1e6", 1e6);
  add_yarns("index 1 and absorption 1e-300", [](Yarn& y) {
    y.refractive_index = 1;
    y.absorption = {1e-300, 0, 1e6};
  });
  add_yarns("no layers", [](Yarn& y) { y.layers = 0; });
  add_yarns("one layer", [](Yarn& y) { y.layers = 1; });
  add_yarns("64 layers", [](Yarn& y) { y.layers = 64; });
  add_yarns("scatter 0", [](Yarn& y) { y.scatter = 0; });
  add_yarns("scatter 1", [](Yarn& y) { y.scatter = 1; });
  add_yarns("scatter 1e-9", [](Yarn& y) { y.scatter = 1e-9; });
  add_yarns("scatter 1 - 1e-16", [](Yarn& y) { y.scatter = 1 - 1.2e-16; });
  add_yarns("scatter to the sphere", [](Yarn& y) { y.scatter_limit = 1; });
  add("warp alone", [](Material& m) { m.warp_fraction = 1; });
  add("weft alone", [](Material& m) { m.warp_fraction = 0; });
  add("equal yarns", [](Material& m) { m.weft = m.warp; });
  const auto add_rotation = [&](const std::string& name, double turn) {
    add("rotation " + name, [=](Material& m) { m.rotation_deg = turn; });
  };
  add_rotation("1e300", 1e300);
  add_rotation("-1e22", -1e22);
  add_rotation("1e-300", 1e-300);
  add_rotation("-0", -0.0);
  add_rotation("720", 720);
  add_rotation("a bit short of -360", -359.99999999999994);
  add_yarns("slow path sums", [](Yarn& y) {
    y.layers = 64;
    y.absorption = {0, 0, 1e-9};
    y.scatter = 1e-9;
    y.refractive_index = 3;
  });
  add_yarns("slow path sums of axes 1e-6", [](Yarn& y) {
    y.lobe_axes = {1e-6, 1};
    y.layers = 64;
    y.absorption = {0, 1e-6, 1};
    y.scatter = 1e-4;
    y.refractive_index = 1.0001;
  });
  return cases;
}

}  // namespace clothbrdf::test
