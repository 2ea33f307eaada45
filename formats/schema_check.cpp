#include "formats/schema_check.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

// Without this valijson aborts the program on a schema that it cannot read.
#define VALIJSON_USE_EXCEPTIONS 1
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "formats/json_text.h"
#include "formats/schemas.h"
#include "model/parameters.h"
#include "support/errors.h"

namespace clothbrdf {

namespace {

using nlohmann::json;
using valijson::adapters::NlohmannJsonAdapter;

class Validator {
 public:
  explicit Validator(const json& schema) {
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(NlohmannJsonAdapter(schema), schema_);
  }

  // Stops at the first violation. valijson's own list of all violations is not asked for: a hostile
  // file would make it hundreds of times as large as the file.
  bool accepts(const json& value) const {
    return valijson::Validator().validate(schema_, NlohmannJsonAdapter(value), nullptr);
  }

 private:
  valijson::Schema schema_;
};

// What is wrong, and where.
struct Violation {
  std::string pointer;
  std::string text;
};

std::string joined(const std::vector<std::string>& texts, const std::string& separator) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : separator) + text;
  return all;
}

std::string value_text(const json& value) {
  constexpr std::size_t kLongest = 60;
  if (value.is_array() && value.size() > kLongest / 2) {
    return "an array of " + std::to_string(value.size()) + " values";
  }
  return one_line(value.dump(-1, ' ', false, json::error_handler_t::replace), kLongest);
}

// Changes of one letter that lead from a to b.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = row[j + 1];
      row[j + 1] = std::min({above + 1, row[j] + 1, diagonal + (a[i] == b[j] ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

// A misspelling changes about a letter in three; more is another word.
std::string nearest(std::string_view key, const json& properties) {
  key = key.substr(0, 64);
  std::string best;
  std::size_t least = std::max<std::size_t>(key.size() / 3, 1) + 1;
  for (const auto& [known, schema] : properties.items()) {
    const std::size_t distance = edit_distance(key, known);
    if (distance < least) {
      least = distance;
      best = known;
    }
  }
  return best;
}

std::vector<std::string> type_names(const json& schema) {
  const auto type = schema.find("type");
  if (type == schema.end()) return {};
  if (type->is_string()) return {type->get<std::string>()};
  return type->get<std::vector<std::string>>();
}

bool has_type(const json& value, const std::string& type) {
  if (type == "integer") return value.is_number_integer();
  return type == value.type_name();
}

class Explainer {
 public:
  explicit Explainer(const json& root) : root_(root) {}

  // `value` violates `schema`.
  Violation explain(const json& schema_or_ref, const json& value,
                    const std::string& pointer) const {
    const json& schema = resolve(schema_or_ref);
    for (const char* keyword : {"anyOf", "oneOf"}) {
      const auto choices = schema.find(keyword);
      if (choices == schema.end()) continue;
      for (const json& choice : *choices) {
        if (fits_type(choice, value)) return explain(choice, value, pointer);
      }
    }
    if (const auto all = schema.find("allOf"); all != schema.end()) {
      for (const json& part : *all) {
        if (!Validator(self_contained(part)).accepts(value)) return explain(part, value, pointer);
      }
    }
    if (fits_type(schema, value)) {
      if (value.is_object()) {
        if (std::optional<Violation> found = explain_object(schema, value, pointer)) return *found;
      } else if (value.is_array()) {
        if (std::optional<Violation> found = explain_array(schema, value, pointer)) return *found;
      }
    }
    return {pointer, value_text(value) + " is not allowed: " + describe(schema)};
  }

 private:
  const json& resolve(const json& schema) const {
    const json* node = &schema;
    for (auto ref = node->find("$ref"); ref != node->end(); ref = node->find("$ref")) {
      node =
          &root_.at(json::json_pointer(ref->get<std::string>().substr(1)));  // "#/definitions/..."
    }
    return *node;
  }

  bool fits_type(const json& schema_or_ref, const json& value) const {
    const std::vector<std::string> types = type_names(resolve(schema_or_ref));
    return types.empty() || std::any_of(types.begin(), types.end(), [&](const std::string& type) {
             return has_type(value, type);
           });
  }

  // Of a part of the schema, together with the definitions that it may refer to.
  json self_contained(const json& part) const {
    json schema = resolve(part);
    if (const auto definitions = root_.find("definitions"); definitions != root_.end()) {
      schema["definitions"] = *definitions;
    }
    return schema;
  }

  std::optional<Violation> explain_object(const json& schema, const json& value,
                                          const std::string& pointer) const {
    const json properties = schema.value("properties", json::object());
    const json others = schema.value("additionalProperties", json(true));
    // A misspelt key is unknown and missing at once: the first says more.
    if (others == false) {
      for (const auto& [key, child] : value.items()) {
        if (!properties.contains(key)) return unknown_key(properties, key, pointer);
      }
    }
    for (const json& key : schema.value("required", json::array())) {
      const auto& name = key.get_ref<const std::string&>();
      if (value.contains(name)) continue;
      const std::string needed =
          properties.contains(name) ? describe(properties.at(name)) : "a value";
      return Violation{pointer + pointer_step(name), "missing, needed is " + needed};
    }
    for (const auto& [key, child] : value.items()) {
      const auto known = properties.find(key);
      const json& part = known != properties.end() ? *known : others;
      if (part.is_object() && !Validator(self_contained(part)).accepts(child)) {
        return explain(part, child, pointer + pointer_step(key));
      }
    }
    return {};
  }

  static Violation unknown_key(const json& properties, const std::string& key,
                               const std::string& pointer) {
    std::vector<std::string> known;
    for (const auto& [name, schema] : properties.items()) known.push_back(name);
    const std::string near = nearest(key, properties);
    return {pointer + pointer_step(key),
            "unknown key" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)") +
                ", allowed are " + joined(known, ", ")};
  }

  std::optional<Violation> explain_array(const json& schema, const json& value,
                                         const std::string& pointer) const {
    const auto items = schema.find("items");
    if (items == schema.end()) return {};
    const bool tuple = items->is_array();
    const std::size_t count = tuple ? std::min(items->size(), value.size()) : value.size();
    std::unique_ptr<Validator> common;
    for (std::size_t i = 0; i < count; ++i) {
      const json& part = tuple ? (*items)[i] : *items;
      if (tuple || !common) common = std::make_unique<Validator>(self_contained(part));
      if (!common->accepts(value[i]))
        return explain(part, value[i], pointer + "/" + std::to_string(i));
    }
    return {};
  }

  // What the schema allows: "a number from 0 to 1".
  std::string describe(const json& schema_or_ref) const {
    const json& schema = resolve(schema_or_ref);
    std::vector<std::string> texts;
    for (const char* keyword : {"anyOf", "oneOf"}) {
      for (const json& choice : schema.value(keyword, json::array()))
        texts.push_back(describe(choice));
    }
    for (const json& choice : schema.value("enum", json::array()))
      texts.push_back(value_text(choice));
    if (const auto only = schema.find("const"); only != schema.end())
      texts.push_back(value_text(*only));
    if (texts.empty()) {
      for (const std::string& type : type_names(schema))
        texts.push_back(describe_type(schema, type));
    }
    return texts.empty() ? "a value as the schema says" : joined(texts, " or ");
  }

  std::string describe_type(const json& schema, const std::string& type) const {
    if (type == "number" || type == "integer") {
      return (type == "number" ? "a number" : "an integer") + describe_range(schema);
    }
    if (type == "array") return "an array of " + describe_items(schema);
    if (type == "boolean") return "true or false";
    if (type == "null") return "null";
    return (type == "object" ? "an " : "a ") + type;
  }

  static std::string describe_range(const json& schema) {
    const auto bound = [&](const char* keyword, const char* words) {
      const auto found = schema.find(keyword);
      return found == schema.end() ? std::string() : words + number_text(found->get<double>());
    };
    const bool both = schema.contains("minimum") && schema.contains("maximum");
    std::vector<std::string> texts;
    for (const std::string& text :
         {bound("minimum", both ? "from " : "of at least "), bound("exclusiveMinimum", "above "),
          bound("maximum", both ? "to " : "of at most "), bound("exclusiveMaximum", "below ")}) {
      if (!text.empty()) texts.push_back(text);
    }
    return texts.empty() ? "" : " " + joined(texts, " ");
  }

  // "1 to 1024 numbers", "2 numbers".
  std::string describe_items(const json& schema) const {
    const json items = schema.value("items", json::object());
    const std::vector<std::string> types =
        type_names(resolve(items.is_array() ? items.at(0) : items));
    std::string noun = types.size() == 1 ? types[0] + "s" : "values";
    const json least = schema.value("minItems", json());
    const json most = schema.value("maxItems", json());
    if (least.is_null() && most.is_null()) return noun;
    if (least == most) return most.dump() + " " + noun;
    if (most.is_null()) return "at least " + least.dump() + " " + noun;
    return (least.is_null() ? "0" : least.dump()) + " to " + most.dump() + " " + noun;
  }

  const json& root_;
};

struct Schema {
  json text;
  Validator validator;

  explicit Schema(std::string_view content) : text(json::parse(content)), validator(text) {}
};

// A schema is read once a run: a scene holds several materials.
const Schema& schema_named(std::string_view file) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<Schema>, std::less<>> schemas;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = schemas.find(file);
  if (found != schemas.end()) return *found->second;
  return *schemas.emplace(file, std::make_unique<Schema>(schema_text(file))).first->second;
}

}  // namespace

std::string find_violation(const json& schema, const json& value) {
  if (Validator(schema).accepts(value)) return "";
  const Violation violation = Explainer(schema).explain(schema, value, "");
  return (violation.pointer.empty() ? "" : violation.pointer + ": ") + violation.text;
}

void check_against_schema(const json& value, std::string_view schema_file,
                          const std::string& file_name) {
  const Schema& schema = schema_named(schema_file);
  if (schema.validator.accepts(value)) return;
  throw InputError(one_line(file_name, kLongestFileName) + ": " +
                   find_violation(schema.text, value));
}

}  // namespace clothbrdf
