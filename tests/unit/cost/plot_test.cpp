#include "cost/plot.h"

#include <cstdlib>
#include <limits>

#include "support/errors.h"
#include "tests/catch.h"
#include "tests/support/cost_reports.h"

namespace clothbrdf::test {
namespace {

// The script's lines from the one that begins a block of data to its end.
std::size_t blocks_with(const std::string& script, const std::string& point) {
  std::size_t count = 0;
  const std::string line = "\n" + point + "\n";
  for (std::size_t at = 0; (at = script.find(line, at)) != std::string::npos; ++at) ++count;
  return count;
}

std::string with_one_point(CostReport report, double seconds, double rms) {
  report.settings.resize(2);
  report.settings[1].seconds.median = seconds;
  report.settings[1].error.rms = rms;
  return cost_plot(report, "svg");
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value = value << 8U | static_cast<unsigned char>(bytes.at(at + k));
  }
  return value;
}

}  // namespace

TEST_CASE("a picture of costs draws the front as a line and coloured points, the rest in grey") {
  CostReport report = full_cost_report();
  report.settings.resize(2);
  report.settings[0].seconds.median = 0.5;
  report.settings[0].error.rms = 0.25;
  report.settings[1].seconds.median = 0.75;
  report.settings[1].error.rms = 0.375;
  const std::string script = cost_plot(report, "svg");
  CAPTURE(script);
  CHECK(blocks_with(script, "0.5 0.25") == 2);  // of the line and of the point
  CHECK(blocks_with(script, "0.75 0.375") == 1);
  CHECK_THAT(script, ContainsSubstring("layout 1,1 "));
  const std::size_t grey = script.find("#B0B0B0");
  REQUIRE(grey != std::string::npos);
  CHECK(script.find("#B0B0B0", grey + 1) == std::string::npos);
  CHECK_THAT(cost_plot(full_cost_report(), "svg"), ContainsSubstring("layout 1,3 "));
}

TEST_CASE("a picture of costs leaves out what a logarithmic axis cannot show") {
  const CostReport report = full_cost_report();
  CHECK(blocks_with(with_one_point(report, 0.75, 0.375), "0.75 0.375") == 1);
  CHECK(blocks_with(with_one_point(report, 0.75, 0), "0.75 0") == 0);
  CHECK(blocks_with(with_one_point(report, 0, 0.375), "0 0.375") == 0);
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(blocks_with(with_one_point(report, 0.75, infinite), "0.75 inf") == 0);
  CHECK_THROWS_AS(cost_plot(CostReport{}, "svg"), WorkError);
}

TEST_CASE("gnuplot renders a picture of costs in its size, whatever the names in it") {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0) {
    if (std::getenv("CI") != nullptr) FAIL("there is no gnuplot");
    WARN("skipped: there is no gnuplot");
    return;
  }
  CostReport report = full_cost_report();
  report.material.name = "it's a_{b}^c \"$x\" `false` @y\n#1";
  report.settings[0].dial = "o'clock_1";
  const TemporaryFolder folder;
  const std::string script = (folder / "plot.gp").string();
  const std::string picture = (folder / "plot.png").string();
  const std::string errors = (folder / "errors").string();
  write_file(script, cost_plot(report, "pngcairo"));
  const std::string command = "gnuplot '" + script + "' >'" + picture + "' 2>'" + errors + "'";
  const int status = std::system(command.c_str());
  CAPTURE(read_file(errors));
  CHECK(status == 0);
  CHECK(read_file(errors).empty());
  const std::string bytes = read_file(picture);
  REQUIRE(bytes.size() > 5000);
  CHECK(bytes.starts_with("\x89PNG"));
  CHECK(big_endian(bytes, 16) == kCostPlotWidth);
  CHECK(big_endian(bytes, 20) == kCostPlotHeight);
}

}  // namespace clothbrdf::test
