#include "formats/window_read.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/klems.h"
#include "formats/tensor_tree_xml.h"
#include "formats/window_xml.h"
#include "support/errors.h"

namespace clothbrdf {

Table read_window(const std::filesystem::path& path) {
  const WindowFile file(path);
  for (const char* matrix : {"Columns", "Rows"}) {
    if (same_word(file.structure(), matrix)) return read_klems(file);
  }
  if (same_word(file.structure(), "TensorTree4")) return read_tensor_tree(file, 4);
  if (same_word(file.structure(), "TensorTree3")) return read_tensor_tree(file, 3);
  file.refuse("IncidentDataStructure is '" + std::string(file.structure().substr(0, 40)) +
              "'; allowed: Columns, Rows, TensorTree3, TensorTree4");
}

Table window_table(PairList list, std::vector<double> values, StoredPrecision precision,
                   std::shared_ptr<const Interpolant> interpolant) {
  const std::size_t pairs = list.pairs.size();
  const bool coloured = values.size() == 3 * pairs;
  TableSpec spec{std::move(list),
                 coloured ? rgb_channels() : std::vector<Channel>{{"mono", Part::kTotal, 0}},
                 {},
                 {}};
  return {std::move(spec), std::move(values), std::vector<std::uint8_t>(pairs, 1), precision,
          std::move(interpolant)};
}

bool take_finite(std::span<const double> found, std::span<double> values) {
  const bool finite =
      std::all_of(found.begin(), found.end(), [](double value) { return std::isfinite(value); });
  for (std::size_t c = 0; c < values.size(); ++c) values[c] = finite ? found[c] : 0;
  return finite;
}

void refuse_own_samples(const TableSpec& spec, const std::string& name, const std::string& why) {
  if (std::holds_alternative<AnyPairs>(spec.samples)) return;
  throw InputError(name + ": the samples " + spec.description() + " are not allowed: " + why);
}

}  // namespace clothbrdf
