#include "model/effects.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "model/parameters.h"

namespace clothbrdf {
namespace {

constexpr std::string_view kOff = "no-";
constexpr std::string_view kFresnelAngle = "fresnel_angle";
constexpr std::string_view kAllowed =
    "specular, internal[:LAYERS], diffuse; interreflection:EVENTS; no-near_side, "
    "no-interreflection, no-scatter, no-colour, no-second_yarn, no-anisotropy, no-shadowing, "
    "no-fresnel_angle=COSINE";

template <class T>
std::optional<T> number(std::string_view text, T lowest, T highest) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || !(value >= lowest && value <= highest)) return std::nullopt;
  return value;
}

// Words to effects, one by one, up to the first that is wrong.
class Words {
 public:
  void add(std::string_view word) {
    if (word.starts_with(kOff)) {
      turn_off(word, word.substr(kOff.size()));
    } else {
      turn_on(word);
    }
  }

  const std::string& problem() const { return problem_; }

  Effects effects() {
    for (std::size_t k = 0; k < std::size(kComponentEffects); ++k) {
      if (any_named_ && !named_[k]) effects_.*kComponentEffects[k].second = false;
    }
    return effects_;
  }

 private:
  void fail(std::string_view word, const std::string& what) {
    problem_ = "'" + std::string(word) + "' " + what;
  }

  // A word that is there, on or off.
  void set(std::string_view word, bool& member, bool on, bool contradicted) {
    if (contradicted) {
      fail(word, "contradicts another word");
    } else {
      member = on;
    }
  }

  void set_layers(std::string_view word, std::string_view limit) {
    effects_.layers = number<int>(limit, 0, kMaxLayers);
    if (!effects_.layers) fail(word, "is not allowed: internal:0 to internal:64");
  }

  void set_events(std::string_view word, std::string_view limit) {
    effects_.events = number<int>(limit, 1, kLastEvent);
    if (!effects_.events) {
      fail(word, "is not allowed: interreflection:1 to interreflection:1025");
    }
  }

  void turn_on(std::string_view word) {
    const std::size_t colon = word.find(':');
    const std::string_view name = word.substr(0, colon);
    const bool limited = colon != std::string_view::npos;
    const std::string_view limit = limited ? word.substr(colon + 1) : std::string_view();
    if (limited && name != "internal" && name != "interreflection") {
      fail(word, "takes no limit");
      return;
    }
    if (name == kFresnelAngle) return;  // on, as it is anyway
    for (std::size_t k = 0; k < std::size(kComponentEffects); ++k) {
      if (kComponentEffects[k].first != name) continue;
      any_named_ = named_[k] = true;
      set(word, effects_.*kComponentEffects[k].second, true,
          !(effects_.*kComponentEffects[k].second));
      if (limited) set_layers(word, limit);
      return;
    }
    for (const auto& [other, member] : kOtherEffects) {
      if (other != name) continue;
      set(word, effects_.*member, true, !(effects_.*member));
      if (limited) set_events(word, limit);
      return;
    }
    fail(word, "is not an effect; allowed: " + std::string(kAllowed));
  }

  void turn_off(std::string_view word, std::string_view name) {
    const std::size_t equals = name.find('=');
    if (name.substr(0, equals) == kFresnelAngle) {
      if (equals == std::string_view::npos) {
        fail(word,
             "needs a cosine of incidence, as in no-fresnel_angle=0.8 (clothbrdf plan finds that "
             "of a scene)");
        return;
      }
      effects_.cos_theta_d = number<double>(name.substr(equals + 1), 0, 1);
      if (!effects_.cos_theta_d) fail(word, "is not allowed: a cosine from 0 to 1");
      return;
    }
    for (std::size_t k = 0; k < std::size(kComponentEffects); ++k) {
      if (kComponentEffects[k].first != name) continue;
      set(word, effects_.*kComponentEffects[k].second, false, named_[k]);
      return;
    }
    for (const auto& [other, member] : kOtherEffects) {
      if (other != name) continue;
      set(word, effects_.*member, false, name == "interreflection" && effects_.events);
      return;
    }
    fail(word, "is not an effect; allowed: " + std::string(kAllowed));
  }

  Effects effects_;
  std::string problem_;
  bool named_[std::size(kComponentEffects)] = {};
  bool any_named_ = false;
};

}  // namespace

std::vector<std::string> effect_words(const Effects& effects) {
  std::vector<std::string> words;
  for (const auto& [name, member] : kComponentEffects) {
    if (!(effects.*member)) continue;
    words.emplace_back(name);
    if (name == "internal" && effects.layers) words.back() += ":" + std::to_string(*effects.layers);
  }
  if (words.empty()) {
    for (const auto& [name, member] : kComponentEffects) words.push_back(std::string(kOff) += name);
  }
  for (const auto& [name, member] : kOtherEffects) {
    if (!(effects.*member)) words.push_back(std::string(kOff) += name);
  }
  if (effects.interreflection && effects.events) {
    words.push_back("interreflection:" + std::to_string(*effects.events));
  }
  if (effects.cos_theta_d) {
    words.push_back("no-fresnel_angle=" + number_text(*effects.cos_theta_d));
  }
  return words;
}

std::vector<std::string> shortcut_words(const Effects& effects) {
  Effects components;
  for (const auto& [name, member] : kComponentEffects) components.*member = effects.*member;
  const std::vector<std::string> plain = effect_words(components);
  std::vector<std::string> words = effect_words(effects);
  std::erase_if(words, [&](const std::string& word) {
    return std::find(plain.begin(), plain.end(), word) != plain.end();
  });
  return words;
}

std::optional<Effects> effects_from_words(const std::vector<std::string>& words,
                                          std::string& problem) {
  Words read;
  for (const std::string& word : words) {
    read.add(word);
    if (read.problem().empty()) continue;
    problem = read.problem();
    return std::nullopt;
  }
  return read.effects();
}

}  // namespace clothbrdf
