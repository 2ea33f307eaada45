#include "tests/catch.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {

TEST_CASE("cost refuses outputs and materials that cannot be, before any work") {
  const TemporaryFolder folder;
  const std::string silk = preset("silk").string();
  const std::string json = (folder / "x.json").string();
  const std::string missing = (folder / "missing.json").string();
  struct Refusal {
    Arguments arguments;
    int exit_code;
    std::string told;
  };
  const std::vector<Refusal> refusals = {
      {{"cost", silk, "-o", (folder / "x.pdf").string()},
       2,
       "the ending '.pdf' is not allowed: .json (report), .csv (table), .svg or .png (picture)"},
      {{"cost", silk, "-o", json, "-o", json}, 2, json + " is given twice"},
      {{"cost", missing, "-o", json}, 2, missing + ": there is no such file"},
      {{"cost", silk, "-o", silk}, 2, "is also read"},
      {{"cost", silk, "--threads", "0"}, 2, "--threads: '0' is not allowed"},
      {{"cost"}, 2, "MATERIAL is required"},
      {{"cost", silk, "-o", (folder / "none/x.csv").string()}, 1, "No such file or directory"},
  };
  for (const Refusal& refusal : refusals) {
    CAPTURE(refusal.arguments);
    const Outcome outcome = run_program(refusal.arguments);
    CHECK(not_a_refusal(outcome, refusal.exit_code) == "");
    CHECK_THAT(outcome.err, ContainsSubstring(refusal.told));
  }
  CHECK(folder.entry_count() == 0);
}

}  // namespace clothbrdf::test
