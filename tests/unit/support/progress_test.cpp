#include "support/progress.h"

#include <thread>
#include <vector>

#include "tests/catch.h"

namespace clothbrdf::test {

TEST_CASE("progress counts what several threads finish, phase by phase") {
  Progress progress;
  CHECK(progress.snapshot().what.empty());
  for (const std::size_t each : {1000U, 7U}) {
    constexpr std::size_t kThreads = 4;
    const auto before = std::chrono::steady_clock::now();
    progress.begin("silk.exr", 2 * kThreads * each, "cells");
    CHECK(progress.snapshot().done == 0);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < kThreads; ++t) {
      threads.emplace_back([&] {
        for (std::size_t k = 0; k < each; ++k) progress.advance(2);
      });
    }
    while (progress.snapshot().done < progress.snapshot().total) std::this_thread::yield();
    for (std::thread& thread : threads) thread.join();
    const Progress::Snapshot snapshot = progress.snapshot();
    CHECK(snapshot.what == "silk.exr");
    CHECK(snapshot.done == 2 * kThreads * each);
    CHECK(snapshot.total == 2 * kThreads * each);
    CHECK(snapshot.unit == "cells");
    CHECK(snapshot.since >= before);
    CHECK(snapshot.since <= std::chrono::steady_clock::now());
  }
}

TEST_CASE("once cancelled, whoever counts, asks or begins is stopped") {
  Progress progress;
  const Workers workers(3, &progress);
  workers.check();
  workers.advance(1);
  std::thread([&] { progress.cancel(); }).join();
  CHECK_THROWS_AS(progress.check(), Cancelled);
  CHECK_THROWS_AS(progress.advance(1), Cancelled);
  CHECK_THROWS_AS(progress.begin("silk.exr", 1, "cells"), Cancelled);
  CHECK_THROWS_AS(workers.check(), Cancelled);
  CHECK_THROWS_AS(workers.advance(1), Cancelled);
}

TEST_CASE("workers made of a plain number count nowhere") {
  const Workers workers = 3;
  CHECK(workers.threads == 3);
  workers.check();
  workers.advance(1);
}

}  // namespace clothbrdf::test
