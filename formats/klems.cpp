#include "formats/klems.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "formats/klems_basis.h"
#include "formats/pair_mean.h"
#include "formats/tristimulus.h"
#include "formats/window_read.h"
#include "support/errors.h"
#include "support/threads.h"

namespace clothbrdf {
namespace {

using PatchMean = AdaptivePairMean<KlemsPatch>;

// Cuts a pair, on average over the patches of the eye: easy ones leave theirs to the others.
constexpr std::size_t kCutsPerPair = 6;
// A relative 1e-16, times what the way through X, Y and Z loses of a saturated colour.
constexpr StoredPrecision kKlemsPrecision = {1e-12, 0x1p-1074};

// The patch that a direction's opposite azimuth falls into.
std::size_t opposite(const KlemsBasis& basis, std::size_t patch) {
  std::size_t first = 0;
  for (const KlemsBasis::Band& band : basis.bands()) {
    if (patch < first + band.patches) {
      return first + (patch - first + band.patches / 2) % band.patches;
    }
    first += band.patches;
  }
  return patch;
}

// Means of one patch of the light with all of the eye.
void fill_light_patch(const Producer& producer, const Workers& workers,
                      const std::vector<PatchMean::Ruled>& patches, std::size_t light,
                      std::span<Rgb> means) {
  PatchMean mean(producer, kKlemsAccuracy);
  std::vector<std::pair<double, std::size_t>> hard;  // relative error, patch of the eye
  for (std::size_t eye = 0; eye < patches.size(); ++eye) {
    const PatchMean::Estimate first = mean.estimate(patches[light], patches[eye]);
    means[eye] = first.mean;
    if (first.good) continue;
    double error = 0;
    for (std::size_t c = 0; c < means[eye].size(); ++c) {
      error = std::max(error, first.error[c] / std::abs(first.mean[c]));
    }
    hard.emplace_back(error, eye);
  }
  std::sort(hard.begin(), hard.end());
  std::size_t budget = kCutsPerPair * patches.size();
  for (std::size_t k = 0; k < hard.size(); ++k) {
    workers.check();
    std::size_t cuts = budget / (hard.size() - k);
    budget -= cuts;
    means[hard[k].second] = mean.refine(patches[light], patches[hard[k].second], cuts);
    budget += cuts;
  }
  workers.advance(patches.size());
}

// means[light][eye]
std::vector<Rgb> patch_means(const Producer& producer, const Workers& workers) {
  const KlemsBasis& basis = KlemsBasis::full();
  std::vector<PatchMean::Ruled> patches;
  for (std::size_t k = 0; k < basis.size(); ++k) patches.emplace_back(basis.patch(k));
  std::vector<Rgb> means(patches.size() * patches.size());
  with_threads(workers.threads, [&] {
    run_parallel(patches.size(), workers, [&](std::size_t light) {
      fill_light_patch(producer, workers, patches, light,
                       std::span(means).subspan(light * patches.size(), patches.size()));
    });
  });
  return means;
}

std::string basis_definition(const KlemsBasis& basis) {
  const auto degrees = [](double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  };
  std::string text =
      "<IncidentDataStructure>Columns</IncidentDataStructure>\n<AngleBasis>\n<AngleBasisName>" +
      std::string(basis.name()) + "</AngleBasisName>\n";
  double low = 0;
  for (const KlemsBasis::Band& band : basis.bands()) {
    const double centre = low == 0 ? 0 : (low + band.theta_high) / 2;
    text += "<AngleBasisBlock><Theta>" + degrees(centre) + "</Theta><nPhis>" +
            std::to_string(band.patches) + "</nPhis><ThetaBounds><LowerTheta>" + degrees(low) +
            "</LowerTheta><UpperTheta>" + degrees(band.theta_high) +
            "</UpperTheta></ThetaBounds></AngleBasisBlock>\n";
    low = band.theta_high;
  }
  return text + "</AngleBasis>\n";
}

void write_klems(const Producer& producer, AtomicFile& file, const WriteOptions& options) {
  const KlemsBasis& basis = KlemsBasis::full();
  const std::vector<Rgb> means = patch_means(producer, options.workers);
  WindowWriter out(file, producer.spec(), basis_definition(basis));
  const std::string name(basis.name());
  const std::string bases = "<ColumnAngleBasis>" + name + "</ColumnAngleBasis>\n<RowAngleBasis>" +
                            name + "</RowAngleBasis>\n";
  const std::pair<const char*, double Tristimulus::*> spectra[] = {
      {"Visible", &Tristimulus::y}, {"CIE-X", &Tristimulus::x}, {"CIE-Z", &Tristimulus::z}};
  for (const auto& [spectrum, component] : spectra) {
    out.begin_block(spectrum, bases);
    for (std::size_t eye = 0; eye < basis.size(); ++eye) {
      for (std::size_t column = 0; column < basis.size(); ++column) {
        const std::size_t light = opposite(basis, column);
        const Tristimulus xyz = to_tristimulus(means[light * basis.size() + eye]);
        // Saturated colours may round to a negative one; readers make it 0.
        out.text(NumberString(std::max(0.0, xyz.*component)).view());
        out.text(column + 1 < basis.size() ? "," : "\n");
      }
    }
    out.end_block();
  }
  out.finish();
}

// The value of the patches that hold both directions.
class PatchLookup final : public Interpolant {
 public:
  PatchLookup(const KlemsBasis& light, const KlemsBasis& eye, std::vector<double> values,
              std::size_t channels)
      : light_(light), eye_(eye), values_(std::move(values)), channels_(channels) {}

  bool interpolate(const Directions& directions, std::span<double> values) const override {
    const std::size_t pair =
        light_.index_of(directions.wi) * eye_.size() + eye_.index_of(directions.wo);
    return take_finite(std::span(values_).subspan(pair * channels_, channels_), values);
  }

  std::string rule() const override {
    return "that of the patches, " + std::to_string(light_.size()) + " of the light by " +
           std::to_string(eye_.size()) + " of the eye";
  }

 private:
  const KlemsBasis& light_;
  const KlemsBasis& eye_;
  std::vector<double> values_;
  std::size_t channels_;
};

const KlemsBasis& basis_of(const WindowFile& file, std::string_view name, const char* element) {
  if (const KlemsBasis* basis = KlemsBasis::find(name)) return *basis;
  file.refuse(std::string(element) + " is '" + std::string(name.substr(0, 40)) +
              "'; allowed: LBNL/Klems Full, Half, Quarter");
}

// numbers[row][column]; as in Radiance none are below 0.
std::vector<double> read_matrix(const WindowFile& file, const char* spectrum, std::size_t count) {
  NumberText text(file.find(spectrum)->numbers);
  std::vector<double> numbers;
  while (numbers.size() < count) {
    const std::optional<double> number = text.number();
    if (!number) break;
    numbers.push_back(*number < 0 ? 0 : *number);
  }
  if (numbers.size() < count || text.peek() != '\0') {
    file.refuse("ScatteringData of " + std::string(spectrum) + ": " + text.next_words() +
                " after " + std::to_string(numbers.size()) + " numbers; it has " +
                std::to_string(count));
  }
  return numbers;
}

void check_klems(const TableSpec& spec, const WriteOptions& /*none*/, const std::string& name) {
  refuse_own_samples(spec, name, "a Klems matrix has patches of its own");
}

Layout klems_layout(const TableSpec& /*any*/, const WriteOptions& /*none*/) {
  const std::size_t size = KlemsBasis::full().size();
  const std::string text = std::to_string(size);
  return {text + "x" + text + " patches", size * size};
}

}  // namespace

Table read_klems(const WindowFile& file) {
  const ScatteringBlock& visible = file.visible();
  const bool columns = same_word(file.structure(), "Columns");
  const KlemsBasis& column_basis = basis_of(file, visible.column_basis, "ColumnAngleBasis");
  const KlemsBasis& row_basis = basis_of(file, visible.row_basis, "RowAngleBasis");
  // Radiance takes the columns' basis for the light in both structures.
  const KlemsBasis& light = column_basis;
  const KlemsBasis& eye = row_basis;
  const std::size_t count = light.size() * eye.size();
  std::vector<std::vector<double>> numbers;
  for (const char* spectrum : {"Visible", "CIE-X", "CIE-Z"}) {
    const ScatteringBlock* block = file.find(spectrum);
    if (block == nullptr) continue;
    if (!same_word(block->column_basis, visible.column_basis) ||
        !same_word(block->row_basis, visible.row_basis)) {
      file.refuse(std::string(spectrum) + " has other angle bases than Visible");
    }
    numbers.push_back(read_matrix(file, spectrum, count));
  }
  const bool coloured = numbers.size() == 3;
  PairList list;
  std::vector<double> values;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const KlemsPatch light_patch = light.patch(i);
    const std::size_t column = opposite(light, i);
    for (std::size_t o = 0; o < eye.size(); ++o) {
      const KlemsPatch eye_patch = eye.patch(o);
      const auto centre = [](const KlemsPatch& p, std::size_t index) {
        return index == 0
                   ? std::pair(0.0, 0.0)
                   : std::pair((p.theta_low + p.theta_high) / 2, (p.phi_low + p.phi_high) / 2);
      };
      const auto [theta_i, phi_i] = centre(light_patch, i);
      const auto [theta_o, phi_o] = centre(eye_patch, o);
      list.pairs.push_back({theta_i, phi_i, theta_o, phi_o});
      const std::size_t at = columns ? o * light.size() + column : column * eye.size() + o;
      if (!coloured) {
        values.push_back(numbers[0][at]);
        continue;
      }
      const Rgb rgb = to_rgb({.x = numbers[1][at], .y = numbers[0][at], .z = numbers[2][at]});
      values.insert(values.end(), rgb.begin(), rgb.end());
    }
  }
  const std::size_t channels = coloured ? 3 : 1;
  auto lookup = std::make_shared<PatchLookup>(light, eye, values, channels);
  return window_table(std::move(list), std::move(values), kKlemsPrecision, std::move(lookup));
}

Format klems_format() {
  return {
      .name = "Klems",
      .ending = ".xml",
      .summary = "145x145 patches for Radiance and WINDOW",
      .options = {},
      .default_samples = [](Reflectance, bool isotropic) -> Samples { return AnyPairs{isotropic}; },
      .colours = [](const WriteOptions&) { return Colours::kRgb; },
      .keeps_description = false,
      .averages = "detail within patches of 10 to 15 degrees: the mean over each pair of them",
      .precision = [](const WriteOptions&) { return kKlemsPrecision; },
      .check = check_klems,
      .layout = klems_layout,
      .write = write_klems,
      .read = read_window};
}

}  // namespace clothbrdf
