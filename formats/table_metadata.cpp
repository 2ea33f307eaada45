#include "formats/table_metadata.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "formats/json_text.h"
#include "formats/material_json.h"
#include "formats/reach_json.h"
#include "formats/schema_check.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCloth = "cloth";
constexpr const char* kMean = "mean over rotations";
constexpr const char* kValue = "f_r, 1/sr, without the cosine";

template <class T>
struct Name {
  T value;
  const char* name;
};
constexpr Name<Spacing> kSpacings[] = {{Spacing::kUniform, "uniform"},
                                       {Spacing::kSquared, "squared"},
                                       {Spacing::kNodes, "nodes"},
                                       {Spacing::kListed, "listed"}};
constexpr Name<GridKind> kKinds[] = {{GridKind::kHalfDifference3d, "halfdiff3d"},
                                     {GridKind::kHalfDifference4d, "halfdiff4d"},
                                     {GridKind::kInOut, "inout"}};
constexpr Name<Part> kParts[] = {{Part::kTotal, "total"},
                                 {Part::kSpecular, "specular"},
                                 {Part::kInternal, "internal"},
                                 {Part::kDiffuse, "diffuse"}};

template <class T, std::size_t N>
const char* name_of(const Name<T> (&names)[N], T value) {
  return std::find_if(std::begin(names), std::end(names),
                      [&](const Name<T>& n) { return n.value == value; })
      ->name;
}

// The schema has refused all other names.
template <class T, std::size_t N>
T value_of(const Name<T> (&names)[N], const std::string& name) {
  return std::find_if(std::begin(names), std::end(names),
                      [&](const Name<T>& n) { return n.name == name; })
      ->value;
}

const char* convention_of(const Material& material) {
  return material.reflectance == Reflectance::kMicrofacet ? "microfacet" : "paper";
}

Json axis_json(const Axis& axis) {
  Json json = {{"name", axis.name},
               {"unit", "deg"},
               {"spacing", name_of(kSpacings, axis.spacing)},
               {"size", axis.size},
               {"from", axis.lowest_deg},
               {"to", axis.highest_deg},
               {"periodic", axis.periodic}};
  if (axis.mirrored) json["mirrored"] = true;
  if (axis.spacing == Spacing::kListed) json["nodes"] = axis.listed_deg;
  return json;
}

Axis parse_axis(const nlohmann::json& json) {
  return {json["name"].get<std::string>(), value_of(kSpacings, json["spacing"].get<std::string>()),
          json["size"].get<int>(),         json["from"].get<double>(),
          json["to"].get<double>(),        json["periodic"].get<bool>(),
          json.value("mirrored", false),   json.value("nodes", std::vector<double>{})};
}

bool ascend_within(const Axis& axis) {
  const std::vector<double>& nodes = axis.listed_deg;
  return nodes.size() == static_cast<std::size_t>(axis.size) &&
         std::adjacent_find(nodes.begin(), nodes.end(), std::greater_equal<>()) == nodes.end() &&
         nodes.front() >= axis.lowest_deg && nodes.back() <= axis.highest_deg;
}

// An axis of listed nodes: theta from 0 to 90 as it is, phi mirrored after 90 or 180 degrees, where
// phi_h may begin at the weave's rotation.
bool known_listed(const Axis& axis) {
  const double range = axis.highest_deg - axis.lowest_deg;
  if (axis.periodic || !ascend_within(axis)) return false;
  if (axis.name.starts_with("theta")) {
    return !axis.mirrored && axis.lowest_deg == 0 && axis.highest_deg == 90;
  }
  // Ends that are sums of a rotation are rounded.
  constexpr double kRounding = 1e-9;
  const auto is = [&](double wanted) { return std::abs(range - wanted) <= kRounding; };
  return axis.mirrored &&
         (axis.name == "phi_h" ? is(90) : axis.lowest_deg == 0 && (range == 90 || range == 180));
}

// A grid must be one that this program can make, whatever its sizes.
Grid parse_grid_json(const nlohmann::json& json, const std::string& name) {
  Grid grid{value_of(kKinds, json["kind"].get<std::string>()), {}};
  double cells = 1;
  for (const nlohmann::json& axis : json["axes"]) {
    grid.axes.push_back(parse_axis(axis));
    cells *= grid.axes.back().size;
  }
  if (cells <= kMaxCells &&
      grid.axes.size() == (grid.kind == GridKind::kHalfDifference3d ? 3U : 4U)) {
    constexpr double kWholeTurn = 360;
    const double period = grid.axes.back().period_deg();
    Grid known = parse_grid(grid.sizes(), period);
    // A measured cloth need not look the same turned by half a turn.
    if (grid.kind == GridKind::kHalfDifference4d && grid.axes[1].highest_deg == kWholeTurn) {
      known.axes[1].highest_deg = kWholeTurn;
    }
    for (std::size_t a = 0; a < grid.axes.size() && grid.kind != GridKind::kInOut; ++a) {
      const Axis& axis = grid.axes[a];
      if (axis.name == known.axes[a].name && known_listed(axis)) known.axes[a] = axis;
    }
    if (grid == known && (period == kWholeTurn || period == kWholeTurn / 2)) return grid;
  }
  throw InputError(name + ": /grid/axes: not the axes of a " + json["kind"].get<std::string>() +
                   " grid");
}

}  // namespace

std::string table_metadata(const TableSpec& spec) {
  const Provenance& from = spec.provenance;
  Json json = {{"version", 1}, {"program", from.program}, {"value", kValue}};
  if (from.material) {
    json["convention"] = convention_of(*from.material);
  }
  if (spec.has_grid()) {
    json["grid"] = {{"kind", name_of(kKinds, spec.grid().kind)}, {"axes", Json::array()}};
    for (const Axis& axis : spec.grid().axes) json["grid"]["axes"].push_back(axis_json(axis));
  } else {
    json["isotropic"] = spec.isotropic();
  }
  json["channels"] = Json::array();
  for (const Channel& c : spec.channels) {
    Json channel = {{"name", c.name}, {"part", name_of(kParts, c.part)}};
    if (c.colour != kNoColour) channel["colour"] = c.colour;
    json["channels"].push_back(channel);
  }
  json["cells"] = {{"rule", spec.cells.average ? "average" : "point"}};
  if (spec.cells.average) json["cells"]["tolerance"] = spec.cells.tolerance;
  json["effects"] = effect_words(from.effects);
  if (spec.reach) json["reach"] = reach_to_json(*spec.reach);
  if (from.error) {
    const MeasuredError& e = *from.error;
    json["error"] = {{"rms", e.error.rms}, {"p99", e.error.p99},
                     {"max", e.error.max}, {"reader", e.reader},
                     {"pairs", e.pairs},   {"against", e.of_mean ? kMean : kCloth}};
  }
  if (from.material) json["material"] = Json::parse(material_to_json(*from.material));
  return json.dump();
}

TableSpec parse_table_metadata(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  check_against_schema(json, "table.schema.json", name);
  TableSpec spec;
  if (json.contains("grid") == json.contains("isotropic")) {
    throw InputError(name + ": /grid, or /isotropic in its place, is needed");
  }
  if (json.contains("grid")) {
    spec.samples = parse_grid_json(json["grid"], name);
  } else {
    spec.samples = AnyPairs{json["isotropic"].get<bool>()};
  }
  for (const nlohmann::json& c : json["channels"]) {
    spec.channels.push_back({c["name"].get<std::string>(),
                             value_of(kParts, c["part"].get<std::string>()),
                             c.value("colour", kNoColour)});
  }
  spec.cells.average = json["cells"]["rule"] == "average";
  spec.cells.tolerance = json["cells"].value("tolerance", spec.cells.tolerance);
  std::string problem;
  const std::optional<Effects> effects =
      effects_from_words(json["effects"].get<std::vector<std::string>>(), problem);
  if (!effects) throw InputError(name + ": /effects: " + problem);
  spec.provenance.effects = *effects;
  spec.provenance.program = json["program"].get<std::string>();
  if (json.contains("reach")) {
    if (!spec.has_grid()) throw InputError(name + ": /reach: is for the cells of a grid");
    spec.reach = parse_reach(json["reach"], name + ": /reach");
  }
  if (json.contains("material"))
    spec.provenance.material = parse_material(json["material"].dump(), name + ": /material");
  if (json.contains("error")) {
    const nlohmann::json& e = json["error"];
    spec.provenance.error = {
        {e["rms"].get<double>(), e["p99"].get<double>(), e["max"].get<double>()},
        e["reader"].get<std::string>(),
        e["pairs"].get<std::size_t>(),
        e["against"] == kMean};
  }
  if (json.contains("convention")) {
    const auto& material = spec.provenance.material;
    if (!material || json["convention"] != convention_of(*material)) {
      throw InputError(name + ": /convention: contradicts the material");
    }
  }
  return spec;
}

}  // namespace clothbrdf
