#include "formats/plan_summary.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>

namespace clothbrdf {
namespace {

std::string_view name_of(std::string_view effect) {
  return effect.substr(0, effect.find_first_of(":="));
}

// The number after ':'; `without` where there is none.
int limit_of(const std::string& effect, int without) {
  const std::size_t colon = effect.find(':');
  if (colon == std::string::npos) return without;
  int limit = without;
  std::from_chars(effect.data() + colon + 1, effect.data() + effect.size(), limit);
  return limit;
}

const LeftOut* find(const std::vector<LeftOut>& left_out, std::string_view name) {
  const auto found = std::find_if(left_out.begin(), left_out.end(),
                                  [&](const LeftOut& one) { return name_of(one.effect) == name; });
  return found == left_out.end() ? nullptr : &*found;
}

// What both leave out of one effect.
LeftOut common(const LeftOut& a, const LeftOut& b) {
  // Without a limit all of it is left out.
  LeftOut less = limit_of(a.effect, -1) < limit_of(b.effect, -1) ? b : a;
  less.bound = std::max(a.bound, b.bound);
  if (a.effect != b.effect && less.effect.find('=') != std::string::npos) {
    less.effect = name_of(less.effect);
  }
  return less;
}

}  // namespace

std::vector<std::string> kept_by_any(const Plan& plan) {
  constexpr int kAll = std::numeric_limits<int>::max();
  std::vector<std::string> all;
  for (const MaterialPlan& material : plan.materials) {
    for (const std::string& effect : material.kept) {
      const auto same = std::find_if(all.begin(), all.end(), [&](const std::string& other) {
        return name_of(other) == name_of(effect);
      });
      if (same == all.end()) {
        all.push_back(effect);
      } else if (limit_of(effect, kAll) > limit_of(*same, kAll)) {
        *same = effect;
      }
    }
  }
  return all;
}

std::vector<LeftOut> left_out_by_all(const Plan& plan) {
  std::vector<LeftOut> all;
  for (const LeftOut& first : plan.materials.front().left_out) {
    LeftOut shared = first;
    const bool by_all = std::all_of(
        plan.materials.begin() + 1, plan.materials.end(), [&](const MaterialPlan& material) {
          const LeftOut* other = find(material.left_out, name_of(first.effect));
          if (other != nullptr) shared = common(shared, *other);
          return other != nullptr;
        });
    if (by_all) all.push_back(shared);
  }
  return all;
}

Saving mean_saving(const Plan& plan) {
  const auto mean = [&](double Saving::*member) {
    double sum = 0;
    for (const MaterialPlan& material : plan.materials) sum += material.saving.*member;
    return sum / static_cast<double>(plan.materials.size());
  };
  return {mean(&Saving::evaluation), mean(&Saving::cells), mean(&Saving::total)};
}

}  // namespace clothbrdf
