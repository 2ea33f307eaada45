#pragma once

#include <optional>
#include <ostream>
#include <string>

#include "fit/misfit.h"
#include "fit/table_values.h"
#include "tests/support/derivatives.h"
#include "tests/support/fit_cases.h"

namespace clothbrdf::test {

/// What decides which code makes a residual.
struct Setting {
  Grid grid;
  bool average = false;
  Reflectance reflectance = Reflectance::kMicrofacet;
  Paths paths = Paths::kAll;
  std::size_t channels = 1;
  std::vector<std::string> tied;
  bool reduce = true;
};

inline void print(std::ostream& out, const Setting& s) {
  out << s.grid.description() << (s.average ? " averages" : " points")
      << (s.reflectance == Reflectance::kPaper ? " paper" : " microfacet")
      << (s.paths == Paths::kAll ? " all" : " single") << ' ' << s.channels << " channels, "
      << s.tied.size() << " tied, " << (s.reduce ? "reduced" : "all") << " rows";
}

/// Residuals of a made-up table: values around those of a first material, so that none vanish.
class Problem {
 public:
  Problem(const Setting& setting, const Material& first, std::uint64_t seed)
      : setting_(setting),
        spec_{setting.grid, channels(setting.channels), {setting.average, 1e-3}, {}},
        observations_(observe(spec_, setting.reflectance, 1)) {
    FitOptions options;
    for (const std::string& name : setting.tied) {
      options.wishes.push_back({ParameterWish::Kind::kTie, name, {}, {}, {}});
    }
    set_.emplace(options, setting.channels, setting.grid.kind != GridKind::kHalfDifference3d);
    const ModelValues fit = model_values(observations_, first, kExact, 1);
    RandomInputs random(seed);
    const ValueSource source = [&](std::size_t g, std::size_t c, std::span<double> values) {
      const Observations::Group& group = observations_.groups[g];
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = fit.diffuse[c];
        for (std::size_t s = 0; s < group.sites; ++s) {
          values[k] += observations_.factors[group.first_factor + s * group.samples + k] *
                       fit.site[(group.first_site + s) * observations_.channels + c];
        }
        values[k] *= 1 + random.uniform(-0.3, 0.3);
      }
    };
    rows_ = make_rows(observations_, source, {}, &fit, setting.reduce, 1);
  }

  Misfit misfit() const { return {observations_, rows_, kExact, 1}; }
  double largest_residual(const Material& material) const {
    double largest = 0;
    for (const double r : misfit().residuals(material, *set_, nullptr)) {
      largest = std::max(largest, std::abs(r));
    }
    return largest;
  }
  const ParameterSet& set() const { return *set_; }
  const Setting& setting() const { return setting_; }

  /// Residuals as a function of one free parameter's coordinate, all else as in the material.
  std::vector<double> residuals_at(const Material& material, std::size_t free,
                                   double coordinate) const {
    std::vector<double> all = set_->coordinates(material);
    all[free] = coordinate;
    return misfit().residuals(set_->material(all, material), *set_, nullptr);
  }

 private:
  static std::vector<Channel> channels(std::size_t count) {
    std::vector<Channel> result;
    for (std::size_t c = 0; c < count; ++c) {
      result.push_back({"c" + std::to_string(c), Part::kTotal, c});
    }
    return result;
  }

  Setting setting_;
  TableSpec spec_;
  Observations observations_;
  std::optional<ParameterSet> set_;
  Rows rows_;
};

/// The largest error of a column of the derivative.
struct SlopeError {
  double error = 0;
  std::size_t row = 0;
  double exact = 0;
  double numeric = 0;
};

/// Relative to the element; of elements below a thousandth of the column's largest, or of the
/// largest residual, to that: differences cannot see more in residuals that are rounded.
inline SlopeError slope_error(const Eigen::MatrixXd& slopes, std::size_t column,
                              const std::vector<double>& numeric, double largest_residual) {
  constexpr double kSmallElement = 1e-3;
  const auto at = static_cast<Eigen::Index>(column);
  double largest = largest_residual;
  for (const double x : numeric) largest = std::max(largest, std::abs(x));
  SlopeError worst;
  for (std::size_t r = 0; r < numeric.size(); ++r) {
    const double exact = slopes(static_cast<Eigen::Index>(r), at);
    const double size = std::max(std::abs(exact), kSmallElement * largest);
    const double error = std::abs(exact - numeric[r]) / size;
    if (!(error <= worst.error)) worst = {error, r, exact, numeric[r]};
  }
  return worst;
}

}  // namespace clothbrdf::test
