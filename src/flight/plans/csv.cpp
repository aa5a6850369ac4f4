// Tables with a header: longitude, latitude and a height whose name says what it is measured from, or x, y and z of the
// scene. Also those of Litchi, whose heights are above the home or, with altitudemode 1, above ground.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/input.h"
#include "flight/plans/plan_source.h"
#include "flight/plans/text_lines.h"

namespace vantage::internal::flight::plans {
namespace {

constexpr double kFootM = 0.3048, kKnotMS = 1852.0 / 3600;

enum class Column { longitude, latitude, height, x, y, z, hold, speed, yaw, gimbal_yaw, gimbal_pitch, mode, curve };

struct KnownColumn {
  std::string_view name;  ///< in lower case, words joined by "_", without its unit
  Column column;
  HeightDatum datum = HeightDatum::unknown;
};

constexpr KnownColumn kColumns[] = {
    {"longitude", Column::longitude},
    {"lon", Column::longitude},
    {"lng", Column::longitude},
    {"long", Column::longitude},
    {"latitude", Column::latitude},
    {"lat", Column::latitude},
    {"altitude", Column::height},
    {"alt", Column::height},
    {"height", Column::height},
    {"elevation", Column::height},
    {"ele", Column::height},
    {"altitude_amsl", Column::height, HeightDatum::sea_level},
    {"alt_amsl", Column::height, HeightDatum::sea_level},
    {"height_amsl", Column::height, HeightDatum::sea_level},
    {"amsl", Column::height, HeightDatum::sea_level},
    {"amsl_altitude", Column::height, HeightDatum::sea_level},
    {"msl", Column::height, HeightDatum::sea_level},
    {"alt_msl", Column::height, HeightDatum::sea_level},
    {"altitude_msl", Column::height, HeightDatum::sea_level},
    {"height_msl", Column::height, HeightDatum::sea_level},
    {"height_ellipsoid", Column::height, HeightDatum::ellipsoid},
    {"ellipsoid_height", Column::height, HeightDatum::ellipsoid},
    {"altitude_ellipsoid", Column::height, HeightDatum::ellipsoid},
    {"alt_ellipsoid", Column::height, HeightDatum::ellipsoid},
    {"ellipsoid", Column::height, HeightDatum::ellipsoid},
    {"ellipsoidal_height", Column::height, HeightDatum::ellipsoid},
    {"hae", Column::height, HeightDatum::ellipsoid},
    {"altitude_wgs84", Column::height, HeightDatum::ellipsoid},
    {"alt_wgs84", Column::height, HeightDatum::ellipsoid},
    {"height_wgs84", Column::height, HeightDatum::ellipsoid},
    {"agl", Column::height, HeightDatum::ground},
    {"altitude_agl", Column::height, HeightDatum::ground},
    {"alt_agl", Column::height, HeightDatum::ground},
    {"height_agl", Column::height, HeightDatum::ground},
    {"height_above_ground", Column::height, HeightDatum::ground},
    {"height_home", Column::height, HeightDatum::home},
    {"height_above_home", Column::height, HeightDatum::home},
    {"height_above_takeoff", Column::height, HeightDatum::home},
    {"altitude_home", Column::height, HeightDatum::home},
    {"alt_home", Column::height, HeightDatum::home},
    {"altitude_relative", Column::height, HeightDatum::home},
    {"alt_relative", Column::height, HeightDatum::home},
    {"alt_rel", Column::height, HeightDatum::home},
    {"relative_altitude", Column::height, HeightDatum::home},
    {"rel_alt", Column::height, HeightDatum::home},
    {"x", Column::x},
    {"y", Column::y},
    {"z", Column::z},
    {"hold", Column::hold},
    {"speed", Column::speed},
    {"yaw", Column::yaw},
    {"heading", Column::yaw},
    {"gimbal_yaw", Column::gimbal_yaw},
    {"gimbal_pitch", Column::gimbal_pitch},
    {"gimbalpitchangle", Column::gimbal_pitch},
    {"altitudemode", Column::mode},
    {"curvesize", Column::curve},
};

enum class Measure { none, length, angle, time, speed };

Measure measure_of(Column column) {
  switch (column) {
    case Column::height:
    case Column::x:
    case Column::y:
    case Column::z:
    case Column::curve:
      return Measure::length;
    case Column::longitude:
    case Column::latitude:
    case Column::yaw:
    case Column::gimbal_yaw:
    case Column::gimbal_pitch:
      return Measure::angle;
    case Column::hold:
      return Measure::time;
    case Column::speed:
      return Measure::speed;
    case Column::mode:
      break;
  }
  return Measure::none;
}

struct Unit {
  std::string_view name;
  Measure measure;
  double factor;
};
// Those that end with another one's name come before it.
constexpr std::array kUnits = {Unit{"metres", Measure::length, 1},
                               Unit{"meters", Measure::length, 1},
                               Unit{"feet", Measure::length, kFootM},
                               Unit{"ft", Measure::length, kFootM},
                               Unit{"degrees", Measure::angle, 1},
                               Unit{"deg", Measure::angle, 1},
                               Unit{"m/s", Measure::speed, 1},
                               Unit{"m_s", Measure::speed, 1},
                               Unit{"km/h", Measure::speed, 1 / 3.6},
                               Unit{"kmh", Measure::speed, 1 / 3.6},
                               Unit{"knots", Measure::speed, kKnotMS},
                               Unit{"kn", Measure::speed, kKnotMS},
                               Unit{"mph", Measure::speed, 1609.344 / 3600},
                               Unit{"min", Measure::time, 60},
                               Unit{"s", Measure::time, 1},
                               Unit{"m", Measure::length, 1}};

/// A column that is used.
struct UsedColumn {
  std::size_t index;
  KnownColumn known;
  double factor;
};

/// What a title says.
struct Title {
  std::optional<UsedColumn> use;
  bool has_unknown_unit = false;  ///< it is the name of a known column, and something behind it
};

/// Fields of a line; in quotes there may be separators, and a quote that is written twice.
std::vector<std::string> fields_of(std::string_view line, char separator) {
  std::vector<std::string> fields(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"') {
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

std::optional<KnownColumn> known_column(std::string_view word) {
  while (!word.empty() && word.back() == '_') word.remove_suffix(1);
  for (const KnownColumn& column : kColumns) {
    if (column.name == word) return column;
  }
  return std::nullopt;
}

/// "Altitude (m)", "altitude_m", "altitude(m)" are "altitude" and "m".
Title read_title(std::string_view title, std::size_t index) {
  std::string name;
  for (const char c : title)
    name += c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (const auto whole = known_column(name)) return {UsedColumn{index, *whole, 1}};
  for (const Unit& unit : kUnits) {
    for (const std::string& end :
         {"(" + std::string(unit.name) + ")", "[" + std::string(unit.name) + "]", "_" + std::string(unit.name)}) {
      const bool ends_so = name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
      if (!ends_so) continue;
      const auto column = known_column(std::string_view{name}.substr(0, name.size() - end.size()));
      if (column && measure_of(column->column) == unit.measure) return {UsedColumn{index, *column, unit.factor}};
    }
  }
  const std::size_t last = name.find_last_of("_([");
  return {std::nullopt, last != std::string::npos && known_column(std::string_view{name}.substr(0, last)).has_value()};
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
            "write numbers with a decimal point, and a field for each column, which may be empty");
      }
      add(fields, where, plan);
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
    const std::vector<std::string> titles = fields_of(line, separator_);
    columns_ = titles.size();
    for (std::size_t i = 0; i < titles.size(); ++i) {
      const Title title = read_title(titles[i], i);
      if (title.use) uses_.push_back(*title.use);
      if (title.has_unknown_unit) {
        plan.notes.push_back({WarningCode::plan_left_out, source_.name + ": the column " + in_quotes(titles[i]) +
                                                              " is left out: its unit is not known"});
      }
      if (title.use && std::find(titles.begin(), titles.begin() + static_cast<std::ptrdiff_t>(i), titles[i]) !=
                           titles.begin() + static_cast<std::ptrdiff_t>(i)) {
        fail_header("two columns are called " + in_quotes(titles[i]), place);
      }
    }
    const bool is_geographic = find(Column::longitude) && find(Column::latitude);
    is_in_scene_frame_ = !is_geographic;
    if (!is_geographic && !(find(Column::x) && find(Column::y) && find(Column::z))) {
      fail_header("the table has no longitude and latitude, and no x, y and z: " + in_quotes(line), place);
    }
    // If there are several heights, the first whose level is known.
    for (const UsedColumn& use : uses_) {
      if (use.known.column != Column::height) continue;
      if (!height_ || (height_->known.datum == HeightDatum::unknown && use.known.datum != HeightDatum::unknown)) {
        height_ = use;
      }
    }
    if (is_geographic && !height_) height_ = find(Column::z);
    const bool is_litchi = std::any_of(uses_.begin(), uses_.end(), [](const UsedColumn& use) {
      return use.known.name == "curvesize" || use.known.name == "altitudemode";
    });
    if (is_litchi && height_ && height_->known.datum == HeightDatum::unknown) height_->known.datum = HeightDatum::home;
  }

  std::optional<UsedColumn> find(Column column) const {
    for (const UsedColumn& use : uses_) {
      if (use.known.column == column) return use;
    }
    return std::nullopt;
  }

  /// Not a number where the field is empty or the column is missing.
  static double value(const std::optional<UsedColumn>& use, const std::vector<std::string>& fields,
                      const std::string& where) {
    if (!use || use->index >= fields.size() || fields[use->index].empty()) return std::nan("");
    const std::string& field = fields[use->index];
    const ParsedNumber number = parse_number(field);
    if (number.fault == NumberFault::none) return number.value * use->factor;
    PlanSource::fail_at(ErrorCode::not_a_number, where + ", column " + std::to_string(use->index + 1),
                        "not a number: " + in_quotes(field), number_advice(field, number.fault));
  }

  void add(const std::vector<std::string>& fields, const std::string& where, FlightPlan& plan) const {
    const auto at = [&](Column column) { return value(find(column), fields, where); };
    const auto given = [&](Column column) {
      const double number = at(column);
      return std::isnan(number) ? std::nullopt : std::optional(number);
    };
    PlanItem& item = plan.items.emplace_back();
    item.place = where;
    if (is_in_scene_frame_) {
      item.position = {{at(Column::x), at(Column::y)}, at(Column::z), HeightDatum::scene_z};
      if (!item.position.horizontal.allFinite() || std::isnan(item.position.height_m)) {
        PlanSource::fail_at(ErrorCode::plan_syntax, where, "the row lacks x, y or z", "give all three");
      }
    } else {
      item.position.horizontal = checked_lonlat(at(Column::longitude), at(Column::latitude), where);
      item.position.height_m = value(height_, fields, where);
      item.position.datum = height_ ? height_->known.datum : HeightDatum::unknown;
      if (at(Column::mode) == 1) item.position.datum = HeightDatum::ground;  // of Litchi
    }
    if (const auto hold = given(Column::hold)) item.hold_s = *hold;
    const double speed = at(Column::speed);
    if (speed != 0) item.speed_m_s = speed;  // of Litchi: 0 is that of the whole mission
    item.yaw_deg = given(Column::yaw);
    item.gimbal_yaw_deg = given(Column::gimbal_yaw);
    item.gimbal_yaw_from_north = true;
    item.gimbal_pitch_deg = given(Column::gimbal_pitch);
    if (const auto curve = given(Column::curve)) item.cut_m = *curve;
  }

  const PlanSource& source_;
  char separator_ = ',';
  std::size_t columns_ = 0;
  std::vector<UsedColumn> uses_;
  std::optional<UsedColumn> height_;
  bool is_in_scene_frame_ = false;
};

}  // namespace

FlightPlan read_csv(const PlanSource& source) { return PlanTable(source).read(); }

}  // namespace vantage::internal::flight::plans
