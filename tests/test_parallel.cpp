// Threads: how many work, and what becomes of exceptions.
#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "core/parallel.h"

namespace vantage::internal::parallel {
namespace {

/// The threads that a loop with plenty of work for many runs on.
std::set<std::thread::id> workers() {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  for_ranges(64, 1, [&](std::size_t, std::size_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard lock(mutex);
    seen.insert(std::this_thread::get_id());
  });
  return seen;
}

TEST(Parallel, OneThreadIsOne) {
  with_threads(1, [] { EXPECT_EQ(workers(), std::set{std::this_thread::get_id()}); });
}

TEST(Parallel, WorkOnAThreadOfItsOwnKeepsToTheCallersNumber) {
  for (const int threads : {1, 3}) {
    with_threads(threads, [&] {
      std::set<std::thread::id> seen;
      run_while_asking([&] { seen = workers(); }, [] {});
      EXPECT_EQ(seen.count(std::this_thread::get_id()), 0u);
      EXPECT_GE(seen.size(), 1u);
      EXPECT_LE(seen.size(), static_cast<std::size_t>(threads));
    });
  }
}

TEST(Parallel, AsksOnTheCallersThreadUntilTheWorkIsDone) {
  int asked = 0;
  const std::thread::id caller = std::this_thread::get_id();
  bool done = false;
  run_while_asking(
      [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        done = true;
      },
      [&] {
        ++asked;
        EXPECT_EQ(std::this_thread::get_id(), caller);
      });
  EXPECT_TRUE(done);
  EXPECT_GT(asked, 1);
}

TEST(Parallel, ThrowsOnWhatEitherThrowsWhenTheWorkIsDone) {
  EXPECT_THROW(run_while_asking([] { throw std::domain_error("work"); }, [] {}), std::domain_error);
  bool done = false;
  const auto work = [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    done = true;
  };
  EXPECT_THROW(run_while_asking(work, [] { throw std::range_error("ask"); }), std::range_error);
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace vantage::internal::parallel
