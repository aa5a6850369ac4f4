#include "flight/check_links.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/format.h"
#include "core/text.h"
#include "vantage/error.h"
#include "vantage/sensor.h"
#include "vantage/target.h"

namespace vantage::internal::flight {
namespace {

/// The farthest of all positions within the radius of the leg: a distance is a convex function along it.
double farthest_m(const Leg& leg, const Vec3& point, double radius_m) {
  return std::max((leg.from - point).norm(), (leg.to - point).norm()) + radius_m;
}

PreparedTarget antenna(const FlightLink& link, const PreparedScene& scene, const std::vector<Leg>& legs,
                       double radius_m, const std::string& place) {
  Target target = Target::point(link.point);
  target.name = link.name;
  // Where no range is asked for, all of the flight is in range.
  double farthest = 1;
  for (const Leg& leg : legs) farthest = std::max(farthest, farthest_m(leg, link.point, radius_m));
  constexpr double kMore = 1.01;
  Sensor sensor{.max_range_m = link.max_range_m.value_or(kMore * farthest)};
  sensor.link = link.radio;
  try {
    return {scene, target, sensor};
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    throw Error(error.code(), "the link '" + link.name + "' cannot begin at its point, as a target: " + error.problem(),
                place, error.fix());
  }
}

}  // namespace

JudgedLink::JudgedLink(const FlightLink& link, const PreparedScene& scene, const std::vector<Leg>& legs,
                       double radius_m, const std::string& place)
    : link_(link), views_(antenna(link, scene, legs, radius_m, place)) {}

LinkCheck JudgedLink::check(const std::vector<LegView>& views, const std::vector<Leg>& legs,
                            const FlightTimeline& along, double radius_m) const {
  LinkCheck check;
  check.name = link_.name;
  check.point = link_.point;
  check.max_range_m = link_.max_range_m;
  check.radio = link_.radio;
  std::vector<Stretch> linked, lost;
  std::map<std::pair<NotSeen::Kind, std::string>, std::vector<Stretch>> reasons;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const LegView& view = views[i];
    append(linked, i, view.seen);
    std::vector<LegInterval> all = view.out_of_range;
    all.insert(all.end(), view.behind_target.begin(), view.behind_target.end());
    append(reasons[{NotSeen::Kind::out_of_range, ""}], i, view.out_of_range);
    append(reasons[{NotSeen::Kind::behind, ""}], i, view.behind_target);
    for (const LegBlocker& blocker : view.hidden_by) {
      append(reasons[{NotSeen::Kind::hidden, blocker.name}], i, blocker.intervals);
      all.insert(all.end(), blocker.intervals.begin(), blocker.intervals.end());
    }
    append(lost, i, united(std::move(all)));
    for (const double share : {0.0, 1.0}) {
      const Vec3 position = share == 0 ? legs[i].from : legs[i].to;
      const double distance = (position - link_.point).norm() + radius_m;
      if (distance <= check.farthest_m) continue;
      check.farthest_m = distance;
      check.farthest_at_m = along.at_m(i, share);
      check.farthest_at = position;
    }
  }
  check.linked = spans_of(along, linked);
  check.lost = spans_of(along, lost);
  for (const auto& [reason, stretches] : reasons) {
    if (!stretches.empty()) check.reasons.push_back({reason.first, reason.second, spans_of(along, stretches)});
  }
  std::stable_sort(check.reasons.begin(), check.reasons.end(),
                   [](const NotSeen& a, const NotSeen& b) { return a.length_m() > b.length_m(); });
  return check;
}

std::optional<std::string> failure_of(const LinkCheck& link) {
  using core::number_text;
  if (link.lost.empty()) return std::nullopt;
  const FlightSpan& first = link.lost.front();
  const auto begins_there = [&](const NotSeen& reason) {
    return std::any_of(reason.spans.begin(), reason.spans.end(),
                       [&](const FlightSpan& span) { return span.begin_m == first.begin_m; });
  };
  const auto reason = std::find_if(link.reasons.begin(), link.reasons.end(), begins_there);
  std::string why = "it is out of range";
  if (reason != link.reasons.end() && reason->kind == NotSeen::Kind::hidden) {
    why = (reason->name.empty() ? "the scene" : reason->name) + " is in the way";
  }
  const std::string more = link.lost.size() > 1 ? core::format(", and on {} more stretches", link.lost.size() - 1) : "";
  return core::format("the link to {} is lost from {} to {} m along the flight{}: {}", link.name,
                      number_text(first.begin_m), number_text(first.end_m), more, why);
}

}  // namespace vantage::internal::flight
