// Tables with a header: longitude, latitude and a height whose name says what it is measured from, or x, y and z of the
// scene. Also those of Litchi, whose heights are above the home or, with altitudemode 1, above ground.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/input.h"
#include "common/table_columns.h"
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
      take_command(titles[i], i);
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
    bool is_circle;  ///< how it circles there, or else a command, by its name or as MAV_CMD
  };

  void take_command(std::string_view title, std::size_t index) {
    std::string name;
    for (const char c : title.substr(0, title.find('('))) {
      if (std::isalnum(static_cast<unsigned char>(c))) {
        name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      }
    }
    for (const std::string_view start : {"loiter", "orbit", "turns"}) {
      if (name.substr(0, start.size()) == start) commands_.push_back({index, true});
    }
    if (name == "command" || name == "cmd" || name == "mavcmd") commands_.push_back({index, false});
  }

  void name_commands(const std::vector<std::string>& fields, const std::string& where, NotJudged& not_judged) const {
    for (const auto& [index, is_circle] : commands_) {
      std::string name = fields[index];
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      const ParsedNumber number = parse_number(name);
      const bool is_none = name.empty() || (number.fault == NumberFault::none && number.value == 0);
      const bool is_waypoint = !is_circle && (name == "16" || name == "waypoint" || name == "nav_waypoint" ||
                                              name == "mav_cmd_nav_waypoint");
      if (is_none || is_waypoint) continue;
      not_judged.name(where, "its column " + std::to_string(index + 1) + " says " + in_quotes(fields[index]) +
                                 ", which is not followed: of a table the positions are flown to");
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
  std::optional<UsedColumn> height_;
  bool is_in_scene_frame_ = false;
};

}  // namespace

FlightPlan read_csv(const PlanSource& source) { return PlanTable(source).read(); }

}  // namespace vantage::internal::flight::plans
