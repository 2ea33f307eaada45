#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "formats/format.h"
#include "model/effects.h"
#include "preview/sheet.h"
#include "support/atomic_file.h"
#include "table/table_spec.h"

namespace clothbrdf {

// Options that several commands share, from text to values. All throw InputError that names the
// option, what was given and what is allowed.

/// "specular,no-scatter": effects from words joined by ',' (model/effects.h).
Effects parse_effects(const std::string& list);

/// --effects, whose text is for parse_effects; `of` says of what: "of materials". `value` must live
/// as long as the command.
void add_effects_option(CLI::App& command, std::optional<std::string>& value,
                        const std::string& of = "");

/// "point", "average" or "average:REL".
CellRule parse_cells(const std::string& text);

/// 1 to 1024.
int parse_threads(const std::string& text);

/// Adds an option whose text is kept apart from none at all, even if it is empty. `value` must live
/// as long as the command.
void add_text_option(CLI::App& command, const std::string& name, std::optional<std::string>& value,
                     const std::string& type, const std::string& help);

/// --threads, and what it stands for: all processors where it is left out.
void add_threads_option(CLI::App& command, std::optional<std::string>& value);
int threads_of(const std::optional<std::string>& value);

/// A number of an option, from lowest to highest.
struct NumberRange {
  double lowest;
  double highest;
  bool whole;
};
double parse_number(const std::string& option, const std::string& text, const NumberRange& range);

/// "THETA,PHI" in degrees, theta from 0 to below 90.
SheetDirection parse_direction(const std::string& option, const std::string& text);

/// The endings of the tables that are read and written, for people.
std::string table_endings();

/// Whether two names stand for one file, there or not.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// "1,458,000", for people.
std::string with_commas(std::uint64_t number);

/// Reads a table of any format.
Table read_table(const std::string& file);

/// All of a file's content; the caller commits.
void write_text(const std::string& text, AtomicFile& file);

/// "specular, internal:4, no-scatter", for people.
std::string effects_text(const Effects& effects);

}  // namespace clothbrdf
