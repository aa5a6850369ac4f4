// Tables with a header: longitude, latitude and a height whose name says what it is measured from, or x, y and z of the
// scene. Also those of Litchi, whose heights are above the home or, with altitudemode 1, above ground.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/input.h"
#include "common/table_columns.h"
#include "core/format.h"
#include "flight/plans/mission_items.h"
#include "flight/plans/plan_source.h"
#include "flight/plans/text_lines.h"

namespace vantage::internal::flight::plans {
namespace {

/// A column that is used.
struct UsedColumn {
  std::size_t index;
  KnownColumn known;
};

/// Fields of a line; in one that begins with a quote there may be separators, and a quote that is written twice. Other
/// quotes are seconds of arc.
std::vector<std::string> fields_of(std::string_view line, char separator) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"' && (is_quoted || without_blanks(fields.back()).empty())) {
      is_quoted = !is_quoted;
    } else if (c == separator && !is_quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  for (std::string& field : fields) field = without_blanks(field);
  return fields;
}

/// Of its letters and digits, in lower case.
std::string plain(std::string_view text) {
  std::string letters;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c))) {
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return letters;
}

/// In lower case: "wpType" and "WP type" are "wp" and "type".
std::vector<std::string> words_of(std::string_view title) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < title.size(); ++i) {
    const auto is = [&](std::size_t at, int (*kind)(int)) { return kind(static_cast<unsigned char>(title[at])) != 0; };
    const bool begins = !is(i, std::isalnum) || (i > 0 && is(i, std::isupper) && is(i - 1, std::islower));
    if (begins && !words.back().empty()) words.emplace_back();
    words.back() += plain(title.substr(i, 1));
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

template <std::size_t N>
bool begins_with_one(std::string_view word, const std::array<std::string_view, N>& starts) {
  return std::any_of(starts.begin(), starts.end(), [&](std::string_view start) { return word.starts_with(start); });
}

template <std::size_t N>
bool is_in(std::string_view word, const std::array<std::string_view, N>& list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// The name of a command that moves the vehicle in another way than straight to the position. `name` is plain.
bool is_movement(std::string_view name) {
  constexpr std::array<std::string_view, 18> kNames = {
      "rtl",      "rth",     "gohome",      "return", "returnhome", "land",  "landing", "landstart", "autoland",
      "vtolland", "takeoff", "vtoltakeoff", "spline", "arc",        "curve", "curved",  "jump",      "reposition"};
  constexpr std::array<std::string_view, 6> kStarts = {"loiter", "orbit", "circle", "spline", "returnto", "follow"};
  return is_in(name, kNames) || begins_with_one(name, kStarts);
}

/// What a column tells the vehicle, by its title.
enum class Tells {
  nothing,   ///< it is for people
  circle,    ///< how it circles
  movement,  ///< whether it moves so: "rtl"
  command,   ///< by its name, or as MAV_CMD
  manner,    ///< a command, or something else: "type"
  radius,    ///< of a circle, or of acceptance
  unknown,
};

Tells told_in(std::string_view title) {
  title = title.substr(0, title.find_first_of("(["));
  const std::string name = plain(title);
  constexpr std::array<std::string_view, 4> kCircle = {"loiter", "orbit", "turns", "circle"};
  if (begins_with_one(name, kCircle)) return Tells::circle;
  if (is_movement(name) || (name.starts_with("is") && is_movement(name.substr(2)))) return Tells::movement;
  constexpr std::array<std::string_view, 4> kCommand = {"command", "commands", "cmd", "mavcmd"};
  constexpr std::array<std::string_view, 12> kManner = {"type",      "mode",     "action",    "actions",
                                                        "task",      "tasks",    "nav",       "do",
                                                        "manoeuvre", "maneuver", "behaviour", "behavior"};
  constexpr std::array<std::string_view, 13> kBeside = {
      "mav", "mavlink", "mission", "item", "wp", "waypoint", "point", "turn", "id", "name", "code", "number", "no"};
  constexpr std::array<std::string_view, 1> kRadius = {"radius"};
  constexpr std::array<std::string_view, 17> kForPeople = {
      "name",        "names", "note",  "notes", "comment", "comments", "remark", "remarks", "label",
      "description", "desc",  "title", "text",  "id",      "message",  "state",  "status"};
  const std::vector<std::string> words = words_of(title);
  const auto any = [&](const auto& list) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return is_in(word, list); });
  };
  const bool is_of_commands = std::all_of(words.begin(), words.end(), [&](const std::string& word) {
    return is_in(word, kCommand) || is_in(word, kManner) || is_in(word, kBeside) || is_in(word, kRadius);
  });
  if (is_of_commands && any(kCommand)) return Tells::command;
  if (is_of_commands && any(kRadius)) return Tells::radius;
  if (is_of_commands && any(kManner)) return Tells::manner;
  return any(kForPeople) ? Tells::nothing : Tells::unknown;
}

enum class Told { nothing, movement, unclear };

Told told_by(Tells tells, std::string_view field) {
  std::string name = plain(field);
  const ParsedNumber number = parse_number(field);
  const bool is_number = number.fault == NumberFault::none;
  constexpr std::array<std::string_view, 8> kNone = {"", "none", "no", "false", "off", "na", "nan", "null"};
  if (is_in(name, kNone) || (is_number && number.value == 0)) return Told::nothing;
  if (tells == Tells::circle) return Told::movement;
  if (tells == Tells::radius) return Told::unclear;
  const bool is_of_mavlink = name.starts_with("mavcmd");
  for (const std::string_view start : {"mavcmd", "nav", "do"}) {
    if (name.starts_with(start) && name.size() > start.size()) name.erase(0, start.size());
  }
  if (tells == Tells::movement) {
    constexpr std::array<std::string_view, 5> kYes = {"yes", "true", "on", "y", "x"};
    return is_number || is_in(name, kYes) || is_movement(name) ? Told::movement : Told::unclear;
  }
  constexpr std::array<std::string_view, 4> kStraight = {"waypoint", "wp", "straight", "flyto"};
  if (is_in(name, kStraight) || (tells != Tells::unknown && is_number && number.value == double{kNavWaypoint})) {
    return Told::nothing;
  }
  if (tells == Tells::command) return Told::movement;
  if (tells == Tells::manner) {
    const bool is_command = is_number && number.value == std::floor(number.value) && std::abs(number.value) < 1e6 &&
                            is_of_movement(static_cast<int>(number.value));
    return is_command || is_movement(name) ? Told::movement : Told::unclear;
  }
  // Of any other column what can mean nothing else.
  const bool is_sure = name == "rtl" || name == "rth" || name.starts_with("loiter") || name.starts_with("returnto");
  return is_sure || is_of_mavlink ? Told::movement : Told::nothing;
}

class PlanTable {
 public:
  explicit PlanTable(const PlanSource& source) : source_(source) {}

  FlightPlan read() {
    FlightPlan plan;
    plan.format = PlanFormat::csv;
    plan.file = source_.name;
    TextLines lines(source_.text);
    std::string_view line;
    do {
      if (!lines.next(line)) fail_header("the table has no header");
    } while (without_blanks(line).empty() || line.front() == '#');
    read_header(line, lines.place(), plan);
    plan.is_in_scene_frame = is_in_scene_frame_;
    NotJudged not_judged(source_.name, plan.not_judged);
    while (lines.next(line)) {
      source_.progress.tick();
      if (without_blanks(line).empty() || line.front() == '#') continue;
      std::vector<std::string> fields = fields_of(line, separator_);
      while (fields.size() > columns_ && fields.back().empty()) fields.pop_back();
      const std::string where = source_.place(lines.place());
      if (fields.size() != columns_) {
        PlanSource::fail_at(
            ErrorCode::plan_syntax, where,
            "the row has " + std::to_string(fields.size()) + " fields, and the header " + std::to_string(columns_),
            "write numbers with a decimal point, or separate fields by semicolons; a field may be empty");
      }
      add(fields, where, plan);
      name_commands(fields, where, not_judged);
      check_count(plan.items.size(), source_);
    }
    note_unclear(plan);
    check_plan(plan, source_);
    return plan;
  }

 private:
  [[noreturn]] void fail_header(const std::string& problem, const std::string& place = "line 1") const {
    source_.fail(ErrorCode::plan_syntax, place, problem,
                 "name the columns in the first line: longitude, latitude and height_amsl_m (or height_ellipsoid_m, "
                 "height_agl_m, height_home_m), or x, y and z");
  }

  void read_header(std::string_view line, const std::string& place, FlightPlan& plan) {
    const auto count = [&](char c) { return std::count(line.begin(), line.end(), c); };
    separator_ = count(';') > 0 ? ';' : count('\t') > 0 ? '\t' : ',';
    numbers_ = TableNumbers(separator_);
    const std::vector<std::string> titles = fields_of(line, separator_);
    columns_ = titles.size();
    for (std::size_t i = 0; i < titles.size(); ++i) {
      bool has_unknown_unit = false;
      const std::optional<KnownColumn> known = known_column(titles[i], &has_unknown_unit);
      if (known) uses_.push_back({i, *known});
      const Tells tells = known ? Tells::nothing : told_in(titles[i]);
      if (tells != Tells::nothing) commands_.push_back({i, tells});
      if (has_unknown_unit) {
        plan.notes.push_back({WarningCode::plan_left_out, source_.name + ": the column " + in_quotes(titles[i]) +
                                                              " is left out: its unit is not known"});
      }
      if (known && std::find(titles.begin(), titles.begin() + static_cast<std::ptrdiff_t>(i), titles[i]) !=
                       titles.begin() + static_cast<std::ptrdiff_t>(i)) {
        fail_header("two columns are called " + in_quotes(titles[i]), place);
      }
    }
    check_only_one(titles, place);
    check_z(titles, place);
    const bool is_geographic = find(TableColumn::longitude) && find(TableColumn::latitude);
    is_in_scene_frame_ = !is_geographic;
    if (!is_geographic && !(find(TableColumn::x) && find(TableColumn::y) && find(TableColumn::z))) {
      fail_header("the table has no longitude and latitude, and no x, y and z: " + in_quotes(line), place);
    }
    if (is_geographic) choose_height(titles, plan);
    const bool is_litchi = std::any_of(uses_.begin(), uses_.end(), [](const UsedColumn& use) {
      return use.known.name == "curvesize" || use.known.name == "altitudemode";
    });
    if (is_litchi && height_ && height_->known.datum == HeightDatum::unknown) height_->known.datum = HeightDatum::home;
  }

  /// Which of two is meant, nobody knows. Of heights there may be several.
  void check_only_one(const std::vector<std::string>& titles, const std::string& place) const {
    for (const UsedColumn& use : uses_) {
      const std::size_t first = find(use.known.column)->index;
      if (use.known.column == TableColumn::height || use.index == first) continue;
      source_.fail(
          ErrorCode::conflicting_keys, place,
          "the columns " + in_quotes(titles[first]) + " and " + in_quotes(titles[use.index]) + " mean the same",
          "leave one of them out, or give another name to it");
    }
  }

  /// Of places on the earth with a height and a z alone nobody knows which of the two is meant. What vantage writes has
  /// x, y and z besides.
  void check_z(const std::vector<std::string>& titles, const std::string& place) const {
    const auto z = find(TableColumn::z), height = find(TableColumn::height);
    if (!z || !height || !find(TableColumn::longitude) || (find(TableColumn::x) && find(TableColumn::y))) return;
    source_.fail(ErrorCode::conflicting_keys, place,
                 "the columns " + in_quotes(titles[height->index]) + " and " + in_quotes(titles[z->index]) +
                     " both say how high it is",
                 "leave one of them out, or give another name to it");
  }

  /// A column that may tell the vehicle to do something else than to fly to the position.
  struct Command {
    std::size_t index;
    Tells tells;
  };

  void name_commands(const std::vector<std::string>& fields, const std::string& where, NotJudged& not_judged) {
    for (const auto& [index, tells] : commands_) {
      const Told told = told_by(tells, fields[index]);
      if (told == Told::nothing) continue;
      const std::string says = core::format("its column {} says {}", index + 1, in_quotes(fields[index]));
      if (told == Told::movement) {
        not_judged.name(where, says + ", which is not followed: of a table the positions are flown to");
      } else {
        unclear_.emplace(index, core::format("{}: {}", where, says));
      }
    }
  }

  void note_unclear(FlightPlan& plan) const {
    for (const auto& [index, first] : unclear_) {
      plan.notes.push_back({WarningCode::plan_left_out,
                            first + ": what that tells the vehicle is not known here, and is left out of all rows"});
    }
  }

  /// If there are several heights, the first whose level is known.
  void choose_height(const std::vector<std::string>& titles, FlightPlan& plan) {
    std::string names;
    std::size_t heights = 0;
    for (const UsedColumn& use : uses_) {
      if (use.known.column != TableColumn::height) continue;
      ++heights;
      names.append(names.empty() ? "" : ", ").append(in_quotes(titles[use.index]));
      if (!height_ || (height_->known.datum == HeightDatum::unknown && use.known.datum != HeightDatum::unknown)) {
        height_ = use;
      }
    }
    if (heights > 1) {
      plan.notes.push_back({WarningCode::plan_assumed, source_.name + ": it has the heights " + names + ", of which " +
                                                           in_quotes(titles[height_->index]) + " is taken"});
    }
    if (!height_) height_ = find(TableColumn::z);
  }

  std::optional<UsedColumn> find(TableColumn column) const {
    for (const UsedColumn& use : uses_) {
      if (use.known.column == column) return use;
    }
    return std::nullopt;
  }

  /// Not a number where the field is empty or the column is missing.
  double value(const std::optional<UsedColumn>& use, const std::vector<std::string>& fields, const std::string& where) {
    if (!use || use->index >= fields.size() || fields[use->index].empty()) return std::nan("");
    const std::string& field = fields[use->index];
    const ParsedNumber number = numbers_.parse(field, use->known.column);
    if (number.fault == NumberFault::none) return number.value * use->known.factor;
    PlanSource::fail_at(ErrorCode::not_a_number, where + ", column " + std::to_string(use->index + 1),
                        "not a number: " + in_quotes(field), table_advice(field, use->known.column, number.fault));
  }

  void add(const std::vector<std::string>& fields, const std::string& where, FlightPlan& plan) {
    const auto at = [&](TableColumn column) { return value(find(column), fields, where); };
    const auto given = [&](TableColumn column) {
      const double number = at(column);
      return std::isnan(number) ? std::nullopt : std::optional(number);
    };
    PlanItem& item = plan.items.emplace_back();
    item.place = where;
    if (is_in_scene_frame_) {
      item.position = {{at(TableColumn::x), at(TableColumn::y)}, at(TableColumn::z), HeightDatum::scene_z};
      if (!item.position.horizontal.allFinite() || std::isnan(item.position.height_m)) {
        PlanSource::fail_at(ErrorCode::plan_syntax, where, "the row lacks x, y or z", "give all three");
      }
    } else {
      item.position.horizontal = checked_lonlat(at(TableColumn::longitude), at(TableColumn::latitude), where);
      item.position.height_m = value(height_, fields, where);
      item.position.datum = height_ ? height_->known.datum : HeightDatum::unknown;
      set_mode(at(TableColumn::mode), item);
    }
    if (const auto hold = given(TableColumn::hold)) item.hold_s = *hold;
    const double speed = at(TableColumn::speed);
    if (speed != 0) item.speed_m_s = speed;  // of Litchi: 0 is that of the whole mission
    item.yaw_deg = given(TableColumn::yaw);
    item.gimbal_yaw_deg = given(TableColumn::gimbal_yaw);
    item.gimbal_yaw_from_north = true;
    item.gimbal_pitch_deg = given(TableColumn::gimbal_pitch);
    if (const auto curve = given(TableColumn::curve)) item.cut_m = *curve;
  }

  /// Of Litchi: 0 is above the home, 1 above ground.
  static void set_mode(double mode, PlanItem& item) {
    if (mode == 1) item.position.datum = HeightDatum::ground;
    if (std::isnan(mode) || mode == 0 || mode == 1) return;
    PlanSource::fail_at(ErrorCode::value_unsupported, item.place,
                        "its altitudemode is " + shortest(mode) + ", and what its height is measured from is not known",
                        "give 0 for a height above the home, or 1 for one above ground");
  }

  const PlanSource& source_;
  char separator_ = ',';
  TableNumbers numbers_;
  std::size_t columns_ = 0;
  std::vector<UsedColumn> uses_;
  std::vector<Command> commands_;
  std::map<std::size_t, std::string> unclear_;  ///< by their column, what the first of its fields says
  std::optional<UsedColumn> height_;
  bool is_in_scene_frame_ = false;
};

}  // namespace

FlightPlan read_csv(const PlanSource& source) { return PlanTable(source).read(); }

}  // namespace vantage::internal::flight::plans
