// LegLimits: each limit by itself along a leg.
#include "query/leg_limits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "query/leg_check.h"
#include "query/leg_limit.h"

namespace vantage {
namespace internal::query {
namespace {

/// The place of an interval where a function is largest, among 17 and about the best of these.
double greatest_place(const LegInterval& interval, const Amount& amount) {
  constexpr int kPlaces = 16;
  const double step = (interval.end - interval.begin) / kPlaces;
  const auto place = [&](double i) { return std::min(interval.end, interval.begin + i * step); };
  int best = 0;
  double most = -INFINITY;
  for (int i = 0; i <= kPlaces; ++i) {
    if (const double value = amount(place(i)); value > most) {
      most = value;
      best = i;
    }
  }
  const double low = std::max(0, best - 1), high = std::min(kPlaces, best + 1);
  constexpr double kGolden = 0.6180339887498949;
  double begin = low, end = high, result = place(best);
  for (int i = 0; i < 24 && step > 0; ++i) {
    const double a = end - kGolden * (end - begin), b = begin + kGolden * (end - begin);
    const double at_a = amount(place(a)), at_b = amount(place(b));
    if (std::max(at_a, at_b) > most) {
      most = std::max(at_a, at_b);
      result = place(at_a >= at_b ? a : b);
    }
    (at_a >= at_b ? end : begin) = at_a >= at_b ? b : a;
  }
  return result;
}

}  // namespace

Box Tube::box() const {
  Box box;
  box.extend(leg.from);
  box.extend(leg.to);
  box.min.array() -= radius;
  box.max.array() += radius;
  return box;
}

void add_break(std::vector<LegBreak>& breaks, const std::string& limit, LegBreak::Unit unit, LegIntervals intervals,
               const Amount& amount) {
  if (intervals.empty()) return;
  LegBreak result{limit, std::move(intervals), -INFINITY, unit, 0};
  for (const LegInterval& interval : result.intervals) {
    const double place = greatest_place(interval, amount);
    if (const double value = amount(place); value > result.worst) {
      result.worst = value;
      result.worst_share = place;
    }
  }
  result.worst = std::max(0.0, result.worst);
  breaks.push_back(std::move(result));
}

}  // namespace internal::query

namespace query = internal::query;

struct LegLimits::Data {
  explicit Data(const Navigation& navigation) {
    query::LegGroundPool grounds;
    each_limit(navigation, [&](auto limit, const auto& value) {
      limits.push_back(query::leg_limit<decltype(limit)::value>(value, grounds));
    });
  }

  Data(const PreparedTarget& target, const Navigation& navigation) : Data(navigation) {
    const auto view = std::make_shared<const internal::sensor::SensorView>(
        internal::sensor::SensorView{target.sensor(), internal::sensor::viewed_of(target)});
    each_limit(view->sensor, [&](auto limit, const auto& value) {
      limits.push_back(query::leg_limit<decltype(limit)::value>(value, view));
    });
  }

  std::vector<LegBreak> broken(const query::Tube& tube) const {
    std::vector<LegBreak> breaks;
    for (const auto& limit : limits) limit->add_breaks(tube, breaks);
    return breaks;
  }

  std::vector<std::unique_ptr<const query::LegLimit>> limits;
};

LegLimits::LegLimits(const Navigation& navigation) {
  check_navigation(navigation);
  data_ = std::make_unique<Data>(navigation);
}
LegLimits::LegLimits(const PreparedTarget& target, const Navigation& navigation) {
  check_navigation(navigation);
  data_ = std::make_unique<Data>(target, navigation);
}
LegLimits::~LegLimits() = default;
LegLimits::LegLimits(LegLimits&&) noexcept = default;
LegLimits& LegLimits::operator=(LegLimits&&) noexcept = default;

std::vector<LegBreak> LegLimits::broken(const Leg& leg, double radius_m, const Progress& progress) const {
  query::check_leg(leg, radius_m);
  return data_->broken({leg, radius_m, internal::core::ProgressReporter(progress, "leg")});
}

std::vector<std::vector<LegBreak>> LegLimits::broken(std::span<const Leg> legs, double radius_m,
                                                     const Progress& progress) const {
  for (std::size_t i = 0; i < legs.size(); ++i) query::check_leg(legs[i], radius_m, i);
  const internal::core::ProgressReporter reporter(progress, "legs");
  reporter.begin("legs and limits");
  internal::core::ProgressCounter done(reporter, legs.size());
  std::vector<std::vector<LegBreak>> result(legs.size());
  internal::parallel::for_ranges(legs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      result[i] = data_->broken({legs[i], radius_m, reporter});
      done.add();
    }
  });
  reporter.finish();
  return result;
}

std::vector<LegInterval> kept_parts(std::span<const LegBreak> broken) {
  query::LegIntervals all;
  for (const LegBreak& one : broken) all.insert(all.end(), one.intervals.begin(), one.intervals.end());
  return query::rest_of(query::joined(std::move(all)));
}

}  // namespace vantage
