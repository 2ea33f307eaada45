#include "model/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

namespace clothbrdf {

namespace {

using Problem = std::optional<MaterialProblem>;

std::string range_text(double lowest, double highest) {
  if (highest == kNoLimit) return "a finite number";
  return "a number from " + number_text(lowest) + " to " + number_text(highest);
}

const ParameterInfo& parameter(std::string_view pointer) {
  for (const ParameterInfo& info : kParameters) {
    if (info.pointer == pointer) return info;
  }
  throw std::logic_error("no parameter " + std::string(pointer));
}

// NaN fails the comparison, infinities lie outside every range.
Problem outside(const ParameterInfo& info, std::string pointer, double value) {
  if (value >= info.lowest && value <= info.highest) return {};
  return MaterialProblem{std::move(pointer), number_text(value),
                         range_text(info.lowest, info.highest)};
}

Problem find_yarn_problem(const Yarn& yarn, const std::string& place) {
  const auto check = [&](const std::string& field, double value) {
    return outside(parameter("/warp" + field), place + field, value);
  };
  for (const std::size_t i : {0U, 1U}) {
    if (Problem p = check("/lobe_axes/" + std::to_string(i), yarn.lobe_axes[i])) return p;
  }
  if (yarn.absorption.empty() || yarn.absorption.size() > kMaxChannels) {
    return MaterialProblem{place + "/absorption",
                           "an array of " + std::to_string(yarn.absorption.size()) + " values",
                           "1 to " + std::to_string(kMaxChannels) + " values"};
  }
  const ParameterInfo& absorption = parameter("/warp/absorption/0");
  for (std::size_t c = 0; c < yarn.absorption.size(); ++c) {
    if (Problem p =
            outside(absorption, place + "/absorption/" + std::to_string(c), yarn.absorption[c]))
      return p;
  }
  if (Problem p = check("/layers", yarn.layers)) {
    p->allowed.replace(0, std::string_view("a number").size(), "an integer");
    return p;
  }
  if (Problem p = check("/refractive_index", yarn.refractive_index)) return p;
  if (Problem p = check("/scatter", yarn.scatter)) return p;
  if (yarn.scatter_limit) {
    const double wider = std::max(yarn.lobe_axes[0], yarn.lobe_axes[1]);
    if (Problem p = check("/scatter_limit", *yarn.scatter_limit)) return p;
    if (*yarn.scatter_limit < wider) {
      return MaterialProblem{place + "/scatter_limit", number_text(*yarn.scatter_limit),
                             range_text(wider, 1) + " (not below the wider of lobe_axes)"};
    }
  }
  return {};
}

Problem find_channel_problem(const Material& material) {
  const std::size_t channels = material.channel_count();
  const std::string as_many = std::to_string(channels) + " values, as many as in /warp/absorption";
  if (material.weft.absorption.size() != channels) {
    return MaterialProblem{
        "/weft/absorption",
        "an array of " + std::to_string(material.weft.absorption.size()) + " values", as_many};
  }
  const std::vector<double>& wavelengths = material.wavelengths_nm;
  if (wavelengths.empty()) {
    if (channels == 3) return {};
    return MaterialProblem{
        "/warp/absorption", "an array of " + std::to_string(channels) + " values",
        "3 values (linear R, G, B), or as many as in /wavelengths_nm, which is missing"};
  }
  if (wavelengths.size() != channels) {
    return MaterialProblem{"/wavelengths_nm",
                           "an array of " + std::to_string(wavelengths.size()) + " values",
                           as_many};
  }
  double previous = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    if (!(wavelengths[c] > previous && std::isfinite(wavelengths[c]))) {
      return MaterialProblem{
          "/wavelengths_nm/" + std::to_string(c), number_text(wavelengths[c]),
          "a finite number above " + number_text(previous) + " (strictly ascending)"};
    }
    previous = wavelengths[c];
  }
  return {};
}

}  // namespace

std::string number_text(double value) {
  char buffer[32];
  const bool plain = std::trunc(value) == value && std::abs(value) < 1e15;
  const std::to_chars_result end =
      plain ? std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed)
            : std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, end.ptr};
}

std::optional<MaterialProblem> find_problem(const Material& material) {
  struct Field {
    const char* pointer;
    double value;
  };
  for (const Field& field :
       std::initializer_list<Field>{{"/weights/specular", material.weights.specular},
                                    {"/weights/internal", material.weights.internal},
                                    {"/weights/diffuse", material.weights.diffuse},
                                    {"/diffuse_path", material.diffuse_path},
                                    {"/warp_fraction", material.warp_fraction},
                                    {"/rotation_deg", material.rotation_deg}}) {
    if (Problem p = outside(parameter(field.pointer), field.pointer, field.value)) return p;
  }
  if (Problem p = find_yarn_problem(material.warp, "/warp")) return p;
  if (Problem p = find_yarn_problem(material.weft, "/weft")) return p;
  return find_channel_problem(material);
}

void check_material(const Material& material) {
  if (const Problem problem = find_problem(material)) {
    throw std::invalid_argument(problem->pointer + ": " + problem->value +
                                " is not allowed: " + problem->allowed);
  }
}

}  // namespace clothbrdf
