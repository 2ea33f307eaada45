#include "formats/plan_json.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "formats/json_text.h"
#include "formats/material_json.h"
#include "formats/plan_summary.h"
#include "formats/reach_json.h"
#include "formats/schema_check.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

Json left_out_json(const std::vector<LeftOut>& left_out) {
  Json array = Json::array();
  for (const LeftOut& one : left_out) {
    array.push_back({{"effect", one.effect}, {"what", one.what}, {"bound", one.bound}});
  }
  return array;
}

Json saving_json(const Saving& saving) {
  return {{"evaluation", saving.evaluation}, {"cells", saving.cells}, {"total", saving.total}};
}

Json material_plan_json(const MaterialPlan& plan) {
  return {{"material", Json::parse(material_to_json(plan.material))},
          {"effects", effect_words(plan.effects)},
          {"kept", plan.kept},
          {"left_out", left_out_json(plan.left_out)},
          {"bound", plan.bound},
          {"brightest", plan.brightest},
          {"saving", saving_json(plan.saving)}};
}

std::vector<LeftOut> parse_left_out(const nlohmann::json& array) {
  std::vector<LeftOut> left_out;
  for (const nlohmann::json& one : array) {
    left_out.push_back({one["effect"].get<std::string>(), one["what"].get<std::string>(),
                        one["bound"].get<double>()});
  }
  return left_out;
}

MaterialPlan parse_material_plan(const nlohmann::json& json, const std::string& where) {
  std::string problem;
  const std::optional<Effects> effects =
      effects_from_words(json["effects"].get<std::vector<std::string>>(), problem);
  if (!effects) throw InputError(where + "/effects: " + problem);
  const nlohmann::json& saving = json["saving"];
  return {parse_material(json["material"].dump(), where + "/material"),
          *effects,
          json["kept"].get<std::vector<std::string>>(),
          parse_left_out(json["left_out"]),
          json["bound"].get<double>(),
          json["brightest"].get<double>(),
          {saving["evaluation"].get<double>(), saving["cells"].get<double>(),
           saving["total"].get<double>()}};
}

}  // namespace

std::string plan_to_json(const Plan& plan) {
  Json json = {{"$schema", "../data-schemas/plan.schema.json"},
               {"scene", plan.scene},
               {"tolerance", plan.tolerance},
               {"brightest", plan.brightest},
               {"brightest_at_most", plan.brightest_at_most},
               {"bound", plan.bound},
               {"kept", kept_by_any(plan)},
               {"left_out", left_out_json(left_out_by_all(plan))},
               {"saving", saving_json(mean_saving(plan))},
               {"materials", Json::array()}};
  for (const MaterialPlan& material : plan.materials) {
    json["materials"].push_back(material_plan_json(material));
  }
  json["reach"] = reach_to_json(plan.reach);
  return laid_out(json);
}

Plan read_plan(const std::filesystem::path& path) {
  return parse_plan(read_json_file(path), path.string());
}

Plan parse_plan(std::string_view text, const std::string& name) {
  const nlohmann::json json = parse_json(text, name);
  check_against_schema(json, "plan.schema.json", name);
  const std::string shown = one_line(name, kLongestFileName);
  Plan plan;
  plan.scene = json["scene"].get<std::string>();
  plan.tolerance = json["tolerance"].get<double>();
  plan.brightest = json["brightest"].get<double>();
  plan.brightest_at_most = json["brightest_at_most"].get<double>();
  plan.bound = json["bound"].get<double>();
  for (const nlohmann::json& material : json["materials"]) {
    plan.materials.push_back(parse_material_plan(
        material, shown + ": /materials/" + std::to_string(plan.materials.size())));
  }
  plan.reach = parse_reach(json["reach"], shown + ": /reach");
  return plan;
}

}  // namespace clothbrdf
