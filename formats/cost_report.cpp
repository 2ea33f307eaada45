#include "formats/cost_report.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "formats/json_text.h"
#include "formats/material_json.h"
#include "model/parameters.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

void put_count(Json& object, const char* key, const std::optional<std::uint64_t>& value) {
  if (value) object[key] = *value;
}

void put_timing(Json& object, const char* key, const std::optional<Timing>& timing) {
  if (!timing) return;
  Json json = Json::object();
  put(json, "median", timing->median);
  put(json, "lowest", timing->lowest);
  put(json, "highest", timing->highest);
  object[key] = json;
}

Json setting_json(const CostSetting& setting) {
  Json json = {{"front", setting.front}, {"dial", setting.dial}, {"name", setting.name}};
  put_words(json, "format", setting.format);
  put_words(json, "grid", setting.grid);
  put_words(json, "cells", setting.cells);
  put_words(json, "stored", setting.stored);
  put_words(json, "reader", setting.reader);
  if (setting.size != 0) put(json, "size", setting.size);
  Json error = Json::object();
  put(error, "rms", setting.error.rms);
  put(error, "p99", setting.error.p99);
  put(error, "max", setting.error.max);
  json["error"] = error;
  put(json, "isotropy_loss", setting.isotropy_loss);
  put_timing(json, "seconds", setting.seconds);
  put_timing(json, "one_thread_seconds", setting.one_thread);
  put_timing(json, "all_threads_seconds", setting.all_threads);
  put_timing(json, "write_seconds", setting.writing);
  put_count(json, "bytes", setting.bytes);
  put_count(json, "peak_memory_bytes", setting.peak_memory);
  json["pareto"] = setting.pareto;
  return json;
}

Json convergence_json(const Convergence& convergence) {
  Json json = {{"dial", convergence.dial}, {"law", convergence.law}};
  put(json, "expected", convergence.expected);
  put(json, "fitted", convergence.fitted);
  json["differs"] = convergence.differs;
  put_words(json, "reason", convergence.reason);
  return json;
}

class CsvLine {
 public:
  void add(std::string_view text) {
    if (!line_.empty()) line_ += ',';
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
      line_ += text;
      return;
    }
    line_ += '"';
    for (const char c : text) line_.append(c == '"' ? 2 : 1, c);
    line_ += '"';
  }
  void add(const std::optional<double>& value) {
    std::array<char, 32> digits{};
    const char* end = digits.data();
    if (value && std::isfinite(*value)) {
      end = std::to_chars(digits.data(), digits.data() + digits.size(), *value).ptr;
    }
    add(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
  }
  void add(const std::optional<std::uint64_t>& value) {
    add(std::string_view(value ? std::to_string(*value) : ""));
  }
  void add(const std::optional<Timing>& timing) {
    add(timing ? std::optional(timing->median) : std::nullopt);
    add(timing ? std::optional(timing->lowest) : std::nullopt);
    add(timing ? std::optional(timing->highest) : std::nullopt);
  }
  std::string take() { return line_ + '\n'; }

 private:
  std::string line_;  // not empty after the first field, which is always the name of a front
};

std::string csv_line(const CostSetting& setting) {
  CsvLine line;
  for (const std::string* text :
       {&setting.front, &setting.dial, &setting.name, &setting.format, &setting.grid,
        &setting.cells, &setting.stored, &setting.reader}) {
    line.add(*text);
  }
  line.add(setting.size != 0 ? std::optional(setting.size) : std::nullopt);
  line.add(std::optional(setting.error.rms));
  line.add(std::optional(setting.error.p99));
  line.add(std::optional(setting.error.max));
  line.add(setting.isotropy_loss);
  line.add(std::optional(setting.seconds));
  line.add(setting.one_thread);
  line.add(setting.all_threads);
  line.add(setting.writing);
  line.add(setting.bytes);
  line.add(setting.peak_memory);
  line.add(setting.pareto ? "true" : "false");
  return line.take();
}

constexpr std::string_view kColumnNames =
    "front,dial,name,format,grid,cells,stored,reader,size,rms,p99,max,isotropy_loss,seconds,"
    "seconds_lowest,seconds_highest,one_thread_seconds,one_thread_seconds_lowest,"
    "one_thread_seconds_highest,all_threads_seconds,all_threads_seconds_lowest,"
    "all_threads_seconds_highest,write_seconds,write_seconds_lowest,write_seconds_highest,bytes,"
    "peak_memory_bytes,pareto\n";

}  // namespace

std::string cost_report_json(const CostReport& report) {
  Json json = {{"$schema", "../data-schemas/cost_report.schema.json"}, {"program", report.program}};
  if (!find_problem(report.material)) {
    json["material"] = Json::parse(material_to_json(report.material));
  }
  json.update({{"threads", report.threads},
               {"repeats", report.repeats},
               {"pairs", report.pairs},
               {"seed", report.seed}});
  json["settings"] = Json::array();
  for (const CostSetting& setting : report.settings) {
    json["settings"].push_back(setting_json(setting));
  }
  json["convergence"] = Json::array();
  for (const Convergence& convergence : report.convergence) {
    json["convergence"].push_back(convergence_json(convergence));
  }
  json["sentences"] = report.sentences;
  return laid_out(json);
}

std::string cost_report_csv(const CostReport& report) {
  std::string text(kColumnNames);
  for (const CostSetting& setting : report.settings) text += csv_line(setting);
  return text;
}

}  // namespace clothbrdf
