#pragma once

#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "fit/options.h"
#include "model/material.h"

namespace clothbrdf {

// What choices of a fit are called in files and on the command line.

template <class T>
struct ChoiceName {
  T value;
  std::string_view name;
};

inline constexpr ChoiceName<Weighting> kWeightingNames[] = {
    {Weighting::kRelative, "relative"},
    {Weighting::kAbsolute, "absolute"},
    {Weighting::kLogarithmic, "logarithmic"}};
inline constexpr ChoiceName<Loss> kLossNames[] = {
    {Loss::kSquared, "squared"}, {Loss::kHuber, "huber"}, {Loss::kCauchy, "cauchy"}};
inline constexpr ChoiceName<Reflectance> kReflectanceNames[] = {
    {Reflectance::kMicrofacet, "microfacet"}, {Reflectance::kPaper, "paper"}};
inline constexpr ChoiceName<Paths> kPathsNames[] = {{Paths::kAll, "all"},
                                                    {Paths::kSingle, "single"}};

/// Of Reflectance and Paths, several can be fitted: the word for all.
inline constexpr std::string_view kBoth = "both";

// Ranges that the fit file and the command line share; the schema of the fit file is tested against
// them.
inline constexpr double kLeastNoise = 1e-12;
inline constexpr double kMostNoise = 1e12;
inline constexpr int kMostLayers = 64;
inline constexpr int kMostStarts = 10000;
inline constexpr double kLargestSeed = 9007199254740991;  ///< a double holds every one up to here

template <class T, std::size_t N>
std::string_view choice_name(const ChoiceName<T> (&names)[N], T value) {
  for (const ChoiceName<T>& choice : names) {
    if (choice.value == value) return choice.name;
  }
  return names[0].name;
}

template <class T, std::size_t N>
std::optional<T> find_choice(const ChoiceName<T> (&names)[N], std::string_view name) {
  for (const ChoiceName<T>& choice : names) {
    if (choice.name == name) return choice.value;
  }
  return std::nullopt;
}

}  // namespace clothbrdf
