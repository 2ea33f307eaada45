#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cost/dry_run.h"
#include "cost/verified.h"
#include "scene/plan.h"

namespace clothbrdf {

/// A file that tabulate writes: what was asked for and how it is made.
struct TableOutput {
  FileOrder order;
  FileSetting setting;
  TableSpec spec;    // in the file's colours
  std::string note;  // what this file cannot hold of the material
  std::optional<MeasuredError> error;
  std::optional<MaterialPlan> plan;  // of a scene's cloth: what is left out of the table

  std::filesystem::path path() const { return order.name; }
};

/// Fills in what follows from the setting: spec and note.
void describe(TableOutput& output);

/// Prints what was written, or what would be, as a line for people or as JSON.
void report_written(const TableOutput& output, std::uint64_t bytes, double seconds, bool as_json);
void report_expected(const TableOutput& output, const Prediction& expected, bool as_json);

}  // namespace clothbrdf
