// The one way from work to its caller: how often it asks, from where, and what no means.
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/stopwatch.h"
#include "support/progress_check.h"
#include "support/wording.h"
#include "vantage/error.h"

namespace vantage::internal::core {
namespace {

struct Told {
  std::string stage;
  double fraction;
  bool operator==(const Told&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Told& told) { return out << told.stage << " " << told.fraction; }

/// Keeps all that it is told.
struct Listener {
  std::vector<Told> told;
  Progress progress = [this](std::string_view stage, double fraction) {
    told.push_back({std::string(stage), fraction});
    return true;
  };
};

void expect_cancelled(const std::function<void()>& action) { testing::expect_code(action, ErrorCode::cancelled); }

TEST(ProgressReporter, WithoutAListenerDoesNothing) {
  const Progress nobody;
  for (const ProgressReporter& progress : {ProgressReporter(), ProgressReporter(nobody)}) {
    EXPECT_FALSE(progress.is_followed());
    progress.begin("stage");
    progress.report(0.5);
    progress.check();
    progress.tick();
    progress.part(0, 0.5).finish();
  }
}

TEST(ProgressReporter, TellsTheBeginningAndTheEndOfAStageAtOnce) {
  Listener listener;
  const ProgressReporter progress(listener.progress);
  for (const char* stage : {"one", "two"}) {
    progress.begin(stage);
    progress.finish();
  }
  EXPECT_EQ(listener.told, (std::vector<Told>{{"one", 0}, {"one", 1}, {"two", 0}, {"two", 1}}));
}

TEST(ProgressReporter, AsksNowAndThenHoweverOftenItIsCalled) {
  Listener listener;
  const ProgressReporter progress(listener.progress);
  progress.begin("stage");
  const core::Stopwatch stopwatch;
  while (stopwatch.seconds() < 0.1) progress.tick();
  EXPECT_GE(listener.told.size(), 3U);
  EXPECT_LE(listener.told.size(), 12U);
}

TEST(ProgressReporter, FractionsDoNotFall) {
  const ProgressReporter::AskAlways always;
  Listener listener;
  const ProgressReporter progress(listener.progress);
  progress.begin("stage");
  for (const double fraction : {0.25, 0.125, 0.5, 2.0, 0.75}) progress.report(fraction);
  progress.check();
  std::vector<double> fractions;
  for (const Told& told : listener.told) fractions.push_back(told.fraction);
  EXPECT_EQ(fractions, (std::vector<double>{0, 0.25, 0.25, 0.5, 1, 1, 1}));
}

TEST(ProgressReporter, PartsOfPartsAreFractionsOfTheWhole) {
  const ProgressReporter::AskAlways always;
  Listener listener;
  const ProgressReporter progress(listener.progress);
  progress.begin("stage");
  const ProgressReporter part = progress.part(0.5, 1);
  part.report(0.5);
  part.part(0.5, 0.75).report(1, 2);
  part.part(0.5, 0.75).finish();
  progress.part(0, 0).report(1);  // asks, and leaves the fraction as it is
  part.finish();
  std::vector<double> fractions;
  for (const Told& told : listener.told) fractions.push_back(told.fraction);
  EXPECT_EQ(fractions, (std::vector<double>{0, 0.75, 0.8125, 0.875, 0.875, 1}));
}

TEST(ProgressReporter, NoIsForAllCopiesAndForGood) {
  const ProgressReporter::AskAlways always;
  int asked = 0;
  const Progress no = [&](std::string_view, double) { return ++asked < 2; };
  const ProgressReporter progress(no, "city.obj");
  const ProgressReporter part = progress.part(0, 0.5);
  progress.begin("reading");
  try {
    part.report(0.5);
    ADD_FAILURE() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
    EXPECT_EQ(error.where(), "city.obj");
  }
  expect_cancelled([&] { progress.check(); });
  expect_cancelled([&] { progress.begin("more"); });
  expect_cancelled([&] { part.finish(); });
  EXPECT_EQ(asked, 2);
}

TEST(ProgressReporter, ThrowsOnWhatTheListenerThrows) {
  const Progress broken = [](std::string_view, double) -> bool { throw std::logic_error("mine"); };
  const ProgressReporter progress(broken);
  EXPECT_THROW(progress.begin("stage"), std::logic_error);
  EXPECT_THROW(progress.begin("stage"), std::logic_error) << "it may be asked again";
}

TEST(ProgressReporter, CountsWhatManyThreadsDo) {
  for (const int threads : {1, 4}) {
    const testing::ProgressStory story = testing::check_progress([&](const Progress& callback) {
      const ProgressReporter progress(callback);
      progress.begin("loop");
      ProgressCounter counter(progress, 1000);
      parallel::with_threads(threads, [&] {
        parallel::for_ranges(1000, 10, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) counter.add();
        });
      });
      progress.finish();
    });
    EXPECT_EQ(story.last_fraction.at("loop"), 1);
    EXPECT_GT(story.calls, threads == 1 ? 1000U : 10U);
  }
}

TEST(ProgressReporter, ANoEndsALoopOnAllThreads) {
  const ProgressReporter::AskAlways always;
  std::atomic<int> done = 0, asked = 0;
  const Progress soon_no = [&](std::string_view, double) { return ++asked < 10; };
  const ProgressReporter progress(soon_no);
  expect_cancelled([&] {
    parallel::for_ranges(1000000, 1, [&](std::size_t, std::size_t) {
      progress.check();
      ++done;
    });
  });
  EXPECT_EQ(asked, 10);
  EXPECT_LT(done, 500000);
}

}  // namespace
}  // namespace vantage::internal::core
