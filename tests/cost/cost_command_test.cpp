#include <chrono>
#include <cmath>
#include <map>

#include "tests/catch.h"
#include "tests/support/commands.h"
#include "tests/support/temporary_folder.h"

namespace clothbrdf::test {
namespace {

using nlohmann::json;

constexpr double kLongest = 180;  // seconds, on two cores
constexpr double kNear = 2;       // in time

// What two runs must say alike, by name; nothing where a setting has none.
std::map<std::string, std::vector<double>> errors_of(const json& report) {
  std::map<std::string, std::vector<double>> errors;
  for (const json& s : report["settings"]) {
    errors[s["front"].get<std::string>() + s["dial"].get<std::string>() +
           s["name"].get<std::string>()] = {s["error"]["rms"], s["error"]["p99"], s["error"]["max"],
                                            s.value("isotropy_loss", 0.0), s.value("bytes", 0.0)};
  }
  return errors;
}

}  // namespace

TEST_CASE("cost measures what accuracy costs, and the same errors each time") {
  const std::string silk = preset("silk").string();
  const auto start = std::chrono::steady_clock::now();
  const json report = json_of({"cost", silk, "--threads", "2"});
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  WARN(report["settings"].size() << " settings in " << taken.count() << " s");
  CHECK(taken.count() <= kLongest);
  CHECK(report["settings"].size() >= 40);

  // Settings that write a file, on fronts that span decades of error. Small files all take about as
  // long, so that chance decides which of them are on the front: those that are within a factor of
  // two of it in time count.
  for (const auto& [front, decades] : std::map<std::string, double>{{"3-D", 3}, {"4-D", 2}}) {
    double least = INFINITY;
    double most = 0;
    std::size_t points = 0;
    for (const json& s : report["settings"]) {
      if (s["front"] != front) continue;
      CHECK(s["bytes"] > 0);
      CHECK(s["seconds"]["lowest"] <= s["seconds"]["median"]);
      CHECK(s["seconds"]["median"] <= s["seconds"]["highest"]);
      CHECK(s.contains("isotropy_loss") == (front == "3-D"));
      bool near = true;
      for (const json& other : report["settings"]) {
        if (other["front"] != front || other["error"]["rms"] >= s["error"]["rms"]) continue;
        const double slower =
            s["seconds"]["median"].get<double>() / other["seconds"]["median"].get<double>();
        // None of the front is both faster and as accurate.
        if (s["pareto"].get<bool>()) CHECK(slower <= 1);
        near = near && slower <= kNear;
      }
      if (!near) continue;
      least = std::min(least, s["error"]["rms"].get<double>());
      most = std::max(most, s["error"]["rms"].get<double>());
      ++points;
    }
    WARN(front << ": " << points << " settings on the front or near it, rms from " << least
               << " to " << most);
    CHECK(std::log10(most / least) >= decades);
  }

  const json again = json_of({"cost", silk, "--threads", "1"});
  CHECK(errors_of(again) == errors_of(report));
}

}  // namespace clothbrdf::test
