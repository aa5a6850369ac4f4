#include "support/progress_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>

#include "core/progress_reporter.h"
#include "support/internals.h"
#include "vantage/error.h"

namespace vantage::testing {
namespace {

/// Answers no to question `stop` (from 1). False when there were fewer questions.
bool expect_stop(const std::function<void(const Progress&)>& call, std::size_t stop) {
  std::size_t asked = 0;
  try {
    call([&](std::string_view, double) { return ++asked < stop; });
    EXPECT_LT(asked, stop) << "went on after question " << stop;
    return false;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled) << error.what();
    EXPECT_EQ(asked, stop) << "asked again after question " << stop;
  }
  return true;
}

}  // namespace

ProgressStory follow(const std::function<void(const Progress&)>& call) {
  const core::ProgressReporter::AskAlways always;
  ProgressStory story;
  std::atomic<int> inside = 0;
  call([&](std::string_view stage, double fraction) {
    EXPECT_EQ(++inside, 1) << "two threads at once";
    EXPECT_GE(fraction, 0) << stage;
    EXPECT_LE(fraction, 1) << stage;
    const std::string name(stage);
    if (story.stages.empty() || story.stages.back() != name || fraction == 0) {
      if (story.stages.empty() || story.stages.back() != name) story.stages.push_back(name);
    } else {
      EXPECT_GE(fraction, story.last_fraction[name]) << name;
    }
    story.last_fraction[name] = fraction;
    ++story.calls;
    ++story.calls_in[name];
    --inside;
    return true;
  });
  return story;
}

ProgressStory check_progress(const std::function<void(const Progress&)>& call) {
  ProgressStory story = follow(call);
  const core::ProgressReporter::AskAlways always;
  constexpr std::size_t kSurely = 4;
  std::set<std::size_t> stops = {1, 2, 3, kSurely, story.calls};
  for (std::size_t i = 1; i < 12; ++i) stops.insert(std::max<std::size_t>(1, story.calls * i / 12));
  for (const std::size_t stop : stops) {
    const bool stopped = expect_stop(call, stop);
    // On many threads there may be fewer questions next time: a thread that finds another one asking goes on.
    EXPECT_TRUE(stopped || stop > kSurely) << "not stopped at question " << stop << " of " << story.calls;
  }
  return story;
}

}  // namespace vantage::testing
