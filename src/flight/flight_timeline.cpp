#include "flight/flight_timeline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vantage::internal::flight {

FlightTimeline::FlightTimeline(const Flight& flight, double speed_m_s) : flight_(flight) {
  at_m_.push_back(0);
  arrival_s_.push_back(0);
  departure_s_.push_back(flight.points.front().hold_s);
  for (std::size_t i = 0; i < flight.leg_count(); ++i) {
    const FlightPoint& end = flight.points[i + 1];
    const double length = end.is_other_way ? 0 : (end.position - flight.points[i].position).norm();
    speed_m_s_.push_back(std::isnan(end.speed_m_s) ? speed_m_s : end.speed_m_s);
    at_m_.push_back(at_m_.back() + length);
    arrival_s_.push_back(departure_s_.back() + (length > 0 ? length / speed_m_s_.back() : 0));
    departure_s_.push_back(arrival_s_.back() + end.hold_s);
  }
}

Vec3 FlightTimeline::position(std::size_t leg, double share) const {
  if (flight_.leg_count() == 0) return flight_.points.front().position;
  const Leg on = flight_.leg(leg);
  if (share == 1) return on.to;
  return on.from + share * (on.to - on.from);
}

double FlightTimeline::at_m(std::size_t leg, double share) const {
  if (share == 0 || leg + 1 == at_m_.size()) return at_m_[leg];
  return share == 1 ? at_m_[leg + 1] : at_m_[leg] + share * (at_m_[leg + 1] - at_m_[leg]);
}

FlightSpan FlightTimeline::span(const Stretch& stretch) const {
  const auto time = [this](std::size_t leg, double share) {
    return departure_s_[leg] + share * (arrival_s_[leg + 1] - departure_s_[leg]);
  };
  FlightSpan span;
  span.begin_m = at_m(stretch.begin_leg, stretch.begin_share);
  span.end_m = at_m(stretch.end_leg, stretch.end_share);
  span.begin = position(stretch.begin_leg, stretch.begin_share);
  span.end = position(stretch.end_leg, stretch.end_share);
  if (flight_.leg_count() == 0) {
    span.end_s = departure_s_.front();
    return span;
  }
  span.begin_s =
      stretch.begin_share == 0 ? arrival_s_[stretch.begin_leg] : time(stretch.begin_leg, stretch.begin_share);
  span.end_s = stretch.end_share == 1 ? departure_s_[stretch.end_leg + 1] : time(stretch.end_leg, stretch.end_share);
  if (stretch.begin_share == 1) span.begin_s = arrival_s_[stretch.begin_leg + 1];
  if (stretch.end_share == 0) span.end_s = departure_s_[stretch.end_leg];
  return span;
}

void append(std::vector<Stretch>& stretches, std::size_t leg, std::span<const LegInterval> intervals) {
  for (const LegInterval& interval : intervals) {
    if (!stretches.empty()) {
      Stretch& last = stretches.back();
      const bool meets = (last.end_leg == leg && last.end_share >= interval.begin) ||
                         (last.end_leg + 1 == leg && last.end_share == 1 && interval.begin == 0);
      if (meets) {
        last.end_leg = leg;
        last.end_share = interval.end;
        continue;
      }
    }
    stretches.push_back({leg, interval.begin, leg, interval.end});
  }
}

std::vector<FlightSpan> spans_of(const FlightTimeline& along, const std::vector<Stretch>& stretches) {
  std::vector<FlightSpan> spans;
  spans.reserve(stretches.size());
  for (const Stretch& stretch : stretches) spans.push_back(along.span(stretch));
  return spans;
}

std::vector<LegInterval> united(std::vector<LegInterval> intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [](const LegInterval& a, const LegInterval& b) { return a.begin < b.begin; });
  std::vector<LegInterval> result;
  for (const LegInterval& interval : intervals) {
    if (!result.empty() && interval.begin <= result.back().end) {
      result.back().end = std::max(result.back().end, interval.end);
    } else {
      result.push_back(interval);
    }
  }
  return result;
}

std::vector<LegInterval> in_both(std::span<const LegInterval> a, std::span<const LegInterval> b) {
  std::vector<LegInterval> result;
  for (const LegInterval& one : a) {
    for (const LegInterval& other : b) {
      const LegInterval both{std::max(one.begin, other.begin), std::min(one.end, other.end)};
      if (both.begin <= both.end) result.push_back(both);
    }
  }
  return united(std::move(result));
}

std::vector<LegInterval> without(std::span<const LegInterval> intervals, std::span<const LegInterval> removed) {
  std::vector<LegInterval> result;
  std::size_t first = 0;
  for (LegInterval left : intervals) {
    while (first < removed.size() && removed[first].end < left.begin) ++first;
    bool is_gone = false;
    for (std::size_t i = first; i < removed.size() && removed[i].begin <= left.end; ++i) {
      if (left.begin < removed[i].begin) result.push_back({left.begin, removed[i].begin});
      left.begin = std::max(left.begin, removed[i].end);
      is_gone = removed[i].end >= left.end;
      if (is_gone) break;
    }
    if (!is_gone) result.push_back(left);
  }
  return result;
}

}  // namespace vantage::internal::flight
