#include "cost/choice.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "support/errors.h"

namespace clothbrdf {
namespace {

constexpr std::size_t kSearchPairs = 30000;
constexpr std::size_t kFreshPairs = 200000;
constexpr std::uint64_t kSearchSeed = 1;
constexpr std::uint64_t kFreshSeed = 2;
constexpr int kMostTrials = 16;

bool has_option(const Format& format, std::string_view option) {
  return std::find(format.options.begin(), format.options.end(), option) != format.options.end();
}

FileSetting with_samples(FileSetting setting, Samples samples) {
  setting.samples = std::move(samples);
  return setting;
}

Grid scaled(Grid grid, double scale) {
  for (Axis& axis : grid.axes) {
    axis.size = std::max(2, static_cast<int>(std::lround(axis.size * scale)));
  }
  return grid;
}

}  // namespace

SettingChooser::SettingChooser(FileOrder order, Target target, const Workers& workers)
    : order_(std::move(order)),
      target_(target),
      workers_(workers),
      standard_(order_.format->default_samples(order_.material.reflectance, order_.isotropic)),
      isotropic_(TableSpec{standard_, {}, {}, {}}.isotropic()),
      model_(order_, isotropic_, workers_) {
  const PairModel reference(order_, isotropic_ && target_.isotropic_ok, workers_);
  exact_ = exact_values(reference.get(), kSearchPairs, kSearchSeed, workers_);
  fresh_ = exact_values(reference.get(), kFreshPairs, kFreshSeed, workers_);
}

double SettingChooser::limited(const TableError& error) const {
  return target_.metric == Metric::kRms ? error.rms : error.p99;
}

bool SettingChooser::meets(const FileSetting& setting, double tolerance) const {
  return limited(setting.error) <= tolerance;
}

double SettingChooser::bytes(const FileSetting& setting) const {
  if (setting.options.bytes) return static_cast<double>(*setting.options.bytes);
  const Grid* const grid = std::get_if<Grid>(&setting.samples);
  if (grid == nullptr) return 0;  // the format has one size only
  double cells = 1;
  for (const Axis& axis : grid->axes) cells *= axis.size;
  return cells * static_cast<double>(model_.get().spec().channels.size()) *
         order_.format->precision(setting.options).bytes;
}

void SettingChooser::predict(FileSetting& setting) const {
  workers_.check();
  const PointCells cells(model_.get(), std::get<Grid>(setting.samples), order_.format->reader,
                         order_.format->precision(setting.options));
  setting.error = error_of(cells, exact_, workers_);
}

void SettingChooser::measure(FileSetting& setting) const {
  const Table table = written_and_read(order_, setting, workers_);
  setting.error = error_of(table, order_.format->reader, exact_, workers_);
}

MeasuredError SettingChooser::verify(const Table& table) const {
  return {error_of(table, order_.format->reader, fresh_, workers_),
          reader_name(table, order_.format->reader), fresh_.sampled.pairs.size(),
          isotropic_ && target_.isotropic_ok};
}

FileSetting SettingChooser::choose(double tolerance) const {
  std::vector<FileSetting> tried;
  const FileSetting standard{standard_, {}, order_.options, {}};
  const Grid* const grid = std::get_if<Grid>(&standard_);
  if (grid == nullptr && has_option(*order_.format, "--size")) {
    choose_bytes(tolerance, tried);
  } else if (grid != nullptr && is_allowed(order_, with_samples(standard, scaled(*grid, 0.5)))) {
    if (order_.format->keeps_listed_nodes) {
      choose_nodes(tolerance, tried);
    } else {
      choose_scale(tolerance, tried);
    }
  } else {
    choose_cells(tried);
  }
  const FileSetting* best = nullptr;
  double least = INFINITY;
  for (const FileSetting& setting : tried) {
    least = std::min(least, limited(setting.error));
    if (!meets(setting, tolerance)) continue;
    if (best == nullptr || bytes(setting) < bytes(*best)) best = &setting;
  }
  if (best != nullptr) return *best;
  std::ostringstream text;
  text << std::setprecision(3) << order_.name << ": --tolerance " << target_.tolerance
       << " is not reached: the least " << (target_.metric == Metric::kRms ? "rms" : "p99")
       << " error of " << order_.format->name << " files found is " << least;
  if (isotropic_ && !target_.isotropic_ok) {
    const TableError loss = error_of(model_.get(), exact_, workers_);
    text << ", of which the mean over rotations loses " << limited(loss)
         << "; --isotropic-ok leaves that out";
  }
  throw WorkError(text.str());
}

void SettingChooser::choose_nodes(double tolerance, std::vector<FileSetting>& tried) const {
  const ChosenNodes nodes(model_.get(), exact_.sampled, exact_.values, target_.metric, workers_);
  // Below this the rounding of half floats is felt; above it they only save.
  constexpr double kHalfIsFine = 3e-3;
  const bool both = !order_.options.half && has_option(*order_.format, "--half");
  bool found = false;
  for (const bool half : both ? std::vector<bool>{true, false} : std::vector{order_.options.half}) {
    if (both && !half && found && tolerance >= kHalfIsFine) continue;
    std::vector<FileSetting> of_type = nodes_for(nodes, tolerance, half);
    // The best that was found, with fewer nodes wherever they are not missed.
    const FileSetting* best = nullptr;
    for (const FileSetting& s : of_type) {
      if (meets(s, tolerance) && (best == nullptr || bytes(s) < bytes(*best))) best = &s;
    }
    if (best != nullptr) {
      FileSetting fewer = with_fewer_nodes(nodes, *best, tolerance);
      // f has no bound at grazing light, where no error is counted; half floats end at 65504.
      if (half && !values_fit(order_, fewer, workers_)) continue;
      found = true;
      tried.push_back(std::move(fewer));
    } else {
      tried.insert(tried.end(), of_type.begin(), of_type.end());
    }
  }
}

std::vector<FileSetting> SettingChooser::nodes_for(const ChosenNodes& nodes, double tolerance,
                                                   bool half) const {
  std::vector<FileSetting> tried;
  FileSetting setting{Samples{}, {}, order_.options, {}};
  setting.options.half = half;
  double aim = tolerance;
  int in_vain = 0;
  // Errors fall as the square of the steps: what was missed is made up for.
  for (int trial = 0; trial < kMostTrials; ++trial) {
    setting.samples = nodes.grid(nodes.sizes(aim));
    if (bytes(setting) > kLargestFile) break;
    predict(setting);
    tried.push_back(setting);
    const double error = limited(setting.error);
    if (error <= tolerance && error > 0.95 * tolerance) break;
    // Where rounding is what is left, more nodes do not help.
    if (error > tolerance && ++in_vain > 3 &&
        error > 0.9 * limited(tried[tried.size() - 4].error)) {
      break;
    }
    aim *= std::clamp((error > tolerance ? 0.95 : 0.98) * tolerance / error, 0.2, 5.0);
  }
  return tried;
}

FileSetting SettingChooser::with_fewer_nodes(const ChosenNodes& nodes, FileSetting setting,
                                             double tolerance) const {
  std::vector<int> sizes;
  for (const Axis& axis : std::get<Grid>(setting.samples).axes) sizes.push_back(axis.size);
  const std::size_t axes = sizes.size();
  // Fewer on one axis, and one more on another (none where `grown` is no axis).
  const auto shrink = [&](std::size_t axis, std::size_t grown, double share) {
    std::vector<int> others = sizes;
    others[axis] -= std::max(1, static_cast<int>(std::lround(share * sizes[axis])));
    if (grown < axes) ++others[grown];
    if (others[axis] < 2) return false;
    FileSetting smaller = with_samples(setting, nodes.grid(others));
    if (bytes(smaller) >= bytes(setting)) return false;
    predict(smaller);
    if (!meets(smaller, tolerance)) return false;
    setting = std::move(smaller);
    sizes = std::move(others);
    return true;
  };
  constexpr double kFinest = 0.03;
  for (const double share : {0.1, kFinest}) {
    for (bool smaller = true; smaller;) {
      smaller = false;
      for (std::size_t a = 0; a < axes; ++a) smaller = shrink(a, axes, share) || smaller;
      // At times it pays to have one more on another axis.
      for (std::size_t k = 0; share == kFinest && k < axes * axes && !smaller; ++k) {
        smaller = k / axes != k % axes && shrink(k / axes, k % axes, share);
      }
    }
  }
  return setting;
}

void SettingChooser::choose_scale(double tolerance, std::vector<FileSetting>& tried) const {
  const Grid& standard = std::get<Grid>(standard_);
  double low = 0;  // too coarse
  double high = INFINITY;
  double scale = 1;
  for (int trial = 0; trial < kMostTrials && high > 1.02 * low; ++trial) {
    FileSetting setting{scaled(standard, scale), {}, order_.options, {}};
    if (bytes(setting) > kLargestFile || !is_allowed(order_, setting)) break;
    predict(setting);
    (meets(setting, tolerance) ? high : low) = scale;
    tried.push_back(std::move(setting));
    scale = std::isinf(high) ? 1.5 * low : low == 0 ? high / 1.5 : (low + high) / 2;
    if (scale * standard.axes[0].size < 2) break;
  }
}

void SettingChooser::choose_bytes(double tolerance, std::vector<FileSetting>& tried) const {
  constexpr double kFewest = 2e4;
  constexpr double kMost = 4e8;  // readers take several times the size of a file
  double low = 0;                // too few
  double high = INFINITY;
  double size = 5e6;
  for (int trial = 0; trial < kMostTrials && high > 1.1 * low; ++trial) {
    FileSetting setting{standard_, {}, order_.options, {}};
    setting.options.bytes = static_cast<std::uint64_t>(size);
    if (!is_allowed(order_, setting)) {
      low = size;
    } else {
      measure(setting);
      (meets(setting, tolerance) ? high : low) = size;
      const double missed = limited(setting.error) / tolerance;
      tried.push_back(std::move(setting));
      // Errors fall as the square root of the bytes.
      size *= std::clamp(missed * missed * (missed > 1 ? 1.05 : 1), 0.05, 20.0);
    }
    if (low >= kMost || high <= kFewest) break;
    if (!(size > low && size < high)) size = std::isinf(high) ? 2 * low : std::sqrt(low * high);
    size = std::clamp(size, kFewest, kMost);
  }
}

void SettingChooser::choose_cells(std::vector<FileSetting>& tried) const {
  for (const bool average : {false, true}) {
    FileSetting setting{standard_, {average, 1e-3}, order_.options, {}};
    if (!is_allowed(order_, setting)) continue;
    measure(setting);
    tried.push_back(std::move(setting));
  }
}

}  // namespace clothbrdf
