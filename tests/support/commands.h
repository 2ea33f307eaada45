#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

/// Path of the preset that most commands are tried with.
inline const std::string kSilk = preset("silk").string();
inline const std::string kOld = "what was there before";

/// Standard output of a run that went well and had nothing to complain of.
inline std::string output_of(const Arguments& arguments, const std::string& input = "") {
  const Outcome outcome = run_program(arguments, {.input = input});
  CAPTURE(arguments);
  CHECK(outcome.err == "");
  REQUIRE(outcome.exit_code == 0);
  return outcome.out;
}

/// The same with --json, read.
inline nlohmann::json json_of(Arguments arguments) {
  arguments.emplace_back("--json");
  return nlohmann::json::parse(output_of(arguments));
}

}  // namespace clothbrdf::test
