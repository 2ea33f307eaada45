#pragma once

#include "cost/report.h"
#include "formats/material_json.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

/// A report with all there is: three fronts of two dials each, of made-up numbers.
inline CostReport full_cost_report() {
  CostReport report;
  report.program = "clothbrdf 0.1.0";
  report.material = read_material(preset("silk"));
  report.threads = 2;
  report.repeats = 3;
  report.pairs = 200000;
  report.seed = 7;
  for (const std::string front : {"3-D", "4-D", "evaluation"}) {
    const bool file = front != "evaluation";
    for (int step = 0; step < 6; ++step) {
      for (const bool good : {true, false}) {
        CostSetting setting;
        setting.front = front;
        setting.dial = good ? "chosen nodes" : "uniform axes";
        if (!file) setting.dial = good ? "layers kept" : "rotations";
        const std::string size = std::to_string(12 << step);
        setting.name = front;
        setting.name.append(" ").append(setting.dial).append(" ").append(size);
        const double seconds = 0.013 * (1 << (2 * step)) * (good ? 1 : 1.3);
        setting.seconds = {seconds, 0.9 * seconds, 1.2 * seconds};
        setting.error.rms = (good ? 0.2 : 0.31) / (1 << (2 * step));
        setting.error.p99 = 3 * setting.error.rms;
        setting.error.max = 20 * setting.error.rms;
        setting.size = 12 << step;
        setting.pareto = good;
        if (file) {
          setting.format = "EXR";
          setting.grid = "halfdiff4d:" + size + "x36x45x45";
          setting.cells = "point";
          setting.stored = "half";
          setting.reader = "linear";
          setting.one_thread = Timing{1.7 * seconds, 1.6 * seconds, 1.8 * seconds};
          setting.all_threads = Timing{0.9 * seconds, 0.8 * seconds, seconds};
          setting.writing = Timing{0.1 * seconds, 0.1 * seconds, 0.1 * seconds};
          setting.bytes = 120000U << step;
          setting.peak_memory = 500000U << step;
          if (front == "3-D") setting.isotropy_loss = 0.31;
        }
        report.settings.push_back(setting);
      }
    }
  }
  report.convergence = {{"uniform axes", "rms ~ step^order", 2, 1.9, false, ""},
                        {"layers kept", "rms ~ ratio^layers", 0.3, 0.5, true, "scatter widens"}};
  report.sentences = {"Chosen nodes are faster than even ones."};
  return report;
}

}  // namespace clothbrdf::test
