#include "cost/plan.h"

#include <array>

namespace clothbrdf {
namespace {

constexpr const char* kMerlAxes = "MERL's theta_h";
constexpr const char* kUniform = "uniform axes";
constexpr const char* kChosen = "chosen nodes";

const std::vector<Reader>& both() {
  static const std::vector<Reader> kBoth = {Reader::kInterpolated, Reader::kNearest};
  return kBoth;
}

// All axes even in angle: what tables look like unless something is done about it.
Grid uniform(Grid grid) {
  Axis& theta_h = grid.axes[0];
  theta_h.spacing = Spacing::kListed;
  for (int k = 0; k < theta_h.size; ++k)
    theta_h.listed_deg.push_back(90 * (k + 0.5) / theta_h.size);
  return grid;
}

// Every so many files of half floats, so that both can be compared.
void add_chosen(const ChosenNodes& nodes, std::vector<PlannedFile>& files,
                const std::vector<double>& errors) {
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const Grid grid = nodes.grid(nodes.sizes(errors[k]));
    files.push_back({kChosen, ".exr", grid, {}});
    if (k % 2 == 1) files.push_back({"half floats", ".exr", grid, {}, true});
  }
}

}  // namespace

std::vector<PlannedFile> isotropic_files(const ChosenNodes& nodes, Reflectance reflectance) {
  const bool paper = reflectance == Reflectance::kPaper;
  const double around = paper ? 360 : 180;
  const auto grid = [&](int theta_h, int theta_d, int phi_d) {
    return halfdiff3d(theta_h, theta_d, paper ? 2 * phi_d : phi_d, around);
  };
  std::vector<PlannedFile> files;
  for (const int n : {12, 23, 45, 90, 180}) {
    files.push_back({kMerlAxes, ".exr", grid(n, n, 2 * n), {}, false, 0, both()});
  }
  for (const int n : {23, 45, 90, 180}) {
    files.push_back({kUniform, ".exr", uniform(grid(n, n, 2 * n)), {}});
    files.back().even_axes = true;
  }
  add_chosen(nodes, files, {1, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0002, 0.0001});
  files.push_back({"regular, half", ".exr", grid(90, 90, 180), {}, true});
  files.push_back({"doubles", ".binary", halfdiff3d(), {}, false, 0, both()});
  if (!paper) {
    for (const int n : {23, 45}) {
      for (const double tolerance : {1e-2, 1e-3}) {
        files.push_back(
            {"averages", ".exr", grid(n, n, 2 * n), {true, tolerance}, false, 0, both()});
      }
    }
    files.push_back({"averages", ".binary", halfdiff3d(), {true, 1e-2}, false, 0, both()});
  }
  for (const std::uint64_t bytes : {30'000U, 300'000U, 3'000'000U}) {
    files.push_back({"RGL size", ".bsdf", AnyPairs{true}, {}, false, bytes});
  }
  return files;
}

std::vector<PlannedFile> anisotropic_files(const ChosenNodes& nodes, Reflectance reflectance) {
  const bool paper = reflectance == Reflectance::kPaper;
  const double around = paper ? 360 : 180;
  const auto grid = [&](std::array<int, 4> n) {
    return halfdiff4d(n[0], n[1], n[2], paper ? 2 * n[3] : n[3], around);
  };
  std::vector<PlannedFile> files;
  for (const int n : {12, 23, 32, 45}) {
    files.push_back({kMerlAxes, ".exr", grid({n, n * 4 / 5, n, n}), {}, false, 0, both()});
  }
  for (const int n : {12, 23, 32, 45, 60}) {
    files.push_back({kUniform, ".exr", uniform(grid({n, n * 4 / 5, n, n})), {}});
    files.back().even_axes = true;
  }
  const std::array<const char*, 4> names = {"theta_h doubled", "phi_h doubled", "theta_d doubled",
                                            "phi_d doubled"};
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    std::array<int, 4> sizes = {23, 18, 23, 23};
    sizes[axis] *= 2;
    files.push_back({names[axis], ".exr", grid(sizes), {}});
  }
  add_chosen(nodes, files, {1, 0.3, 0.1, 0.03, 0.01, 0.003, 0.0009});
  files.push_back({"regular, half", ".exr", grid({45, 36, 45, 45}), {}, true});
  files.push_back({"in/out nodes", ".exr", inout(), {}, false, 0, both()});
  files.push_back({"in/out nodes", ".exr", inout(12, 72, 12, 72), {}, false, 0, both()});
  if (!paper) {
    files.push_back({"averages", ".exr", grid({12, 9, 12, 12}), {true, 1e-2}, false, 0, both()});
  }
  for (const std::uint64_t bytes : {100'000U, 1'000'000U, 5'000'000U, 20'000'000U}) {
    files.push_back({"RGL size", ".bsdf", AnyPairs{false}, {}, false, bytes});
  }
  return files;
}

}  // namespace clothbrdf
