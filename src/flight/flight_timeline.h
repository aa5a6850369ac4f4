// Lengths and times along a flight.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vantage/flight.h"
#include "vantage/flight_check.h"

namespace vantage::internal::flight {

/// A part of a flight: from a share of a leg to a share of the same or a later one.
struct Stretch {
  std::size_t begin_leg = 0;
  double begin_share = 0;
  std::size_t end_leg = 0;
  double end_share = 0;
};

/// Where along a flight, and when. The flight must outlive it.
class FlightTimeline {
 public:
  /// `speed_m_s`: of legs whose points state none; NaN: their times are not known, nor those that follow.
  FlightTimeline(const Flight& flight, double speed_m_s);

  const std::vector<double>& point_at_m() const { return at_m_; }
  const std::vector<double>& arrival_s() const { return arrival_s_; }
  const std::vector<double>& departure_s() const { return departure_s_; }
  double length_m() const { return at_m_.back(); }
  /// With the stay at the last point; NaN where a speed is missing.
  double duration_s() const { return departure_s_.back(); }
  bool has_legs() const { return !speed_m_s_.empty(); }
  double speed_m_s(std::size_t leg) const { return speed_m_s_[leg]; }

  Vec3 position(std::size_t leg, double share) const;
  double at_m(std::size_t leg, double share) const;
  /// With the stay at a point where it begins or ends there.
  FlightSpan span(const Stretch& stretch) const;

 private:
  const Flight& flight_;
  std::vector<double> at_m_, arrival_s_, departure_s_, speed_m_s_;
};

/// Appends intervals of a leg, later than all before, to stretches: what meets where two legs do is joined.
void append(std::vector<Stretch>& stretches, std::size_t leg, std::span<const LegInterval> intervals);

std::vector<FlightSpan> spans_of(const FlightTimeline& along, const std::vector<Stretch>& stretches);

/// What is left of sorted, disjoint intervals. What only touches `removed` at an end stays.
std::vector<LegInterval> without(std::span<const LegInterval> intervals, std::span<const LegInterval> removed);

/// What is in both; both sorted and disjoint. Single shares that are in both stay.
std::vector<LegInterval> in_both(std::span<const LegInterval> a, std::span<const LegInterval> b);

/// What all are in: sorted and disjoint again.
std::vector<LegInterval> united(std::vector<LegInterval> intervals);

}  // namespace vantage::internal::flight
