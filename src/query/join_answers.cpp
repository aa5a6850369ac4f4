// Answers about several targets as one.
#include <algorithm>
#include <iterator>
#include <utility>

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

ViewsQuery::ViewsQuery(const std::vector<std::vector<PreparedTarget>>& views, const Navigation& navigation,
                       const Progress& progress) {
  check_navigation(navigation, progress);
  const auto is_empty = [](const std::vector<PreparedTarget>& view) { return view.empty(); };
  if (views.empty() || std::any_of(views.begin(), views.end(), is_empty)) {
    throw Error(ErrorCode::nothing_given, "there is no target to ask about", "views", "give one in each list or more");
  }
  for (const std::vector<PreparedTarget>& view : views) {
    views_.emplace_back();
    for (const PreparedTarget& target : view) views_.back().push_back(PointQuery::unchecked(target, navigation));
  }
}

std::vector<PointAnswer> ViewsQuery::answer(std::span<const Vec3> points) {
  if (PointQuery* const one = single()) return one->answer(points);
  std::vector<std::vector<PointAnswer>> of_views(points.size());
  for (std::vector<PointQuery>& view : views_) {
    std::vector<std::vector<PointAnswer>> of_targets(points.size());
    for (PointQuery& query : view) {
      std::vector<PointAnswer> answers = query.answer(points);
      for (std::size_t i = 0; i < points.size(); ++i) of_targets[i].push_back(std::move(answers[i]));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      of_views[i].push_back(view.size() == 1 ? std::move(of_targets[i][0]) : any_of(of_targets[i]));
    }
  }
  std::vector<PointAnswer> result;
  for (const std::vector<PointAnswer>& answers : of_views) result.push_back(all_of(answers));
  return result;
}

PointQuery* ViewsQuery::single() {
  return views_.size() == 1 && views_.front().size() == 1 ? &views_.front().front() : nullptr;
}

}  // namespace vantage
