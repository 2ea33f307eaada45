#include <iostream>

#include "fit/fit.h"
#include "formats/format.h"
#include "formats/material_json.h"
#include "tests/catch.h"
#include "tests/fits/finite_report.h"
#include "tests/support/shared_data.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

TEST_CASE("measured felts are fitted, and the residual is told") {
  for (const char* name : {"rgl_acrylic_felt_green_rgb.bsdf", "alta_pink-felt-1d.alta"}) {
    const std::filesystem::path file = shared_data(name);
    if (file.empty()) continue;
    FitOptions options;
    options.reflectances = {Reflectance::kMicrofacet};
    options.paths = {Paths::kAll};
    options.most_layers = 2;
    options.start = read_material(preset("cotton"));  // a blind search takes a minute
    const FitReport report = fit_table(format_for(file).read(file), options, 2);
    INFO(name);
    CHECK(report.failure.empty());
    CHECK(not_finite(report).empty());
    CHECK(report.residual_rms > 0);
    std::cout << name << ": residual " << report.residual_rms << ", " << report.values
              << " values, " << report.seconds << " s\n";
  }
}

}  // namespace clothbrdf::test
