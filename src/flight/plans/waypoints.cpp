// Tables of waypoints: https://mavlink.io/en/file_formats/, "Plain-Text File Format". A header, then a row for each
// item: number, whether it is the current one, frame, command, seven parameters, whether to go on by itself.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/input.h"
#include "flight/plans/mission_items.h"
#include "flight/plans/text_lines.h"

namespace vantage::internal::flight::plans {
namespace {

constexpr std::size_t kWaypointColumns = 12;

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kSeparators = " \t";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kSeparators); at != std::string_view::npos;
       at = line.find_first_not_of(kSeparators, at)) {
    const std::size_t end = line.find_first_of(kSeparators, at);
    words.push_back(line.substr(at, end - at));
    if (end == std::string_view::npos) break;
    at = end;
  }
  return words;
}

class WaypointTable {
 public:
  explicit WaypointTable(const PlanSource& source) : source_(source) {}

  FlightPlan read() {
    FlightPlan plan;
    plan.format = PlanFormat::waypoints;
    plan.file = source_.name;
    TextLines lines(source_.text);
    std::string_view line;
    lines.next(line);
    if (without_blanks(line) != "QGC WPL 110") {
      source_.fail(ErrorCode::value_unsupported, "line 1",
                   "the table is of another version than 110: " + in_quotes(line),
                   "save it anew with the ground station");
    }
    while (lines.next(line)) {
      source_.progress.tick();
      line = without_blanks(line);
      if (!line.empty() && line.front() != '#') add(line, lines.number());
    }
    check_numbers();
    take_home(plan);
    run_mission(items_, source_, Autopilot::unknown, plan);
    check_plan(plan, source_);
    return plan;
  }

 private:
  void add(std::string_view line, std::size_t number) {
    const std::vector<std::string_view> words = words_of(line);
    const std::string where = source_.place("line " + std::to_string(number));
    if (words.size() != kWaypointColumns) {
      PlanSource::fail_at(ErrorCode::plan_syntax, where,
                          "the row has " + std::to_string(words.size()) + " columns instead of 12",
                          "save the plan anew with the ground station");
    }
    check_count(items_.size() + 1, source_);
    MissionItem& item = items_.emplace_back();
    item.id = integer(words[0], where);
    item.place = source_.place("line " + std::to_string(number) + ", item " + std::to_string(item.id));
    item.frame = integer(words[2], where);
    item.command = integer(words[3], where);
    for (std::size_t i = 0; i < 7; ++i) {
      const ParsedNumber value = parse_number(words[4 + i]);
      const bool may_be_absent = i < 4 && value.fault == NumberFault::not_finite;
      if (value.fault != NumberFault::none && !may_be_absent) {
        PlanSource::fail_at(ErrorCode::not_a_number, item.place, "a value is not a number: " + in_quotes(words[4 + i]),
                            number_advice(words[4 + i], value.fault));
      }
      item.parameters[i] = may_be_absent ? std::nan("") : value.value;
    }
    item.goes_on = integer(words[11], item.place) != 0;
  }

  /// Jumps name rows; some autopilots take the numbers that rows have, and others count.
  void check_numbers() const {
    for (std::size_t i = 0; i < items_.size(); ++i) {
      if (items_[i].id == static_cast<long long>(i)) continue;
      const bool jumps =
          std::any_of(items_.begin(), items_.end(), [](const MissionItem& item) { return item.command == kDoJump; });
      if (!jumps) return;
      PlanSource::fail_at(ErrorCode::plan_syntax, items_[i].place,
                          "the table has a jump, and its rows are not numbered from 0 on, one after the other",
                          "save it anew with the ground station");
    }
  }

  static int integer(std::string_view word, const std::string& where) {
    const ParsedNumber value = parse_number(word);
    if (value.fault == NumberFault::none && std::abs(value.value) < 1e6 && value.value == std::floor(value.value)) {
      return static_cast<int>(value.value);
    }
    PlanSource::fail_at(ErrorCode::plan_syntax, where, "a value is not an integer: " + in_quotes(word), "correct it");
  }

  /// The first row is the home: a waypoint above sea level before all others, as Mission Planner and ArduPilot have it.
  /// PX4's tables may begin with a waypoint instead: the note says what was taken. Of another row that is not known.
  void take_home(FlightPlan& plan) {
    if (items_.size() < 2) return;
    const MissionItem& first = items_.front();
    if (first.id != 0 || first.command != kNavWaypoint || first.frame != kGlobal) {
      plan.not_judged.push_back(first.place +
                                ": some autopilots take the first row for the home, and others fly it: let the table "
                                "begin with a row 0 for the home, a waypoint (16) above sea level (frame 0)");
      return;
    }
    const PlanPosition home = position_of(first);
    if (home.horizontal.allFinite()) plan.home = home;
    plan.notes.push_back({WarningCode::plan_assumed,
                          source_.name + ": the first row, a waypoint above sea level, is taken as the home"});
    items_.erase(items_.begin());
  }

  const PlanSource& source_;
  std::vector<MissionItem> items_;
};

}  // namespace

FlightPlan read_waypoints(const PlanSource& source) { return WaypointTable(source).read(); }

}  // namespace vantage::internal::flight::plans
