#include "cost/verified.h"

#include <iomanip>
#include <sstream>
#include <utility>

#include "support/errors.h"

namespace clothbrdf {
namespace {

// Further digits depend on the processor, and the size of the file that states them would, too.
double to_six_digits(double value) {
  std::stringstream text;
  text << std::setprecision(6) << value;
  text >> value;
  return value;
}

}  // namespace

VerifiedSetting choose_verified(const FileOrder& order, const Target& target,
                                const Workers& workers) {
  const SettingChooser chooser(order, target, workers);
  double aim = target.tolerance;
  constexpr int kMostAttempts = 4;
  MeasuredError error;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    FileSetting setting = chooser.choose(aim);
    error = chooser.verify(written_and_read(order, setting, workers));
    const double reached = chooser.limited(error.error);
    if (reached <= target.tolerance) {
      for (double* const figure : {&error.error.rms, &error.error.p99, &error.error.max}) {
        *figure = to_six_digits(*figure);
      }
      return {std::move(setting), error};
    }
    aim *= 0.99 * target.tolerance / reached;
  }
  std::ostringstream text;
  text << std::setprecision(3) << order.name << ": --tolerance " << target.tolerance
       << " is not reached: the least error found on fresh pairs is "
       << chooser.limited(error.error);
  throw WorkError(text.str());
}

}  // namespace clothbrdf
