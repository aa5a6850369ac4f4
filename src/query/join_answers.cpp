// Answers about several targets as one.
#include <algorithm>
#include <iterator>

#include "vantage/error.h"
#include "vantage/query.h"

namespace vantage {
namespace {

void check_answers(std::span<const PointAnswer> answers) {
  if (answers.empty()) {
    throw Error(ErrorCode::nothing_given, "there are no answers to join", "query", "give one for each target");
  }
}

std::vector<std::string> together(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::string> result;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

std::vector<std::string> sorted(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

PointAnswer any_of(std::span<const PointAnswer> answers) {
  check_answers(answers);
  const auto best = std::max_element(answers.begin(), answers.end(), [](const PointAnswer& a, const PointAnswer& b) {
    return a.inside != b.inside ? b.inside : a.margin_m < b.margin_m;
  });
  if (best->inside) return *best;
  PointAnswer result = answers.front();
  result.outside_of = sorted(result.outside_of);
  for (const PointAnswer& answer : answers.subspan(1)) {
    result.margin_m = std::max(result.margin_m, answer.margin_m);
    result.blocked_by = together(result.blocked_by, answer.blocked_by);
    result.out_of_range = result.out_of_range && answer.out_of_range;
    result.behind_target = result.behind_target && answer.behind_target;
    const std::vector<std::string> other = sorted(answer.outside_of);
    std::vector<std::string> common;
    std::set_intersection(result.outside_of.begin(), result.outside_of.end(), other.begin(), other.end(),
                          std::back_inserter(common));
    result.outside_of = std::move(common);
  }
  return result;
}

PointAnswer all_of(std::span<const PointAnswer> answers) {
  check_answers(answers);
  PointAnswer result = answers.front();
  for (const PointAnswer& answer : answers.subspan(1)) {
    result.inside = result.inside && answer.inside;
    result.margin_m = std::min(result.margin_m, answer.margin_m);
    result.blocked_by = together(result.blocked_by, answer.blocked_by);
    result.out_of_range = result.out_of_range || answer.out_of_range;
    result.behind_target = result.behind_target || answer.behind_target;
    for (const std::string& limit : answer.outside_of) {
      const auto& known = result.outside_of;
      if (std::find(known.begin(), known.end(), limit) == known.end()) result.outside_of.push_back(limit);
    }
  }
  return result;
}

}  // namespace vantage
