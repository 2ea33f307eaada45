#pragma once

#include <string>
#include <vector>

#include "tests/support/fit_cases.h"

namespace clothbrdf::test {

/// A parameter of the truth and what a fit says of it.
struct Match {
  std::string name;
  double truth = 0;
  double found = 0;
  double off = 0;    ///< absolute
  double error = 0;  ///< relative; of the rotation, over 45 degrees
  Verdict verdict = Verdict::kFixed;
  std::optional<double> standard_error;
};

/// How a fit's parameters, as relabelled in one of its equivalents, compare with the truth. The
/// verdict on a value goes with it when it is relabelled.
struct Comparison {
  std::string words;  ///< of the equivalent; empty for the material that is reported
  bool layers = false;
  double distance = 0;  ///< sum of squares of the parameters' relative errors
  std::vector<Match> matches;
};

inline Comparison compare(const FitReport& report, const Material& candidate,
                          const Material& truth) {
  Comparison result;
  result.layers =
      candidate.warp.layers == truth.warp.layers && candidate.weft.layers == truth.weft.layers;
  for (const FitParameter& p : fit_parameters(truth.channel_count())) {
    Match match{p.name, parameter_value(truth, p), parameter_value(candidate, p), 0, 0, {}, {}};
    double difference = match.found - match.truth;
    if (p.column == kRotation) difference = std::remainder(difference, 180);
    match.off = std::abs(difference);
    match.error = match.off / (p.column == kRotation ? 45 : std::max(match.truth, 1e-3));
    // The reported parameter of this kind with the same value; at first the one of that name.
    const auto take = [&](const ParameterEstimate& e) {
      match.verdict = e.verdict;
      match.standard_error = e.standard_error;
    };
    const auto same_kind = [&](const std::string& name) {
      const auto kind = [](std::string n) {
        if (n.starts_with("warp.") || n.starts_with("weft.")) n = n.substr(5);
        return n.starts_with("lobe_axes") ? std::string("lobe_axes") : n;
      };
      return kind(name) == kind(p.name);
    };
    bool found = false;
    for (const ParameterEstimate& e : report.parameters) {
      if (e.name == p.name && (e.value == match.found || !p.of_yarn)) {
        take(e);
        found = true;
      }
    }
    for (const ParameterEstimate& e : report.parameters) {
      if (found || !same_kind(e.name) || e.value != match.found) continue;
      take(e);
      found = true;
    }
    result.distance += match.error * match.error;
    result.matches.push_back(match);
  }
  return result;
}

/// The nearest to the truth, of what is reported and all that is said to be equivalent.
inline Comparison best_match(const FitReport& report, const Material& truth) {
  Comparison best = compare(report, report.material, truth);
  for (const Equivalent& other : report.equivalents) {
    Comparison next = compare(report, other.material, truth);
    next.words = other.words;
    if (std::pair(!next.layers, next.distance) < std::pair(!best.layers, best.distance)) {
      best = next;
    }
  }
  return best;
}

/// Not fitted, so not to be compared.
inline bool is_fitted(Verdict verdict) {
  return verdict == Verdict::kIdentifiable || verdict == Verdict::kWeak;
}

}  // namespace clothbrdf::test
