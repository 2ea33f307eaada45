// What identify says, against what refits and fits find.

#include "fit/identify.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <string>

#include "fit/fit.h"
#include "formats/material_json.h"
#include "support/errors.h"
#include "tabulate/model_producer.h"
#include "tests/catch.h"

namespace clothbrdf {
namespace {

Material preset(const std::string& name) {
  return read_material(CLOTHBRDF_SOURCE_DIR "/materials/" + name + ".json");
}

IdentifyReport identified(const Material& material, const Grid& grid,
                          const IdentifyOptions& options) {
  return identify(material_spec(material, {}, grid), material, {}, options, 2);
}

bool lists(const std::vector<Equivalent>& equivalents, const std::string& words) {
  return std::any_of(equivalents.begin(), equivalents.end(),
                     [&](const Equivalent& e) { return e.words == words; });
}

const VerifiedParameter& parameter(const IdentifyReport& report, const std::string& name) {
  return *std::find_if(report.parameters.begin(), report.parameters.end(),
                       [&](const VerifiedParameter& p) { return p.name == name; });
}

TEST_CASE("the spread of refits is what the Fisher information predicts") {
  // The spread of 200 refits has itself a standard error of 5 %.
  constexpr double kAgreement = 0.25;
  IdentifyOptions options;
  options.fit.fewest_layers = 3;
  options.fit.most_layers = 6;
  double worst = 1;
  std::string worst_name;
  for (const char* name : {"tamamushi", "satin"}) {
    const IdentifyReport report = identified(preset(name), halfdiff4d(16, 12, 12, 12), options);
    CHECK(report.refits_converged == report.refits);
    int compared = 0;
    for (const VerifiedParameter& p : report.parameters) {
      if (p.verdict != Verdict::kIdentifiable) continue;
      REQUIRE(p.predicted);
      REQUIRE(p.observed);
      const double ratio = *p.observed / *p.predicted;
      INFO(name << ", " << p.name << ": observed / predicted " << ratio);
      CHECK(std::abs(ratio - 1) <= kAgreement);
      // The mean of 200 refits lies within its own error, too.
      CHECK(std::abs(*p.bias) <= 5 * *p.predicted / std::sqrt(report.refits));
      ++compared;
      if (std::abs(ratio - 1) > std::abs(worst - 1)) {
        worst = ratio;
        worst_name = std::string(name) + ", " + p.name;
      }
    }
    CHECK(compared >= 15);
  }
  std::cout << "observed / predicted standard errors: worst " << std::setprecision(3) << worst
            << " of " << worst_name << " (seed " << options.fit.seed << ")\n";
}

TEST_CASE("of an isotropic table identify finds that axes are unordered and yarns exchangeable") {
  IdentifyOptions options;
  options.refits = 0;
  const IdentifyReport report = identified(preset("tamamushi"), halfdiff3d(), options);
  CHECK(lists(report.equivalents, "the warp's lobe axes exchanged"));
  CHECK(lists(report.equivalents, "the weft's lobe axes exchanged"));
  CHECK(lists(report.equivalents, "the yarns exchanged"));
  CHECK(report.equivalents.size() == 7);
  CHECK(parameter(report, "warp.lobe_axes.0").verdict == Verdict::kIdentifiable);
}

TEST_CASE(
    "of an isotropic table of equal yarns identify names what sets them apart, and a remedy") {
  IdentifyOptions options;
  options.refits = 0;
  options.profile_points = 3;
  const IdentifyReport report = identified(preset("silk"), halfdiff3d(24, 24, 24), options);
  CHECK(parameter(report, "weights.specular").verdict == Verdict::kIdentifiable);
  for (const char* name : {"warp_fraction", "warp.lobe_axes.0", "weft.absorption.2"}) {
    INFO(name);
    const VerifiedParameter& p = parameter(report, name);
    CHECK(p.verdict == Verdict::kNotIdentifiable);
    CHECK_FALSE(p.predicted);
    CHECK(p.remedy.starts_with("a table with phi_h"));
  }
  CHECK(std::any_of(report.blind.begin(), report.blind.end(), [](const BlindDirection& b) {
    return b.words == "warp.absorption.2 up, weft.absorption.2 down" ||
           b.words == "weft.absorption.2 up, warp.absorption.2 down";
  }));
  // A flat profile: any share of the surface gives the same table.
  const auto profile = std::find_if(report.profiles.begin(), report.profiles.end(),
                                    [](const Profile& p) { return p.name == "warp_fraction"; });
  REQUIRE(profile != report.profiles.end());
  for (const ProfilePoint& point : profile->points) CHECK(point.chi2 < 1e-6);
}

TEST_CASE("a tie that the material contradicts is refused, and one refit, too") {
  IdentifyOptions options;
  options.fit.wishes = {{ParameterWish::Kind::kTie, "weft", {}, {}, {}}};
  CHECK_THROWS_AS(identified(preset("tamamushi"), halfdiff3d(8, 8, 8), options), InputError);
  options.fit.wishes.clear();
  options.refits = 1;
  CHECK_THROWS_AS(identified(preset("tamamushi"), halfdiff3d(8, 8, 8), options), InputError);
}

TEST_CASE("a fit keeps ties and turns the cloth to less than 45 degrees") {
  Material cloth = preset("tamamushi");
  cloth.weft.lobe_axes = {0.4, 0.15};
  cloth.rotation_deg = 20;
  const Table table =
      collect(*make_producer(material_spec(cloth, {}, halfdiff4d(10, 8, 8, 8)), 2), 2);
  FitOptions options;
  options.reflectances = {Reflectance::kMicrofacet};
  options.paths = {Paths::kAll};
  options.fewest_layers = 3;
  options.most_layers = 6;
  options.noise = 0.01;
  for (const double turn : {20.0, 200.0, -160.0}) {
    options.start = cloth;
    options.start->rotation_deg = turn;
    const FitReport report = fit_table(table, options, 2);
    INFO("from " << turn);
    // Either this or, with axes and yarns exchanged, the same cloth a quarter turn on.
    CHECK(std::abs(report.material.rotation_deg - 20) < 1e-6);
  }
  options.start.reset();
  options.wishes = {{ParameterWish::Kind::kTie, "lobe_axes.0", {}, {}, {}}};
  const FitReport tied = fit_table(table, options, 2);
  CHECK(tied.material.warp.lobe_axes[0] == tied.material.weft.lobe_axes[0]);
}

TEST_CASE("a table that no cloth of the bounds makes has no identifiable parameter") {
  Material cloth = preset("tamamushi");
  cloth.warp.refractive_index = 1.1;  // below what is fitted
  const Table table =
      collect(*make_producer(material_spec(cloth, {}, halfdiff4d(10, 8, 8, 8)), 2), 2);
  FitOptions options;
  options.reflectances = {Reflectance::kMicrofacet};
  options.paths = {Paths::kAll};
  options.fewest_layers = 3;
  options.most_layers = 6;
  for (const bool given : {false, true}) {
    options.noise.reset();
    if (given) options.noise = 0.001;
    const FitReport report = fit_table(table, options, 2);
    INFO("noise given: " << given);
    CHECK_FALSE(report.notes.empty());
    for (const ParameterEstimate& p : report.parameters) {
      CHECK(p.verdict != Verdict::kIdentifiable);
    }
  }
}

}  // namespace
}  // namespace clothbrdf
