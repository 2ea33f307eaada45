#include "cli/measured_error.h"

#include <iomanip>
#include <sstream>

namespace clothbrdf {

nlohmann::ordered_json error_json(const MeasuredError& measured) {
  return {
      {"rms", measured.error.rms}, {"p99", measured.error.p99},
      {"max", measured.error.max}, {"reader", measured.reader},
      {"pairs", measured.pairs},   {"against", measured.of_mean ? "mean over rotations" : "cloth"}};
}

std::string error_text(const MeasuredError& measured) {
  std::ostringstream text;
  text << std::setprecision(3) << "error read " << measured.reader
       << (measured.of_mean ? ", against the mean over rotations" : "") << ": rms "
       << measured.error.rms << ", p99 " << measured.error.p99 << ", max " << measured.error.max;
  return text.str();
}

}  // namespace clothbrdf
