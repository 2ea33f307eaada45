#include "cost/timing.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace clothbrdf {

Timing timing_of(int repeats, const std::function<double()>& seconds) {
  std::vector<double> all(static_cast<std::size_t>(repeats));
  std::generate(all.begin(), all.end(), seconds);
  std::sort(all.begin(), all.end());
  const std::size_t middle = all.size() / 2;
  const double median = all.size() % 2 == 1 ? all[middle] : (all[middle - 1] + all[middle]) / 2;
  return {median, all.front(), all.back()};
}

Timing time_million_pairs(int repeats, std::size_t pairs, const Workers& workers,
                          const std::function<void()>& evaluate) {
  using Clock = std::chrono::steady_clock;
  constexpr double kLongEnough = 0.05;
  constexpr double kMillion = 1e6;
  evaluate();
  return timing_of(repeats, [&] {
    const Clock::time_point start = Clock::now();
    double elapsed = 0;
    double done = 0;
    while (elapsed < kLongEnough) {
      workers.check();
      evaluate();
      done += static_cast<double>(pairs);
      elapsed = std::chrono::duration<double>(Clock::now() - start).count();
    }
    return elapsed / done * kMillion;
  });
}

}  // namespace clothbrdf
