#include "formats/schema_check.h"

#include <nlohmann/json.hpp>

#include "tests/catch.h"

namespace clothbrdf::test {

using nlohmann::json;

namespace {
const std::string kNoViolation;
}

TEST_CASE("a value that follows the schema has no violation") {
  CHECK(find_violation(R"({"type": "number", "minimum": 0})"_json, 1.5) == kNoViolation);
}

TEST_CASE("what is allowed is told for every kind of bound") {
  const auto told = [](const json& schema, const json& value) {
    return find_violation(schema, value);
  };
  CHECK(told({{"type", "number"}, {"minimum", 2}}, 1) ==
        "1 is not allowed: a number of at least 2");
  CHECK(told({{"type", "number"}, {"maximum", 2}}, 3) == "3 is not allowed: a number of at most 2");
  CHECK(told({{"type", "number"}, {"exclusiveMinimum", 2}}, 2) ==
        "2 is not allowed: a number above 2");
  CHECK(told({{"type", "number"}, {"exclusiveMaximum", 2}}, 2) ==
        "2 is not allowed: a number below 2");
  CHECK(told({{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", 1}}, 0) ==
        "0 is not allowed: a number above 0 of at most 1");
  CHECK(told({{"type", "boolean"}}, 0) == "0 is not allowed: true or false");
  CHECK(told({{"type", {"number", "null"}}}, "x") == "\"x\" is not allowed: a number or null");
  CHECK(told({{"const", 3}}, 4) == "4 is not allowed: 3");
  CHECK(told({{"type", "array"}, {"minItems", 1}}, json::array()) ==
        "[] is not allowed: an array of at least 1 values");
  CHECK(told({{"type", "array"}, {"maxItems", 1}, {"items", {{"type", "string"}}}}, {"a", "b"}) ==
        "[\"a\",\"b\"] is not allowed: an array of 0 to 1 strings");
}

TEST_CASE("of alternatives the one of the value's type is meant") {
  const json schema = R"({
    "definitions": {
      "angle": {"type": "number", "minimum": 0, "maximum": 90},
      "span": {"oneOf": [{"$ref": "#/definitions/angle"},
                         {"type": "array", "items": {"$ref": "#/definitions/angle"},
                          "minItems": 2, "maxItems": 2}]}
    },
    "type": "object",
    "additionalProperties": {"$ref": "#/definitions/span"}})"_json;
  CHECK(find_violation(schema, R"({"a": 90, "b": [0, 90]})"_json) == kNoViolation);
  CHECK(find_violation(schema, R"({"a": 91})"_json) ==
        "/a: 91 is not allowed: a number from 0 to 90");
  CHECK(find_violation(schema, R"({"a": [0, 91]})"_json) ==
        "/a/1: 91 is not allowed: a number from 0 to 90");
  CHECK(find_violation(schema, R"({"a": [0]})"_json) ==
        "/a: [0] is not allowed: an array of 2 numbers");
  CHECK(find_violation(schema, R"({"a": "x"})"_json) ==
        "/a: \"x\" is not allowed: a number from 0 to 90 or an array of 2 numbers");
}

TEST_CASE("of parts that all hold the one that fails is told") {
  const json schema = R"({"allOf": [{"type": "object"}, {"type": "object", "required": ["x"],
    "properties": {"x": {"type": "integer", "minimum": 1, "maximum": 2}}}]})"_json;
  CHECK(find_violation(schema, R"({"x": 1, "y": 0})"_json) == kNoViolation);
  CHECK(find_violation(schema, R"({})"_json) == "/x: missing, needed is an integer from 1 to 2");
  CHECK(find_violation(schema, R"({"x": 3})"_json) ==
        "/x: 3 is not allowed: an integer from 1 to 2");
}

TEST_CASE("each place of a tuple has its own schema") {
  const json schema =
      R"({"type": "array",
          "items": [{"type": "number"}, {"type": "string"}, {"type": "null"}]})"_json;
  CHECK(find_violation(schema, R"([1, "a", null, 5])"_json) == kNoViolation);
  CHECK(find_violation(schema, R"([1, 2])"_json) == "/1: 2 is not allowed: a string");
  CHECK(find_violation(schema, R"([1, "a", 3])"_json) == "/2: 3 is not allowed: null");
}

TEST_CASE("long values are shortened, at a whole character") {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "\xE7\x8E\x89";
  const std::string message = find_violation({{"type", "number"}}, text);
  CHECK(message.size() < 120);
  CHECK_NOTHROW(json(message).dump());  // throws on broken UTF-8
  CHECK_THAT(message, ContainsSubstring("... is not allowed: a number"));
}

TEST_CASE("pointers are escaped") {
  const json schema = {{"type", "object"}, {"additionalProperties", {{"type", "number"}}}};
  CHECK(find_violation(schema, {{"a/b~c", "x"}}) == "/a~1b~0c: \"x\" is not allowed: a number");
}

}  // namespace clothbrdf::test
