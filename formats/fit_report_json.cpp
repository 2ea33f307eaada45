#include "formats/fit_report_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "formats/fit_names.h"
#include "formats/json_text.h"
#include "formats/material_json.h"
#include "model/parameters.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

// A report of a failure has a material without absorption values.
void put_material(Json& object, const Material& material) {
  if (!find_problem(material)) object["material"] = Json::parse(material_to_json(material));
}

// A condition of 0 stands for an infinite one.
void put_condition(Json& object, double condition) {
  if (condition > 0) put(object, "condition", condition);
}

const char* cells_text(bool averages) { return averages ? "average" : "point"; }

template <class T, class ToJson>
Json array_of(const std::vector<T>& values, const ToJson& to_json) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(to_json(value));
  return array;
}

Json parameter_json(const ParameterEstimate& estimate) {
  Json json = {{"name", estimate.name}, {"unit", estimate.unit}};
  put(json, "value", estimate.value);
  put(json, "standard_error", estimate.standard_error);
  put(json, "start", estimate.start);
  put(json, "lowest", estimate.lowest);
  put(json, "highest", estimate.highest);
  json["verdict"] = verdict_text(estimate.verdict);
  put_words(json, "reason", estimate.reason);
  return json;
}

Json verified_json(const VerifiedParameter& parameter) {
  Json json = {{"name", parameter.name}, {"unit", parameter.unit}};
  put(json, "value", parameter.value);
  put(json, "predicted", parameter.predicted);
  put(json, "observed", parameter.observed);
  put(json, "bias", parameter.bias);
  json["verdict"] = verdict_text(parameter.verdict);
  put_words(json, "reason", parameter.reason);
  put_words(json, "remedy", parameter.remedy);
  return json;
}

Json blind_json(const BlindDirection& blind) {
  Json json = {{"words", blind.words}};
  put(json, "singular_value", blind.singular_value);
  json["parts"] = array_of(blind.parts, [](const BlindDirection::Part& part) {
    Json one = {{"name", part.name}};
    put(one, "change", part.change);
    return one;
  });
  return json;
}

Json layers_json(const LayerProfile& layers) {
  return {{"fewest", layers.fewest},
          {"most", layers.most},
          {"warp", layers.warp},
          {"weft", layers.weft},
          {"profile", array_of(layers.fits, [](const LayerFit& fit) {
             Json one = {{"warp", fit.warp}, {"weft", fit.weft}};
             put(one, "chi2", fit.chi2);
             one["told"] = fit.told;
             one["equivalent"] = fit.equivalent;
             return one;
           })}};
}

Json equivalent_json(const Equivalent& equivalent) {
  Json json = {{"words", equivalent.words}};
  put_material(json, equivalent.material);
  return json;
}

Json convention_json(const ConventionFit& fit) {
  Json json = {{"reflectance", choice_name(kReflectanceNames, fit.reflectance)},
               {"paths", choice_name(kPathsNames, fit.paths)}};
  put(json, "chi2", fit.chi2);
  json["chosen"] = fit.chosen;
  json["told"] = fit.told;
  return json;
}

Json residual_json(const RegionResidual& residual) {
  Json json = {
      {"component", residual.component}, {"region", residual.region}, {"values", residual.values}};
  put(json, "rms", residual.rms);
  put(json, "mean", residual.mean);
  return json;
}

Json optimum_json(const Optimum& optimum) {
  Json json = Json::object();
  put(json, "chi2", optimum.chi2);
  json.update({{"starts", optimum.starts},
               {"warp_layers", optimum.warp_layers},
               {"weft_layers", optimum.weft_layers}});
  return json;
}

Json profile_json(const Profile& profile) {
  return {{"name", profile.name}, {"points", array_of(profile.points, [](const ProfilePoint& p) {
                                     Json point = Json::object();
                                     put(point, "value", p.value);
                                     put(point, "chi2", p.chi2);
                                     point["at_bound"] = p.at_bound;
                                     return point;
                                   })}};
}

}  // namespace

std::string fit_report_to_json(const FitReport& report) {
  Json json = {{"$schema", "../data-schemas/fit_report.schema.json"},
               {"table", report.table},
               {"grid", report.grid},
               {"cells", cells_text(report.cell_averages)},
               {"values", report.values},
               {"masked", report.masked},
               {"below_horizon", report.below_horizon},
               {"converged", report.converged},
               {"termination", report.termination},
               {"message", report.message},
               {"iterations", report.iterations}};
  put_words(json, "failure", report.failure);
  put_material(json, report.material);
  json["one_yarn"] = report.one_yarn;
  json["parameters"] = array_of(report.parameters, parameter_json);
  json["blind"] = array_of(report.blind, blind_json);
  put_condition(json, report.condition);
  json["layers"] = layers_json(report.layers);
  json["equivalents"] = array_of(report.equivalents, equivalent_json);
  json["conventions"] = array_of(report.conventions, convention_json);
  json.update({{"weighting", report.weighting}, {"loss", report.loss}});
  put(json, "noise", report.noise);
  json["noise_estimated"] = report.noise_estimated;
  put(json, "chi2", report.chi2);
  put(json, "residual_rms", report.residual_rms);
  json["residuals"] = array_of(report.residuals, residual_json);
  json.update({{"starts", report.starts}, {"starts_at_best", report.starts_at_best}});
  json["optima"] = array_of(report.optima, optimum_json);
  json["notes"] = report.notes;
  json["rows"] = report.rows;
  put(json, "seconds", report.seconds);
  return laid_out(json);
}

std::string identify_report_to_json(const IdentifyReport& report) {
  Json json = {{"$schema", "../data-schemas/identify_report.schema.json"}};
  put_material(json, report.material);
  json.update({{"grid", report.grid}, {"cells", cells_text(report.cell_averages)}});
  put(json, "noise", report.noise);
  json["values"] = report.values;
  json["parameters"] = array_of(report.parameters, verified_json);
  json["singular_values"] = Json::array();
  for (const double value : report.singular_values) {
    if (std::isfinite(value)) json["singular_values"].push_back(value);
  }
  put_condition(json, report.condition);
  json["blind"] = array_of(report.blind, blind_json);
  json["equivalents"] = array_of(report.equivalents, equivalent_json);
  json["layers"] = layers_json(report.layers);
  json.update({{"refits", report.refits}, {"refits_converged", report.refits_converged}});
  json["profiles"] = array_of(report.profiles, profile_json);
  json["tried"] = report.tried;
  put(json, "seconds", report.seconds);
  return laid_out(json);
}

}  // namespace clothbrdf
