#pragma once

#include <filesystem>

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

inline void write_table(const Producer& producer, const std::filesystem::path& path,
                        const WriteOptions& options = {}) {
  AtomicFile file(path);
  clothbrdf::write_table(format_for(path), producer, file, options);
  file.commit();
}

}  // namespace clothbrdf::test
