#pragma once

#include <memory>
#include <string>

#include "formats/format.h"
#include "table/producer.h"

namespace clothbrdf {

/// The name of the only channel of a table without colours.
inline constexpr const char* kMono = "mono";

/// The same table with the channels that a format holds: wavelengths become R, G and B as seen
/// under D65, R, G and B a spectrum (table/spectrum.h), one channel without colour stands for all
/// three. Unchanged where they are there already, and where they cannot be made: check_output
/// refuses that.
TableSpec in_colours_of(const Format& format, const TableSpec& spec, const WriteOptions& options);

/// The producer of that spec; null where it is unchanged. Keeps a reference to the producer.
std::unique_ptr<Producer> in_colours_of(const Format& format, const Producer& producer,
                                        const WriteOptions& options);

/// For people: what became of the channels; empty where they are unchanged.
std::string colours_note(const TableSpec& source, const TableSpec& written);

/// Throws InputError, in one line that starts with the file's name, where the channels are not
/// those that the format holds.
void check_colours(const Format& format, const TableSpec& spec, const WriteOptions& options,
                   const std::string& name);

}  // namespace clothbrdf
