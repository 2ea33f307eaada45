#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "table/table.h"

namespace clothbrdf {

// Internal to formats/. What readers and writers of the kinds of WINDOW's XML share.

/// Reads a file of any kind that WINDOW's XML has here: Klems matrices and tensor trees. Throws
/// InputError.
Table read_window(const std::filesystem::path& path);

/// A table of pairs with three channels, R, G and B, or with one, "mono", as the number of values
/// says. Samples with a value that is negative stay as they are: X, Y and Z may lie outside what R,
/// G and B can show.
Table window_table(PairList list, std::vector<double> values, StoredPrecision precision,
                   std::shared_ptr<const Interpolant> interpolant);

/// For interpolants: copies the values if all are finite; else zeroes and false.
bool take_finite(std::span<const double> found, std::span<double> values);

/// For checks: throws InputError unless a spec leaves the nodes to the format.
void refuse_own_samples(const TableSpec& spec, const std::string& name, const std::string& why);

}  // namespace clothbrdf
