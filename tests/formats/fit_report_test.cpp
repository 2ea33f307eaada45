#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/fit_report_json.h"
#include "formats/json_text.h"
#include "formats/schema_check.h"
#include "formats/schemas.h"
#include "model/parameters.h"
#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/fit_reports.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

constexpr const char* kFitSchema = "fit_report.schema.json";
constexpr const char* kIdentifySchema = "identify_report.schema.json";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The report, read as strictly as our inputs are; it follows its schema.
json checked(const std::string& text, const char* schema) {
  CAPTURE(text);
  json report = parse_json(text, "report.json");
  CHECK_NOTHROW(check_against_schema(report, schema, "report.json"));
  CHECK(text.starts_with("{\n  \"$schema\": \"../data-schemas/" + std::string(schema) + "\""));
  CHECK(text.find("null") == std::string::npos);
  return report;
}

json checked(const FitReport& report) { return checked(fit_report_to_json(report), kFitSchema); }

json checked(const IdentifyReport& report) {
  return checked(identify_report_to_json(report), kIdentifySchema);
}

// Control characters, quotes, and bytes that are no UTF-8.
const std::string kOdd = "a\"b\\c\n\x01\x7F \xFF\xFE \xE7\x8E\x89";

// Calls `visit` for every schema of a value in `schema`.
template <class Visit>
void visit_schemas(const json& schema, const std::string& pointer, const Visit& visit) {
  visit(schema, pointer);
  for (const char* key : {"properties", "definitions"}) {
    const json children = schema.value(key, json::object());
    for (const auto& [name, child] : children.items()) {
      visit_schemas(child, std::string(pointer).append("/").append(key).append("/").append(name),
                    visit);
    }
  }
  for (const char* key : {"items", "additionalProperties"}) {
    if (schema.contains(key) && schema[key].is_object()) {
      visit_schemas(schema[key], pointer + "/" + key, visit);
    }
  }
}

}  // namespace

TEST_CASE("a fit report with all there is follows its schema") {
  const FitReport report = full_fit_report();
  const json read = checked(report);
  const json schema = json::parse(schema_text(kFitSchema));
  for (const auto& [key, ignored] : schema.at("properties").items()) {
    CAPTURE(key);
    CHECK((read.contains(key) || key == "failure"));
  }
  CHECK(read["cells"] == "average");
  CHECK(read["parameters"][0]["standard_error"] == 0.001);
  CHECK_FALSE(read["parameters"][0].contains("reason"));
  CHECK_FALSE(read["parameters"][1].contains("standard_error"));
  CHECK(read["parameters"][1]["verdict"] == "not identifiable");
  CHECK(read["layers"]["profile"].size() == 4);
  CHECK(read["conventions"][1]["reflectance"] == "paper");
  CHECK(read["conventions"][1]["paths"] == "single");
  CHECK(parse_material(read["material"].dump(), "report") == report.material);
  CHECK(parse_material(read["equivalents"][0]["material"].dump(), "report") == report.material);
}

TEST_CASE("an identify report with all there is follows its schema") {
  const IdentifyReport report = full_identify_report();
  const json read = checked(report);
  const json schema = json::parse(schema_text(kIdentifySchema));
  for (const auto& [key, ignored] : schema.at("properties").items()) {
    CAPTURE(key);
    CHECK(read.contains(key));
  }
  CHECK(read["parameters"][0]["predicted"] == 0.001);
  CHECK(read["parameters"][1]["remedy"] == "halfdiff4d");
  CHECK(read["profiles"][0]["points"][1]["at_bound"] == json({"warp_fraction"}));
  CHECK(parse_material(read["material"].dump(), "report") == report.material);
}

TEST_CASE("reports of nothing follow their schemas, and leave out the material") {
  FitReport failed;
  failed.failure = "no value is positive";
  const json fit = checked(failed);
  CHECK(fit["failure"] == "no value is positive");
  CHECK_FALSE(fit.contains("material"));
  CHECK_FALSE(fit.contains("condition"));
  const json identify = checked(IdentifyReport{});
  CHECK_FALSE(identify.contains("material"));
  CHECK(identify["singular_values"] == json::array());
}

TEST_CASE("reports with odd names follow their schemas") {
  FitReport fit = full_fit_report();
  fit.table = fit.message = fit.termination = fit.failure = fit.grid = kOdd;
  fit.material.name = fit.material.description = kOdd;
  for (ParameterEstimate& p : fit.parameters) p.name = p.unit = p.reason = kOdd;
  fit.blind[0].words = fit.blind[0].parts[0].name = fit.equivalents[0].words = kOdd;
  fit.residuals[0].component = fit.residuals[0].region = kOdd;
  const std::string shown = checked(fit)["table"].get<std::string>();
  CHECK(shown == "a\"b\\c\n\x01\x7F \xEF\xBF\xBD\xEF\xBF\xBD \xE7\x8E\x89");

  IdentifyReport identify = full_identify_report();
  for (VerifiedParameter& p : identify.parameters) p.name = p.reason = p.remedy = kOdd;
  identify.profiles[0].name = identify.profiles[0].points[1].at_bound[0] = kOdd;
  checked(identify);
}

TEST_CASE("a number that is not finite is left out of a report") {
  FitReport fit = full_fit_report();
  fit.parameters[0].standard_error = kNan;
  fit.condition = std::numeric_limits<double>::infinity();
  fit.material.warp.scatter = kNan;
  const json read = checked(fit);
  CHECK_FALSE(read["parameters"][0].contains("standard_error"));
  CHECK_FALSE(read.contains("condition"));
  CHECK_FALSE(read.contains("material"));
  // Not what a report may hold; still no NaN in a file.
  fit.chi2 = fit.parameters[0].value = fit.optima[0].chi2 = kNan;
  const json broken = parse_json(fit_report_to_json(fit), "report.json");
  CHECK_FALSE(broken.contains("chi2"));
  CHECK_FALSE(broken["parameters"][0].contains("value"));

  IdentifyReport identify = full_identify_report();
  identify.singular_values.push_back(kNan);
  identify.parameters[0].observed = -std::numeric_limits<double>::infinity();
  identify.parameters[0].bias = kNan;
  CHECK(checked(identify)["singular_values"].size() == 2);
}

TEST_CASE("every verdict has its word in both schemas") {
  for (const char* file : {kFitSchema, kIdentifySchema}) {
    const json words = json::parse(schema_text(file))
                           .at("/properties/parameters/items/properties/verdict/enum"_json_pointer);
    json verdicts = json::array();
    for (const Verdict verdict : {Verdict::kIdentifiable, Verdict::kWeak, Verdict::kNotIdentifiable,
                                  Verdict::kAtBound, Verdict::kFixed, Verdict::kTied}) {
      verdicts.push_back(verdict_text(verdict));
    }
    CHECK(words == verdicts);
  }
}

TEST_CASE("every property of the schemas is described, every number with its unit") {
  for (const auto& [file, least_numbers] :
       {std::pair("fit.schema.json", 5), std::pair(kFitSchema, 5), std::pair(kIdentifySchema, 5),
        std::pair("scene.schema.json", 2), std::pair("plan.schema.json", 5)}) {
    int numbers = 0;
    visit_schemas(json::parse(schema_text(file)), file, [&](const json& schema, const auto& at) {
      CAPTURE(at);
      const bool of_all = at.ends_with("/items") || at.ends_with("/additionalProperties");
      if (at.find("/properties/") != std::string::npos && !of_all) {
        // What is referred to is described there.
        CHECK((schema.contains("description") || schema.contains("$ref")));
      }
      const std::string type = schema.value("type", "");
      if (type == "number" || type == "integer") {
        CHECK_THAT(schema.at("description").template get<std::string>(),
                   ContainsSubstring("[") && Catch::Matchers::EndsWith("]"));
        ++numbers;
      }
    });
    CHECK(numbers >= least_numbers);
  }
}

TEST_CASE("a text is laid out in lines of 100 columns, and holds what it was made of") {
  const std::string text = fit_report_to_json(full_fit_report());
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    // A long text cannot be broken.
    CHECK((line.size() <= 100 || line.find("\"description\"") != std::string::npos));
  }
  CHECK_THAT(text, ContainsSubstring("\n      {\"warp\": 3, \"weft\": 4, \"chi2\": 20.0, "
                                     "\"told\": true, "
                                     "\"equivalent\": false},\n"));
  CHECK_THAT(text, Catch::Matchers::EndsWith("\n}\n"));
  const nlohmann::ordered_json value = {
      {"b", {1, -0.5, true, nullptr}}, {"a", nlohmann::ordered_json::object()}, {"", "x\ty"}};
  CHECK(nlohmann::ordered_json::parse(laid_out(value)) == value);
}

}  // namespace clothbrdf::test
