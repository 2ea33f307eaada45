#include <functional>
#include <iostream>
#include <optional>

#include "tests/catch.h"
#include "tests/fits/match.h"

namespace clothbrdf::test {
namespace {

using Kind = ParameterWish::Kind;

const Grid kGrid = halfdiff4d(8, 6, 6, 6);

Material cloth(std::uint64_t seed) {
  RandomInputs random(seed);
  Material m = random_cloth(random, 3, 3);
  m.rotation_deg = 10;
  return m;
}

ParameterEstimate parameter(const FitReport& report, const std::string& name) {
  for (const ParameterEstimate& p : report.parameters) {
    if (p.name == name) return p;
  }
  return {};
}

FitReport fit_with(const Table& table, const Material& truth, const ParameterWish& wish) {
  FitOptions options = warm_options(truth);
  options.wishes.push_back(wish);
  return fit_table(table, options, 1);
}

// What must not depend on threads, to the last bit.
std::vector<double> bits_of(const FitReport& r) {
  std::vector<double> all = {r.chi2,
                             r.noise,
                             r.residual_rms,
                             r.condition,
                             static_cast<double>(r.iterations),
                             static_cast<double>(r.starts_at_best)};
  for (const ParameterEstimate& p : r.parameters) {
    all.insert(all.end(), {p.value, p.standard_error.value_or(-1), p.start});
  }
  for (const LayerFit& f : r.layers.fits) all.push_back(f.chi2);
  for (const Optimum& o : r.optima) all.push_back(o.chi2);
  for (const RegionResidual& x : r.residuals) all.insert(all.end(), {x.rms, x.mean});
  return all;
}

}  // namespace

TEST_CASE("every kind of wish about every parameter reaches the parameter it names") {
  for (const bool rotatable : {true, false}) {
    for (const FitParameter& p : fit_parameters(2)) {
      if (p.column == kRotation && !rotatable) continue;
      const double inside = p.lowest + 0.4 * (p.highest - p.lowest);
      const auto set_with = [&](const ParameterWish& wish) {
        FitOptions options;
        options.wishes = {wish};
        return ParameterSet(options, 2, rotatable);
      };
      const auto index = [&](const ParameterSet& set) {
        std::size_t i = 0;
        while (set.parameters()[i].name != p.name) ++i;
        return i;
      };
      INFO(p.name);
      const ParameterSet fixed = set_with({Kind::kFix, p.name, inside, {}, {}});
      CHECK(fixed.state(index(fixed)) == ParameterSet::State::kFixed);
      CHECK(parameter_value(fixed.defaults(), p) == inside);
      CHECK(fixed.free().size() + 1 == set_with({Kind::kFree, p.name, {}, {}, {}}).free().size());
      const double low = p.lowest + 0.3 * (p.highest - p.lowest);
      const ParameterSet bounded = set_with({Kind::kFree, p.name, {}, low, inside});
      CHECK(bounded.parameters()[index(bounded)].lowest == low);
      CHECK(bounded.parameters()[index(bounded)].highest == inside);
      CHECK(parameter_value(bounded.defaults(), p) >= low);
      CHECK(parameter_value(bounded.defaults(), p) <= inside);
      const ParameterSet started = set_with({Kind::kStart, p.name, inside, {}, {}});
      CHECK(started.has_start(index(started)));
      CHECK(started.state(index(started)) == ParameterSet::State::kFree);
      CHECK(parameter_value(started.defaults(), p) == inside);
      if (!p.of_yarn || p.yarn == 0) continue;
      const ParameterSet tied = set_with({Kind::kTie, p.name.substr(5), {}, {}, {}});
      CHECK(tied.state(index(tied)) == ParameterSet::State::kTied);
      Material m = tied.defaults();
      FitParameter warp = p;
      warp.yarn = 0;
      set_parameter(m, warp, inside);
      CHECK(std::abs(parameter_value(tied.material(tied.coordinates(m), m), p) - inside) <=
            1e-14 * std::abs(inside));  // through the logarithm and back
    }
  }
}

TEST_CASE("fixed, bounded, tied and started parameters are so in the report") {
  const Material truth = cloth(1);
  const Table table = table_of(truth, kGrid);
  const FitReport fixed =
      fit_with(table, truth, {Kind::kFix, "warp.refractive_index", 1.45, {}, {}});
  CHECK(parameter(fixed, "warp.refractive_index").value == 1.45);
  CHECK(parameter(fixed, "warp.refractive_index").verdict == Verdict::kFixed);
  CHECK_FALSE(parameter(fixed, "warp.refractive_index").standard_error);

  const double below = truth.warp.lobe_axes[0] * 0.8;
  const FitReport bounded =
      fit_with(table, truth, {Kind::kFree, "warp.lobe_axes.0", {}, 0.001, below});
  CHECK(std::abs(parameter(bounded, "warp.lobe_axes.0").value / below - 1) <= 1e-12);
  CHECK(parameter(bounded, "warp.lobe_axes.0").verdict == Verdict::kAtBound);
  CHECK(parameter(bounded, "warp.lobe_axes.0").highest == below);

  const FitReport tied = fit_with(table, truth, {Kind::kTie, "scatter", {}, {}, {}});
  CHECK(parameter(tied, "weft.scatter").value == parameter(tied, "warp.scatter").value);
  CHECK(parameter(tied, "weft.scatter").verdict == Verdict::kTied);

  const FitReport started = fit_with(table, truth, {Kind::kStart, "weft.scatter", 0.2, {}, {}});
  CHECK(std::abs(parameter(started, "weft.scatter").start - 0.2) <= 1e-12);
  CHECK(std::abs(parameter(started, "weft.scatter").value / truth.weft.scatter - 1) <= 1e-6);
}

TEST_CASE("layer counts keep to their range, to a fixed count and to a tie") {
  Material truth = cloth(2);
  truth.warp.layers = 3;
  truth.weft.layers = 2;
  const Table table = table_of(truth, kGrid);
  FitOptions options = quick_options(truth);
  options.start = truth;
  options.fewest_layers = 1;
  options.most_layers = 2;
  const FitReport range = fit_table(table, options, 1);
  CHECK(range.layers.fits.size() == 4);
  CHECK(range.layers.fewest == 1);
  CHECK(range.layers.most == 2);
  for (const LayerFit& f : range.layers.fits) CHECK((f.warp >= 1 && f.warp <= 2 && f.weft <= 2));
  options.most_layers = 4;
  options.wishes = {{Kind::kFix, "warp.layers", 3, {}, {}}};
  const FitReport fixed = fit_table(table, options, 1);
  CHECK(fixed.layers.fits.size() == 4);
  CHECK(fixed.material.warp.layers == 3);
  CHECK(fixed.material.weft.layers == 2);
  options.wishes = {{Kind::kTie, "layers", {}, {}, {}}};
  const FitReport tied = fit_table(table, options, 1);
  CHECK(tied.layers.fits.size() == 4);
  CHECK(tied.material.warp.layers == tied.material.weft.layers);
}

TEST_CASE("of the conventions asked for the right one is chosen and told from the others") {
  Material truth = cloth(3);
  for (const Reflectance reflectance : {Reflectance::kMicrofacet, Reflectance::kPaper}) {
    for (const Paths paths : {Paths::kAll, Paths::kSingle}) {
      truth.reflectance = reflectance;
      truth.paths = paths;
      FitOptions options = warm_options(truth);
      options.reflectances = FitOptions().reflectances;
      options.paths = FitOptions().paths;
      const FitReport report = fit_table(noisy(table_of(truth, kGrid), 0.01, 4), options, 1);
      CHECK(report.conventions.size() == 4);
      CHECK(report.material.reflectance == reflectance);
      CHECK(report.material.paths == paths);
      for (const ConventionFit& c : report.conventions) CHECK(c.told == !c.chosen);
      options = warm_options(truth);
      CHECK(fit_table(table_of(truth, kGrid), options, 1).conventions.size() == 1);
    }
  }
}

TEST_CASE("standard errors are in proportion to the noise that is stated, else to the estimate") {
  const Material truth = cloth(4);
  const Table table = noisy(table_of(truth, kGrid), 0.01, 5);
  FitOptions options = warm_options(truth);
  const FitReport estimated = fit_table(table, options, 1);
  CHECK(estimated.noise_estimated);
  CHECK(std::abs(estimated.noise / 0.01 - 1) <= 0.05);  // of 5000 values
  options.noise = 0.01;
  const FitReport once = fit_table(table, options, 1);
  options.noise = 0.02;
  const FitReport twice = fit_table(table, options, 1);
  CHECK_FALSE(once.noise_estimated);
  CHECK(once.noise == 0.01);
  CHECK(std::abs(once.chi2 / twice.chi2 - 4) <= 1e-6);
  const double a = parameter(once, "warp.scatter").standard_error.value();
  const double b = parameter(twice, "warp.scatter").standard_error.value();
  CHECK(std::abs(b / a - 2) <= 1e-6);
}

TEST_CASE("no weighting biases the fit of values with its own noise") {
  // Weights 1/f^2 from the noisy values would put every weight 2 sigma^2 = 0.5 %, here of
  // each weight, off: several standard errors of the mean of some refits.
  constexpr double kNoise = 0.05;
  constexpr double kMostOff = 3;
  const int refits = soak_cases(64);
  const Material truth = cloth(5);
  const Table exact = table_of(truth, kGrid);
  const std::uint64_t seed = seed_from_environment();
  for (const Weighting weighting :
       {Weighting::kRelative, Weighting::kAbsolute, Weighting::kLogarithmic}) {
    double scale_sum = 0;
    double scale_error = 0;
    for (int n = 0; n < refits; ++n) {
      RandomInputs random(seed + static_cast<std::uint64_t>(n));
      const Table table = mapped(exact, [&](double x) {
        if (!(x > 0)) return x;
        const double z = kNoise * normal(random);
        if (weighting == Weighting::kRelative) return x * (1 + z);
        return weighting == Weighting::kAbsolute ? x + 0.01 * z : x * std::exp(z);
      });
      FitOptions options = warm_options(truth);
      options.weighting = weighting;
      // All else held: one number says how much the whole table is off.
      for (const FitParameter& p : fit_parameters(3)) {
        if (p.column == kInternal) continue;
        options.wishes.push_back({Kind::kFix, p.name, {}, {}, {}});
      }
      const FitReport report = fit_table(table, options, 1);
      const ParameterEstimate k = parameter(report, "weights.internal");
      CHECK(report.converged);
      scale_sum += (k.value - truth.weights.internal) / k.standard_error.value();
      scale_error = k.standard_error.value() / k.value;
    }
    const double off = scale_sum / std::sqrt(static_cast<double>(refits));
    std::cout << "bias of weights.internal over " << refits << " refits: " << off
              << " standard errors of the mean, each " << scale_error << " (seed " << seed << ")\n";
    INFO(static_cast<int>(weighting));
    CHECK(std::abs(off) <= kMostOff);
  }
}

TEST_CASE("robust losses resist gross outliers where squares do not") {
  const Material truth = cloth(6);
  const Table clean = noisy(table_of(truth, kGrid), 0.01, 6);
  RandomInputs random(seed_from_environment());
  const Table table = mapped(clean, [&](double x) { return random.chance(0.05) ? 3 * x : x; });
  const auto worst_error = [&](Loss loss) {
    FitOptions options = warm_options(truth);
    options.loss = loss;
    options.noise = 0.01;
    const FitReport report = fit_table(table, options, 1);
    double worst = 0;
    for (const char* name : {"weights.diffuse", "weights.internal", "warp.lobe_axes.0",
                             "weft.lobe_axes.1", "warp.refractive_index"}) {
      const double expected = parameter(report, name).value;
      for (const FitParameter& p : fit_parameters(3)) {
        if (p.name != name) continue;
        worst = std::max(worst, std::abs(expected / parameter_value(truth, p) - 1));
      }
    }
    return worst;
  };
  const double squared = worst_error(Loss::kSquared);
  const double huber = worst_error(Loss::kHuber);
  const double cauchy = worst_error(Loss::kCauchy);
  std::cout << "5 % outliers: worst error squared " << squared << ", huber " << huber << ", cauchy "
            << cauchy << '\n';
  CHECK(huber <= squared / 3);
  CHECK(cauchy <= squared / 3);
}

TEST_CASE(
    "a fit has the same bits for a seed, whatever the threads, and other starts for another") {
  Material truth = cloth(7);
  const Table table = noisy(table_of(truth, kGrid), 0.01, 7);
  FitOptions options = quick_options(truth);
  const std::vector<double> once = bits_of(fit_table(table, options, 1));
  CHECK(bits_of(fit_table(table, options, 1)) == once);
  CHECK(bits_of(fit_table(table, options, 2)) == once);
  options.seed = 2;
  CHECK(bits_of(fit_table(table, options, 1)) != once);
}

TEST_CASE("a table's metadata is not looked at") {
  const Material truth = cloth(8);
  const Table table = noisy(table_of(truth, kGrid), 0.01, 8);
  TableSpec spec = table.spec();
  spec.provenance.material = cloth(99);
  spec.provenance.program = "another";
  const Table other(spec, {table.values().begin(), table.values().end()}, cells_with_values(spec));
  TableSpec bare = table.spec();
  bare.provenance = {};
  const Table none(bare, {table.values().begin(), table.values().end()}, cells_with_values(bare));
  const FitOptions options = quick_options(truth);
  const std::vector<double> bits = bits_of(fit_table(table, options, 1));
  CHECK(bits_of(fit_table(other, options, 1)) == bits);
  CHECK(bits_of(fit_table(none, options, 1)) == bits);
}

TEST_CASE("of a table made for a scene only the cells that it reaches are fitted") {
  const Material truth = cloth(5);
  TableSpec spec = material_spec(truth, {}, halfdiff4d(14, 9, 14, 12));
  const Table whole = collect(*make_producer(spec, 1), 1);
  spec.reach = Reach{{{{0, 50}, {0, 60}}}, {{{0, 50}, {0, 360}}}, {0}};
  const Table part = collect(*make_producer(spec, 1), 1);
  const FitReport of_whole = fit_table(whole, warm_options(truth), 1);
  const FitReport of_part = fit_table(part, warm_options(truth), 1);
  double worst = 0;
  for (const ParameterEstimate& p : of_part.parameters) {
    if (is_fitted(p.verdict))
      worst = std::max(worst, std::abs(p.value - parameter(of_whole, p.name).value));
  }
  std::cout << "fit of a scene's cells: " << of_part.values << " of " << of_whole.values
            << " values, off by at most " << worst << ", residual " << of_part.residual_rms << '\n';
  CHECK(of_part.values < of_whole.values);
  CHECK(of_part.residual_rms < 1e-6);
  CHECK(worst < 1e-4);
}

}  // namespace clothbrdf::test
