#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/format.h"
#include "table/compare.h"

namespace clothbrdf {

/// What a user asks of a table in another format.
struct ConversionWish {
  std::string out;                  ///< file to write
  std::optional<std::string> grid;  ///< as --grid takes it
  bool isotropic = false;           ///< the mean over rotations of the cloth
  WriteOptions write;
};

/// How a table goes into a format.
struct Conversion {
  const Format* format = nullptr;
  TableSpec spec;                 ///< what is written: samples and channels
  std::vector<std::string> lost;  ///< for people, each thing on its own
  std::string compared_at;        ///< where the error was measured: "at the old nodes"
};

/// The source's own samples and channels where the format takes them; else the samples that cost
/// least, totals only, in the format's colours. Throws InputError where the format cannot hold the
/// table at all.
Conversion plan_conversion(const Table& source, const ConversionWish& wish);

/// Resamples, writes and commits; says how far the file is from the source: at the source's nodes,
/// or at random pairs as the file's readers interpolate. None where nothing was resampled. Adds to
/// `lost` what shows only then.
std::optional<ChannelDifference> run_conversion(const Table& source, const ConversionWish& wish,
                                                Conversion& conversion, AtomicFile& file);

}  // namespace clothbrdf
