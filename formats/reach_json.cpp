#include "formats/reach_json.h"

#include <vector>

#include "formats/json_text.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kWholeTurn = 360;

Json range_json(const AngleRange& range) { return {range.low, range.high}; }

Json ranges_json(const std::vector<DirectionRange>& ranges) {
  Json array = Json::array();
  for (const DirectionRange& range : ranges) {
    array.push_back(
        {{"theta_deg", range_json(range.theta_deg)}, {"phi_deg", range_json(range.phi_deg)}});
  }
  return array;
}

AngleRange parse_range(const nlohmann::json& json) {
  if (json.is_number()) return {json.get<double>(), json.get<double>()};
  return {json[0].get<double>(), json[1].get<double>()};
}

std::vector<DirectionRange> parse_ranges(const nlohmann::json& json, const std::string& where) {
  std::vector<DirectionRange> ranges;
  for (const nlohmann::json& range : json) {
    ranges.push_back(parse_direction_range(range, where + "/" + std::to_string(ranges.size())));
  }
  return ranges;
}

[[noreturn]] void fail(const std::string& where, const nlohmann::json& value,
                       const std::string& allowed) {
  throw InputError(where + ": " + one_line(value.dump()) + " is not allowed: " + allowed);
}

}  // namespace

nlohmann::ordered_json reach_to_json(const Reach& reach) {
  return {{"lights", ranges_json(reach.lights)},
          {"eyes", ranges_json(reach.eyes)},
          {"rotations_deg", reach.rotations_deg}};
}

Reach parse_reach(const nlohmann::json& json, const std::string& where) {
  Reach reach{parse_ranges(json.at("lights"), where + "/lights"),
              parse_ranges(json.at("eyes"), where + "/eyes"),
              json.at("rotations_deg").get<std::vector<double>>()};
  if (reach.combinations() > kMostCombinations) {
    throw InputError(where + ": " + std::to_string(reach.combinations()) +
                     " combinations of a light, an eye and a rotation are not allowed: at most " +
                     std::to_string(kMostCombinations));
  }
  return reach;
}

DirectionRange parse_direction_range(const nlohmann::json& json, const std::string& where) {
  DirectionRange range{parse_range(json.at("theta_deg")), {0, kWholeTurn}};
  if (range.theta_deg.low > range.theta_deg.high) {
    fail(where + "/theta_deg", json["theta_deg"], "the lowest angle, then the highest");
  }
  const auto phi = json.find("phi_deg");
  if (phi == json.end()) return range;
  range.phi_deg = parse_range(*phi);
  if (!(range.phi_deg.low <= range.phi_deg.high &&
        range.phi_deg.high <= range.phi_deg.low + kWholeTurn)) {
    fail(where + "/phi_deg", *phi, "the lowest angle, then the highest, at most 360 above it");
  }
  return range;
}

}  // namespace clothbrdf
