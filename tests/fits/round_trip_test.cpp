#include <chrono>
#include <iostream>
#include <set>

#include "formats/format.h"
#include "tests/catch.h"
#include "tests/fits/match.h"
#include "tests/support/make_table.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

// What noise-free tables give back (the promise; the worst measured are printed).
constexpr double kExactly = 1e-6;
constexpr double kNoise = 0.01;
// Predicted standard errors, and the share of parameters that stay within so many: of Gaussian
// errors all but 6e-5 do.
constexpr double kErrors = 4;
constexpr double kShareWithin = 0.99;

struct Tally {
  int fits = 0;
  int layers = 0;
  int identifiable = 0;
  int within = 0;
  int with_error = 0;
  double worst = 0;
  std::string where;
  double seconds = 0;
};

std::ostream& operator<<(std::ostream& out, const Tally& t) {
  out << t.fits << " fits, layer counts right in " << t.layers << ", " << t.identifiable
      << " parameters identifiable, ";
  if (t.with_error > 0) {
    out << t.within << " of " << t.with_error << " within " << kErrors << " standard errors, ";
  }
  return out << "worst relative error " << t.worst << " in " << t.where << ", " << t.seconds
             << " s";
}

void add(const FitReport& report, const Material& truth, int number, double allowed, Tally& tally) {
  const Comparison match = best_match(report, truth);
  INFO("material " << number << ", equivalent '" << match.words << "', layers "
                   << report.layers.warp << ' ' << report.layers.weft << " for "
                   << truth.warp.layers << ' ' << truth.weft.layers << ", chi2 " << report.chi2);
  CHECK(report.failure == "");
  CHECK(report.converged);
  CHECK(match.layers);
  ++tally.fits;
  if (match.layers) ++tally.layers;
  tally.seconds += report.seconds;
  for (const Match& m : match.matches) {
    // Without noise, standard errors are those of rounding, and rounding is not Gaussian.
    if (allowed == 0 && m.standard_error && is_fitted(m.verdict)) {
      ++tally.with_error;
      if (m.off <= kErrors * *m.standard_error) ++tally.within;
    }
    if (m.verdict != Verdict::kIdentifiable) continue;
    ++tally.identifiable;
    INFO(m.name << ' ' << m.found << " for " << m.truth);
    if (allowed > 0) CHECK(m.error <= allowed);
    if (m.error > tally.worst) tally.where = m.name + " of material " + std::to_string(number);
    tally.worst = std::max(tally.worst, m.error);
  }
}

FitReport fit_noisy(const Table& table, const Material& truth, std::uint64_t seed) {
  FitOptions options = conventions_of(truth);
  options.noise = kNoise;
  return fit_table(noisy(table, kNoise, seed), options, 1);
}

}  // namespace

TEST_CASE("random cloths come back from a 4-D table without a guess") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  Tally tally;
  for (int n = 0; n < soak_cases(20); ++n) {
    const Material truth = random_cloth(random);
    const Table table = table_of(truth, halfdiff4d(16, 12, 10, 10));
    add(fit_table(table, conventions_of(truth), 1), truth, n, kExactly, tally);
  }
  std::cout << "round trip, 4-D, no noise: " << tally << " (seed " << seed << ")\n";
  // Nearly all of the 17 of each.
  CHECK(tally.identifiable >= 15 * tally.fits);
}

TEST_CASE("random cloths come back from a noisy 4-D table within the predicted errors") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed);
  Tally tally;
  for (int n = 0; n < soak_cases(20); ++n) {
    const Material truth = random_cloth(random);
    const Table table = table_of(truth, halfdiff4d(16, 12, 10, 10));
    add(fit_noisy(table, truth, seed + static_cast<std::uint64_t>(n)), truth, n, 0, tally);
  }
  std::cout << "round trip, 4-D, 1 % noise: " << tally << " (seed " << seed << ")\n";
  CHECK(tally.with_error >= 10 * tally.fits);
  CHECK(tally.within >= kShareWithin * tally.with_error);
}

TEST_CASE("random cloths come back from a MERL file up to the axes' and the yarns' order") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed + 2);
  const TemporaryFolder folder;
  Tally exact;
  Tally with_noise;
  for (int n = 0; n < soak_cases(3); ++n) {
    Material truth = random_cloth(random);
    truth.rotation_deg = 0;
    const std::filesystem::path path = folder / ("cloth" + std::to_string(n) + ".binary");
    write_table(*make_producer(material_spec(truth, {}, halfdiff3d()), 1), path);
    const Table table = format_for(path).read(path);
    const FitReport report = fit_table(table, conventions_of(truth), 1);
    add(report, truth, n, kExactly, exact);
    // Two orders of the axes in each yarn, two of the yarns: eight in all.
    CHECK(report.equivalents.size() == 7);
    std::set<std::string> words;
    for (const Equivalent& e : report.equivalents) words.insert(e.words);
    for (const char* expected : {"the warp's lobe axes exchanged", "the weft's lobe axes exchanged",
                                 "the yarns exchanged"}) {
      std::string all;
      for (const std::string& w : words) all += w + "; ";
      INFO(expected << " in " << all);
      CHECK(words.contains(expected));
    }
    add(fit_noisy(table, truth, seed + static_cast<std::uint64_t>(n)), truth, n, 0, with_noise);
  }
  std::cout << "round trip, MERL file, no noise: " << exact << " (seed " << seed
            << ")\nround trip, MERL file, 1 % noise: " << with_noise << '\n';
  CHECK(with_noise.within >= kShareWithin * with_noise.with_error);
}

TEST_CASE("random cloths come back from scattered samples, isotropic or not") {
  const std::uint64_t seed = seed_from_environment();
  RandomInputs random(seed + 3);
  Tally tally;
  for (const bool isotropic : {false, true}) {
    Material truth = random_cloth(random);
    if (isotropic) truth.rotation_deg = 0;
    PairList list{{}, isotropic};
    for (int k = 0; k < 1500; ++k) {
      list.pairs.push_back({random.uniform(0, 80), random.uniform(0, 360), random.uniform(0, 80),
                            random.uniform(0, 360)});
    }
    const Table table = collect(*make_producer(material_spec(truth, {}, list), 1), 1);
    const FitReport report = fit_table(table, conventions_of(truth), 1);
    add(report, truth, isotropic ? 1 : 0, kExactly, tally);
    if (isotropic) CHECK(report.equivalents.size() == 7);
  }
  std::cout << "round trip, scattered samples: " << tally << " (seed " << seed << ")\n";
}

}  // namespace clothbrdf::test
