#pragma once

#include <memory>
#include <optional>
#include <string>

#include "formats/format.h"
#include "model/effects.h"
#include "model/material.h"
#include "tabulate/kernel.h"

namespace clothbrdf {

/// A file that is wanted: what of, and in which format.
struct FileOrder {
  Material material;
  Effects effects;
  bool with_components = false;
  const Format* format = nullptr;
  WriteOptions options;
  bool isotropic = false;           ///< the mean over rotations, where the format leaves the choice
  std::string name;                 ///< of the file; scratch files go beside it
  std::optional<Reach> reach = {};  ///< of a scene: what the cells of a grid are computed for
};

/// How a file is made.
struct FileSetting {
  Samples samples;
  CellRule cells;
  WriteOptions options;
  TableError error = {};  ///< as predicted or, where only a whole file can tell, measured
};

/// What a file of that setting is computed from, without the format's colours.
TableSpec computed_spec(const FileOrder& order, const FileSetting& setting);

/// Throws InputError where the format, or the model, cannot do it.
void check_setting(const FileOrder& order, const FileSetting& setting);
bool is_allowed(const FileOrder& order, const FileSetting& setting);

/// The precision that the kernels need for a file.
Precision kernel_precision(const FileOrder& order, const FileSetting& setting);

/// Whether no value of a grid is larger than the file can store: computes them all.
bool values_fit(const FileOrder& order, const FileSetting& setting, const Workers& workers);

/// All of a file's content, with `error` in its description where that is given; the caller
/// commits. Begins a phase of the workers' progress.
void write_setting(const FileOrder& order, const FileSetting& setting, AtomicFile& file,
                   const Workers& workers, const std::optional<MeasuredError>& error = {});

/// Writes a file of that setting into one without a name, and reads it back.
Table written_and_read(const FileOrder& order, const FileSetting& setting, const Workers& workers);

/// f_r of the material at any pairs of directions, in the format's colours.
class PairModel {
 public:
  PairModel(const FileOrder& order, bool isotropic, const Workers& workers);
  const Producer& get() const { return coloured_ ? *coloured_ : *computed_; }

 private:
  std::unique_ptr<Producer> computed_;
  std::unique_ptr<Producer> coloured_;
};

}  // namespace clothbrdf
