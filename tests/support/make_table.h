#pragma once

#include <filesystem>
#include <memory>

#include "formats/format.h"
#include "formats/material_json.h"
#include "tabulate/model_producer.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

inline Table preset_table(const std::string& name, const Grid& grid, bool with_components = false,
                          const CellRule& cells = {}) {
  const TableSpec spec =
      material_spec(read_material(preset(name)), {}, grid, cells, with_components);
  return collect(*make_producer(spec, 1), 1);
}

inline Table read_table(const std::filesystem::path& path) { return format_for(path).read(path); }

/// f_r of a material at any pairs of directions.
inline std::unique_ptr<Producer> pair_producer(const Material& material) {
  return make_producer(material_spec(material, {}, AnyPairs{}), 1);
}

inline void write_table(const Producer& producer, const std::filesystem::path& path,
                        const WriteOptions& options = {}) {
  AtomicFile file(path);
  clothbrdf::write_table(format_for(path), producer, file, options);
  file.commit();
}

}  // namespace clothbrdf::test
