#pragma once

#include "cost/file_order.h"
#include "cost/nodes.h"
#include "cost/prediction.h"

namespace clothbrdf {

/// The error that is wanted of it.
struct Target {
  double tolerance = 0;  ///< relative, above 0
  Metric metric = Metric::kRms;
  bool isotropic_ok = false;  ///< the loss by averaging over rotations does not count
};

/// Chooses the setting with the fewest bytes that meets a target.
///
/// Formats that say where their nodes lie (.exr) get ChosenNodes, as few on each axis as do, and
/// half floats where these are exact enough; other grids of free sizes keep their proportions;
/// formats with a size (--size) as many bytes as are needed; the others have point and average
/// cells to choose from. Options that the order gives stay. Where cells are points the error of
/// each trial is predicted from the model (PointCells), else measured on a scratch file.
class SettingChooser {
 public:
  /// Throws InputError where the format cannot hold the material at all.
  SettingChooser(FileOrder order, Target target, const Workers& workers);

  /// The cheapest setting that meets `tolerance`. Throws WorkError that names the least error that
  /// was found where none of up to kLargestFile bytes does.
  FileSetting choose(double tolerance) const;

  /// The error of a table that was read back from a file, over other pairs than those of choose().
  MeasuredError verify(const Table& table) const;

  /// The number that the target's metric limits.
  double limited(const TableError& error) const;

 private:
  double bytes(const FileSetting& setting) const;
  void predict(FileSetting& setting) const;
  void measure(FileSetting& setting) const;
  bool meets(const FileSetting& setting, double tolerance) const;
  void choose_nodes(double tolerance, std::vector<FileSetting>& tried) const;
  std::vector<FileSetting> nodes_for(const ChosenNodes& nodes, double tolerance, bool half) const;
  FileSetting with_fewer_nodes(const ChosenNodes& nodes, FileSetting setting,
                               double tolerance) const;
  void choose_scale(double tolerance, std::vector<FileSetting>& tried) const;
  void choose_bytes(double tolerance, std::vector<FileSetting>& tried) const;
  void choose_cells(std::vector<FileSetting>& tried) const;

  FileOrder order_;
  Target target_;
  Workers workers_;
  Samples standard_;  // the format's own
  bool isotropic_;    // of the table
  PairModel model_;   // what the table holds
  Exact exact_;       // what it is measured against
  Exact fresh_;
};

/// Larger files are not tried.
inline constexpr double kLargestFile = 2e9;

}  // namespace clothbrdf
