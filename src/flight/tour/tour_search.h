// The search for the order of a tour: ruin and recreate.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress_reporter.h"
#include "flight/tour/tour_course.h"

namespace vantage::internal::flight::tour {

struct SearchOptions {
  std::uint64_t seed = 1;
  double time_limit_s = 60;  ///< it ends then; the result then depends on the machine
  int rounds = 0;            ///< it ends after so many; 0: as many as the number of regions asks for
};

enum class SearchEnd { done, time_limit, cancelled };

struct SearchResult {
  std::vector<Course> courses;  ///< of different orders, the shortest first; at least one
  SearchEnd end = SearchEnd::done;
  int rounds = 0;
};

/// Short courses that serve every region. Begins with the cheapest insertion, then again and again takes out some
/// regions that are near to each other and puts them back where they cost least (G. Schrimpf et al., "Record breaking
/// optimization results using the ruin and recreate principle", 2000; J. Christiaens and G. Vanden Berghe, "Slack
/// induction by string removals", 2020), with 2-opt and Or-opt between, and now and then takes a longer course to go
/// on with. The same result on every machine, unless time or the caller end it. A call to stop is obeyed, and what was
/// found so far is returned. The regions must not be empty.
SearchResult search_order(const Regions& regions, const CourseKind& kind, const SearchOptions& options,
                          const core::ProgressReporter& progress);

}  // namespace vantage::internal::flight::tour
