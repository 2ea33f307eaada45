#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "table/reach.h"

namespace clothbrdf {

// How scenes, plans and tables write directions, in degrees.

/// {"lights": [{"theta_deg": [0, 30], "phi_deg": [0, 360]}], "eyes": [...], "rotations_deg": [0]}
nlohmann::ordered_json reach_to_json(const Reach& reach);

/// The same from JSON that follows its schema; `where` stands for it in errors: "plan.json:
/// /reach". Throws InputError for an empty range and for more than kMostCombinations.
Reach parse_reach(const nlohmann::json& json, const std::string& where);

/// A range of directions: an angle by itself stands for the range from it to itself, "phi_deg" left
/// out for all around. Throws InputError, in one line that starts with `where`, where a range ends
/// below its start, or an azimuth's more than 360 above it.
DirectionRange parse_direction_range(const nlohmann::json& json, const std::string& where);

}  // namespace clothbrdf
