// CZML, Cesium's language of scenes with times: https://github.com/AnalyticalGraphicsInc/czml-writer/wiki/CZML-Guide
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/input.h"
#include "core/format.h"
#include "core/text.h"
#include "flight/plans/plan_writer.h"
#include "vantage/error.h"

namespace vantage::internal::flight::plans {
namespace {

using Czml = nlohmann::ordered_json;

constexpr double kMicrosecondsPerS = 1e6;

// 0 to 255, and opacity: the colours of src/picture/palette.h.
constexpr std::array kUnseen = {128, 128, 134, 150}, kSeen = {213, 94, 0, 220}, kLine = {0, 0, 0, 255};

/// Moments of a flight as ISO 8601, to a microsecond.
class Clock {
 public:
  /// Throws Error(value_out_of_range) where the calendar does not hold all of it.
  Clock(double start_unix_s, double duration_s, const std::string& place) : duration_s_(duration_s) {
    constexpr double kYear1 = -62135596800, kYear10000 = 253402300800;
    if (!(start_unix_s >= kYear1 && start_unix_s + duration_s < kYear10000 - 1)) {
      throw Error(ErrorCode::value_out_of_range, "the flight begins or ends outside of the years 1 to 9999", place,
                  "give another time, and check how long the vehicle stays");
    }
    start_us_ = static_cast<std::int64_t>(std::floor(start_unix_s * kMicrosecondsPerS));
  }

  std::string start() const { return text(0); }
  /// From the next microsecond after one to the last before another: never longer; empty where nothing is left.
  std::string within(double from_s, double to_s) const {
    const double from_us = std::ceil(std::max(from_s, 0.0) * kMicrosecondsPerS),
                 to_us = std::floor(std::min(to_s, duration_s_) * kMicrosecondsPerS);
    return from_us <= to_us ? text(from_us) + "/" + text(to_us) : std::string();
  }
  /// All of the flight: to the next microsecond after its end.
  std::string whole() const { return start() + "/" + text(std::ceil(duration_s_ * kMicrosecondsPerS)); }

 private:
  std::string text(double since_start_us) const {
    const std::chrono::sys_time<std::chrono::microseconds> time(
        std::chrono::microseconds(start_us_ + static_cast<std::int64_t>(since_start_us)));
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss of_day(time - day);
    std::string text = core::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                                    static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                                    of_day.hours().count(), of_day.minutes().count(), of_day.seconds().count());
    const auto rest = of_day.subseconds().count();
    if (rest != 0) text += core::format(".{:06}", rest);
    return text + "Z";
  }

  double duration_s_;
  std::int64_t start_us_ = 0;
};

struct Sample {
  double at_s = 0;
  Vec3 position;  ///< scene frame
};

/// Each leg at its speed; the vehicle rests while it holds.
std::vector<Sample> samples_of(const std::vector<OutPoint>& points, const std::string& place) {
  // A straight line through the earth's frame is 200^2 / (8 R) = 0.8 mm below the middle of a level leg.
  constexpr double kLongestM = 200;
  std::vector<Sample> samples;
  const auto add = [&](double at_s, const Vec3& position) {
    if (samples.empty() || at_s > samples.back().at_s) samples.push_back({at_s, position});
  };
  double time_s = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) {
      const Vec3 leg = points[i].position - points[i - 1].position;
      const double length = leg.norm();
      if (length > 0 && !(points[i].speed_m_s > 0)) {
        throw Error(ErrorCode::missing_key, "CZML says when the vehicle is where, and no speed is known",
                    place + ", point " + std::to_string(i + 1), "give the speed of the vehicle");
      }
      const double parts = std::ceil(length / kLongestM), leg_s = length > 0 ? length / points[i].speed_m_s : 0;
      for (double part = 1; part < parts; ++part) {
        add(time_s + leg_s * part / parts, points[i - 1].position + leg * (part / parts));
      }
      time_s += leg_s;
    }
    add(time_s, points[i].position);
    time_s += points[i].hold_s;
    if (points[i].hold_s > 0) add(time_s, points[i].position);
  }
  return samples;
}

class CzmlDocument {
 public:
  CzmlDocument(const PlanWriter& writer, const Clock& clock, std::vector<Sample> samples)
      : writer_(writer), clock_(clock), samples_(std::move(samples)), whole_(clock.whole()) {}

  Czml json() const {
    Czml packets = Czml::array();
    packets.push_back({{"id", "document"},
                       {"name", printable(writer_.flight().name)},
                       {"version", "1.0"},
                       {"clock",
                        {{"interval", whole_},
                         {"currentTime", clock_.start()},
                         {"multiplier", 1},
                         {"range", "LOOP_STOP"},
                         {"step", "SYSTEM_CLOCK_MULTIPLIER"}}}});
    packets.push_back(vehicle());
    const std::vector<SeenTarget>& targets = writer_.flight().targets;
    for (std::size_t i = 0; i < targets.size(); ++i) add_target(targets[i], i, packets);
    return packets;
  }

 private:
  void append_position(const Vec3& position, Czml& numbers) const {
    const Eigen::Vector2d at = writer_.lonlat(position);
    numbers.push_back(at.x());
    numbers.push_back(at.y());
    numbers.push_back(writer_.height(position));
  }

  Czml vehicle() const {
    Czml positions = Czml::array();
    for (const Sample& sample : samples_) {
      positions.push_back(sample.at_s);
      append_position(sample.position, positions);
    }
    return {{"id", "vehicle"},
            {"name", printable(writer_.flight().name)},
            {"description",
             "Longitude and latitude: WGS 84. Heights: metres above its ellipsoid. Each leg is flown at its speed, "
             "without speeding up and braking."},
            {"availability", whole_},
            {"position",
             {{"epoch", clock_.start()},
              {"interpolationAlgorithm", "LINEAR"},
              {"interpolationDegree", 1},
              {"cartographicDegrees", std::move(positions)}}},
            {"point",
             {{"pixelSize", 12},
              {"color", {{"rgba", kSeen}}},
              {"outlineColor", {{"rgba", {255, 255, 255, 255}}}},
              {"outlineWidth", 2}}},
            {"path", {{"width", 3}, {"material", {{"solidColor", {{"color", {{"rgba", kLine}}}}}}}}}};
  }

  /// All of the flight, and on top of it, as later intervals are, when the target is seen.
  Czml by_view(const SeenTarget& target, const char* type, const Czml& unseen, const Czml& seen) const {
    Czml intervals = Czml::array();
    intervals.push_back({{"interval", whole_}, {type, unseen}});
    for (const auto& [from_s, to_s] : target.seen_s) {
      const std::string interval = clock_.within(from_s, to_s);
      if (!interval.empty()) intervals.push_back({{"interval", interval}, {type, seen}});
    }
    return intervals;
  }

  Czml colour(const SeenTarget& target) const { return by_view(target, "rgba", Czml(kUnseen), Czml(kSeen)); }

  /// A packet for each part; the first one has the target's name and when it is seen.
  void add_target(const SeenTarget& target, std::size_t number, Czml& packets) const {
    const std::string id = "target " + std::to_string(number + 1);
    Czml first = {{"id", id},
                  {"name", printable(target.name)},
                  {"availability", whole_},
                  {"properties", {{"seen", by_view(target, "boolean", false, true)}}}};
    for (std::size_t part = 0; part < target.parts.size(); ++part) {
      Czml packet = part == 0 ? first
                              : Czml{{"id", id + ", part " + std::to_string(part + 1)},
                                     {"name", printable(target.name)},
                                     {"parent", id},
                                     {"availability", whole_}};
      add_shape(target, target.parts[part], packet);
      packets.push_back(std::move(packet));
    }
    if (target.parts.empty()) packets.push_back(std::move(first));
  }

  void add_shape(const SeenTarget& target, const std::vector<Vec3>& corners, Czml& packet) const {
    Czml positions = Czml::array();
    for (const Vec3& corner : corners) append_position(corner, positions);
    if (corners.size() == 1) {
      packet["position"] = {{"cartographicDegrees", std::move(positions)}};
      packet["point"] = {{"pixelSize", 10}, {"color", colour(target)}};
      return;
    }
    Czml line = positions;
    if (!corners.empty()) append_position(corners.front(), line);
    packet["polyline"] = {{"positions", {{"cartographicDegrees", std::move(line)}}},
                          {"arcType", "NONE"},
                          {"width", 2},
                          {"material", {{"solidColor", {{"color", colour(target)}}}}}};
    if (is_upright(corners)) return;
    packet["polygon"] = {{"positions", {{"cartographicDegrees", std::move(positions)}}},
                         {"arcType", "GEODESIC"},
                         {"perPositionHeight", true},
                         {"material", {{"solidColor", {{"color", colour(target)}}}}}};
  }

  /// Cesium fills polygons as seen from above: of a wall there is the outline alone.
  static bool is_upright(const std::vector<Vec3>& corners) {
    Vec3 normal = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    }
    constexpr double kLeastSine = 0.02;
    return std::abs(normal.z()) <= kLeastSine * normal.norm();
  }

  const PlanWriter& writer_;
  const Clock& clock_;
  std::vector<Sample> samples_;
  std::string whole_;
};

}  // namespace

std::string write_czml(const FlightOut& flight) {
  const PlanWriter writer(flight, PlanFormat::czml, {HeightDatum::ellipsoid});
  std::vector<Sample> samples = samples_of(writer.points(), writer.place());
  const Clock clock(flight.start_unix_s, samples.back().at_s, writer.place());
  const Czml json = CzmlDocument(writer, clock, std::move(samples)).json();
  return core::escaped_json(json.dump(1, ' ', false, Czml::error_handler_t::replace)) + "\n";
}

}  // namespace vantage::internal::flight::plans
