#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/material.h"
#include "table/sampled_error.h"

namespace clothbrdf {

/// Repeated timings, seconds.
struct Timing {
  double median = 0;
  double lowest = 0;
  double highest = 0;
};

/// One way to make a table, or to evaluate the model, and what it costs.
struct CostSetting {
  std::string dial;    ///< what it belongs to: "uniform axes", "chosen nodes", "layers kept"
  std::string name;    ///< unique, for people: "EXR halfdiff4d:45x36x45x45 half, linear"
  std::string front;   ///< "3-D" or "4-D" of those that write a file; else "evaluation"
  std::string format;  ///< of the file; empty without one, as the next four
  std::string grid;
  std::string cells;   ///< "point", "average:0.001"
  std::string stored;  ///< "half", "float", "double"
  std::string reader;  ///< "nearest", "linear", or the format's own
  double size = 0;     ///< what convergence counts: cells, kept layers, rotations; 0 for none

  TableError error;  ///< docs/accuracy.md
  /// rms of the azimuthal mean against the anisotropic cloth; of 3-D tables.
  std::optional<double> isotropy_loss;
  Timing
      seconds;  ///< of the whole file, all threads; of evaluations, of a million pairs, one thread
  std::optional<Timing> one_thread;   ///< computing all values, written nowhere
  std::optional<Timing> all_threads;  ///< the same
  std::optional<Timing> writing;      ///< a table in memory to the file
  std::optional<std::uint64_t> bytes;
  std::optional<std::uint64_t> peak_memory;  ///< bytes that the work added at most
  bool pareto = false;  ///< of its front: none is both faster and as accurate (rms)
};

/// How fast errors fall along a dial.
struct Convergence {
  std::string dial;
  std::string law;  ///< "rms ~ step^order", "rms ~ ratio^layers"
  double expected = 0;
  double fitted = 0;
  bool differs = false;
  std::string reason;  ///< why it differs; empty where it does not
};

/// What `clothbrdf cost` measured.
struct CostReport {
  std::string program;  ///< "clothbrdf 0.1.0"
  Material material;
  int threads = 1;
  int repeats = 1;  ///< of every timing
  std::size_t pairs = 0;
  std::uint64_t seed = 0;
  std::vector<CostSetting> settings;  ///< by front, then by time
  std::vector<Convergence> convergence;
  std::vector<std::string> sentences;  ///< what the fronts say, for people
};

}  // namespace clothbrdf
