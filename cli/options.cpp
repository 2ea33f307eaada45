#include "cli/options.h"

#include <charconv>
#include <sstream>

#include "support/errors.h"

namespace clothbrdf {

Effects parse_effects(const std::string& list) {
  Effects effects{.specular = false, .internal = false, .diffuse = false};
  std::string known;
  for (const EffectName& effect : kEffectNames) {
    known.append(known.empty() ? "" : ", ").append(effect.name);
  }
  const auto fail = [&](const std::string& what) {
    return InputError("--effects: " + what + "; allowed: " + known + ", joined by ','");
  };
  std::istringstream names(list);
  bool any = false;
  for (std::string name; std::getline(names, name, ',');) {
    bool found = false;
    for (const EffectName& effect : kEffectNames) {
      if (effect.name == name) {
        effects.*effect.member = true;
        any = found = true;
      }
    }
    if (!found) throw fail("'" + name + "' is not an effect");
  }
  if (!any) throw fail("names none");
  return effects;
}

CellRule parse_cells(const std::string& text) {
  if (text == "point") return {};
  CellRule rule{.average = true};
  if (text == "average") return rule;
  const std::string prefix = "average:";
  const char* end = text.data() + text.size();
  if (text.starts_with(prefix)) {
    const auto [next, error] = std::from_chars(text.data() + prefix.size(), end, rule.tolerance);
    if (error == std::errc() && next == end && rule.tolerance >= kTightestAverage &&
        rule.tolerance <= 1)
      return rule;
  }
  throw InputError(
      "--cells: '" + text +
      "' is not allowed: point, average or average:REL, REL the relative tolerance from 1e-6 to 1");
}

int parse_threads(const std::string& text) {
  constexpr int kMost = 1024;
  int threads = 0;
  const char* end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, threads);
  if (error != std::errc() || next != end || threads < 1 || threads > kMost) {
    throw InputError("--threads: '" + text + "' is not allowed: a whole number from 1 to " +
                     std::to_string(kMost));
  }
  return threads;
}

std::string effects_text(const Effects& effects) {
  std::string text;
  for (const EffectName& effect : kEffectNames) {
    if (effects.*effect.member) text += (text.empty() ? "" : ", ") + std::string(effect.name);
  }
  return text;
}

}  // namespace clothbrdf
