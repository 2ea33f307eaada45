#include "formats/cost_report.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/json_text.h"
#include "formats/schema_check.h"
#include "formats/schemas.h"
#include "tests/catch.h"
#include "tests/support/cost_reports.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

constexpr const char* kSchema = "cost_report.schema.json";

json checked(const CostReport& report) {
  const std::string text = cost_report_json(report);
  CAPTURE(text);
  json read = parse_json(text, "report.json");
  CHECK_NOTHROW(check_against_schema(read, kSchema, "report.json"));
  CHECK(text.find("null") == std::string::npos);
  return read;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("a cost report with all there is follows its schema, and its numbers come back") {
  const CostReport report = full_cost_report();
  const json read = checked(report);
  const json schema = json::parse(schema_text(kSchema));
  for (const auto& [key, ignored] : schema.at("properties").items()) {
    CAPTURE(key);
    CHECK(read.contains(key));
  }
  CHECK(parse_material(read["material"].dump(), "report") == report.material);
  CHECK(read["threads"] == 2);
  CHECK(read["repeats"] == 3);
  CHECK(read["pairs"] == 200000);
  CHECK(read["seed"] == 7);
  REQUIRE(read["settings"].size() == report.settings.size());
  const CostSetting& first = report.settings.front();
  const json& setting = read["settings"][0];
  for (const auto& [key, ignored] :
       schema.at("/properties/settings/items/properties"_json_pointer).items()) {
    CAPTURE(key);
    CHECK(setting.contains(key));
  }
  CHECK(setting["error"] ==
        json({{"rms", first.error.rms}, {"p99", first.error.p99}, {"max", first.error.max}}));
  const auto timing = [](const Timing& t) {
    return json({{"median", t.median}, {"lowest", t.lowest}, {"highest", t.highest}});
  };
  CHECK(setting["seconds"] == timing(first.seconds));
  CHECK(setting["one_thread_seconds"] == timing(*first.one_thread));
  CHECK(setting["all_threads_seconds"] == timing(*first.all_threads));
  CHECK(setting["write_seconds"] == timing(*first.writing));
  CHECK(setting["bytes"] == *first.bytes);
  CHECK(setting["peak_memory_bytes"] == *first.peak_memory);
  CHECK(setting["pareto"] == true);
  CHECK(read["settings"][1]["pareto"] == false);
  const json& evaluation = read["settings"].back();
  for (const char* key : {"format", "grid", "cells", "stored", "reader", "bytes",
                          "peak_memory_bytes", "isotropy_loss", "write_seconds"}) {
    CAPTURE(key);
    CHECK_FALSE(evaluation.contains(key));
  }
  CHECK(read["convergence"][1]["fitted"] == 0.5);
  CHECK(read["convergence"][1]["reason"] == "scatter widens");
  CHECK_FALSE(read["convergence"][0].contains("reason"));
}

TEST_CASE("a cost report leaves out what is not finite, and takes any name") {
  CostReport report = full_cost_report();
  report.settings[0].error.max = std::numeric_limits<double>::infinity();
  report.settings[0].name = report.settings[0].grid = "a\"b\n\xFF";
  report.sentences = {"\x01\xFE"};
  report.convergence[0].fitted = std::numeric_limits<double>::quiet_NaN();
  const json read = checked(report);
  CHECK_FALSE(read["settings"][0]["error"].contains("max"));
  CHECK_FALSE(read["convergence"][0].contains("fitted"));
  CHECK_FALSE(checked(CostReport{}).contains("material"));
}

TEST_CASE("a cost table has a line a setting, quoted where a comma or a quote asks for it") {
  CostReport report = full_cost_report();
  report.settings.resize(1);
  CostSetting& setting = report.settings[0];
  setting.dial = "plain";
  setting.name = "EXR half, \"linear\"";
  setting.error = {0.125, 0.25, std::numeric_limits<double>::infinity()};
  setting.seconds = {2, 1, 3};
  setting.one_thread = setting.all_threads = setting.writing = std::nullopt;
  setting.isotropy_loss = std::nullopt;
  const std::vector<std::string> lines = lines_of(cost_report_csv(report));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].starts_with("front,dial,name,format,"));
  CHECK(lines[1] ==
        "3-D,plain,\"EXR half, \"\"linear\"\"\",EXR,halfdiff4d:12x36x45x45,point,half,linear,12,"
        "0.125,0.25,,,2,1,3,,,,,,,,,,120000,500000,true");
  // The quoted name has one comma of its own.
  CHECK(std::count(lines[0].begin(), lines[0].end(), ',') + 1 ==
        std::count(lines[1].begin(), lines[1].end(), ','));
}

}  // namespace clothbrdf::test
