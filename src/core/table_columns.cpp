#include "common/table_columns.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace vantage {
namespace {

constexpr double kFootM = 0.3048, kKnotMS = 1852.0 / 3600;

constexpr KnownColumn kColumns[] = {
    {"longitude", TableColumn::longitude},
    {"lon", TableColumn::longitude},
    {"lng", TableColumn::longitude},
    {"long", TableColumn::longitude},
    {"latitude", TableColumn::latitude},
    {"lat", TableColumn::latitude},
    {"altitude", TableColumn::height},
    {"alt", TableColumn::height},
    {"height", TableColumn::height},
    {"elevation", TableColumn::height},
    {"ele", TableColumn::height},
    {"altitudeamsl", TableColumn::height, HeightDatum::sea_level},
    {"altamsl", TableColumn::height, HeightDatum::sea_level},
    {"heightamsl", TableColumn::height, HeightDatum::sea_level},
    {"amsl", TableColumn::height, HeightDatum::sea_level},
    {"amslaltitude", TableColumn::height, HeightDatum::sea_level},
    {"msl", TableColumn::height, HeightDatum::sea_level},
    {"altmsl", TableColumn::height, HeightDatum::sea_level},
    {"altitudemsl", TableColumn::height, HeightDatum::sea_level},
    {"heightmsl", TableColumn::height, HeightDatum::sea_level},
    {"heightellipsoid", TableColumn::height, HeightDatum::ellipsoid},
    {"ellipsoidheight", TableColumn::height, HeightDatum::ellipsoid},
    {"altitudeellipsoid", TableColumn::height, HeightDatum::ellipsoid},
    {"altellipsoid", TableColumn::height, HeightDatum::ellipsoid},
    {"ellipsoid", TableColumn::height, HeightDatum::ellipsoid},
    {"ellipsoidalheight", TableColumn::height, HeightDatum::ellipsoid},
    {"altitudeabovesealevel", TableColumn::height, HeightDatum::sea_level},
    {"hae", TableColumn::height, HeightDatum::ellipsoid},
    {"altitudewgs84", TableColumn::height, HeightDatum::ellipsoid},
    {"altwgs84", TableColumn::height, HeightDatum::ellipsoid},
    {"heightwgs84", TableColumn::height, HeightDatum::ellipsoid},
    {"agl", TableColumn::height, HeightDatum::ground},
    {"altitudeagl", TableColumn::height, HeightDatum::ground},
    {"altagl", TableColumn::height, HeightDatum::ground},
    {"heightagl", TableColumn::height, HeightDatum::ground},
    {"heightaboveground", TableColumn::height, HeightDatum::ground},
    {"heighthome", TableColumn::height, HeightDatum::home},
    {"heightabovehome", TableColumn::height, HeightDatum::home},
    {"heightabovetakeoff", TableColumn::height, HeightDatum::home},
    {"altitudehome", TableColumn::height, HeightDatum::home},
    {"althome", TableColumn::height, HeightDatum::home},
    {"altituderelative", TableColumn::height, HeightDatum::home},
    {"altrelative", TableColumn::height, HeightDatum::home},
    {"altrel", TableColumn::height, HeightDatum::home},
    {"relativealtitude", TableColumn::height, HeightDatum::home},
    {"relalt", TableColumn::height, HeightDatum::home},
    {"x", TableColumn::x},
    {"y", TableColumn::y},
    {"z", TableColumn::z},
    {"hold", TableColumn::hold},
    {"speed", TableColumn::speed},
    {"uavspeed", TableColumn::speed},
    {"yaw", TableColumn::yaw},
    {"heading", TableColumn::yaw},
    {"gimbalyaw", TableColumn::gimbal_yaw},
    {"gimbalpitch", TableColumn::gimbal_pitch},
    {"gimbalpitchangle", TableColumn::gimbal_pitch},
    {"altitudemode", TableColumn::mode},
    {"curvesize", TableColumn::curve},
};

enum class Measure { none, length, angle, time, speed };

Measure measure_of(TableColumn column) {
  switch (column) {
    case TableColumn::height:
    case TableColumn::x:
    case TableColumn::y:
    case TableColumn::z:
    case TableColumn::curve:
      return Measure::length;
    case TableColumn::longitude:
    case TableColumn::latitude:
    case TableColumn::yaw:
    case TableColumn::gimbal_yaw:
    case TableColumn::gimbal_pitch:
      return Measure::angle;
    case TableColumn::hold:
      return Measure::time;
    case TableColumn::speed:
      return Measure::speed;
    case TableColumn::mode:
      break;
  }
  return Measure::none;
}

struct ColumnUnit {
  std::string_view name;
  Measure measure;
  double factor;
};
// Those that end with another one's name come before it.
constexpr std::array kColumnUnits = {ColumnUnit{"metres", Measure::length, 1},
                                     ColumnUnit{"meters", Measure::length, 1},
                                     ColumnUnit{"feet", Measure::length, kFootM},
                                     ColumnUnit{"ft", Measure::length, kFootM},
                                     ColumnUnit{"degrees", Measure::angle, 1},
                                     ColumnUnit{"deg", Measure::angle, 1},
                                     ColumnUnit{"m/s", Measure::speed, 1},
                                     ColumnUnit{"m_s", Measure::speed, 1},
                                     ColumnUnit{"km/h", Measure::speed, 1 / 3.6},
                                     ColumnUnit{"kmh", Measure::speed, 1 / 3.6},
                                     ColumnUnit{"knots", Measure::speed, kKnotMS},
                                     ColumnUnit{"kn", Measure::speed, kKnotMS},
                                     ColumnUnit{"mph", Measure::speed, 1609.344 / 3600},
                                     ColumnUnit{"min", Measure::time, 60},
                                     ColumnUnit{"s", Measure::time, 1},
                                     ColumnUnit{"m", Measure::length, 1}};

/// By its name, without underscores.
std::optional<KnownColumn> column_named(std::string name) {
  name.erase(std::remove(name.begin(), name.end(), '_'), name.end());
  for (const KnownColumn& column : kColumns) {
    if (column.name == name) return column;
  }
  return std::nullopt;
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Takes one of the signs off the front of the text.
template <std::size_t N>
bool take_sign(std::string_view& text, const std::array<std::string_view, N>& signs) {
  for (const std::string_view sign : signs) {
    if (!text.starts_with(sign)) continue;
    text = trimmed(text.substr(sign.size()));
    return true;
  }
  return false;
}

/// Takes a number without sign off the front: digits, and at most one point.
std::optional<double> take_number(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789."), text.size());
  const ParsedNumber number = parse_number(text.substr(0, end));
  if (number.fault != NumberFault::none) return std::nullopt;
  text = trimmed(text.substr(end));
  return number.value;
}

/// Takes the letter of a hemisphere off one end: 1 or -1 for it, 0 where there is none.
int take_hemisphere(std::string_view& text, bool is_latitude) {
  const std::string_view letters = is_latitude ? "NnSs" : "EeWw";
  for (const bool is_front : {true, false}) {
    if (text.empty()) return 0;
    const std::size_t letter = letters.find(is_front ? text.front() : text.back());
    if (letter == std::string_view::npos) continue;
    text = trimmed(is_front ? text.substr(1) : text.substr(0, text.size() - 1));
    return letter < 2 ? 1 : -1;
  }
  return 0;
}

/// Degrees, minutes and seconds without a sign; nothing where the text is something else.
std::optional<double> degrees_of(std::string_view text) {
  constexpr std::array<std::string_view, 5> kDegree = {"\u00b0", "\u00ba", "\u02da", "deg", "d"};
  constexpr std::array<std::string_view, 3> kMinute = {"\u2032", "\u2019", "'"};
  constexpr std::array<std::string_view, 4> kSecond = {"\u2033", "\u201d", "\"", "''"};
  constexpr double kSixty = 60;
  const std::optional<double> degrees = take_number(text);
  if (!degrees) return std::nullopt;
  double seconds = *degrees * kSixty * kSixty;
  if (text.empty()) return *degrees;
  if (!take_sign(text, kDegree)) return std::nullopt;
  if (text.empty()) return *degrees;
  const std::optional<double> minutes = take_number(text);
  if (!minutes || *minutes > kSixty || *degrees != std::floor(*degrees)) return std::nullopt;
  if (text.starts_with("''") || !take_sign(text, kMinute)) return std::nullopt;
  seconds += *minutes * kSixty;
  if (!text.empty()) {
    const std::optional<double> rest = take_number(text);
    if (!rest || *rest > kSixty || *minutes != std::floor(*minutes)) return std::nullopt;
    if (!take_sign(text, kSecond) || !text.empty()) return std::nullopt;
    seconds += *rest;
  }
  return seconds / (kSixty * kSixty);
}

}  // namespace

std::optional<KnownColumn> known_column(std::string_view title, bool* has_unknown_unit) {
  std::string name;
  for (const char c : title) {
    name += c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (has_unknown_unit) *has_unknown_unit = false;
  if (const auto whole = column_named(name)) return whole;
  for (const ColumnUnit& unit : kColumnUnits) {
    for (const std::string& end :
         {"(" + std::string(unit.name) + ")", "[" + std::string(unit.name) + "]", "_" + std::string(unit.name)}) {
      if (name.size() <= end.size() || !name.ends_with(end)) continue;
      auto column = column_named(name.substr(0, name.size() - end.size()));
      if (!column || measure_of(column->column) != unit.measure) continue;
      column->factor = unit.factor;
      return column;
    }
  }
  const std::size_t last = name.find_last_of("_([");
  if (has_unknown_unit && last != std::string::npos) *has_unknown_unit = column_named(name.substr(0, last)).has_value();
  return std::nullopt;
}

ParsedNumber TableNumbers::parse(std::string_view field, TableColumn column) {
  const auto parsed = [&](std::string_view text) {
    const bool is_latitude = column == TableColumn::latitude;
    return is_latitude || column == TableColumn::longitude ? parse_coordinate(text, is_latitude) : parse_number(text);
  };
  const std::size_t at = may_have_commas_ ? field.find_first_of(".,") : std::string_view::npos;
  if (at == std::string_view::npos) return parsed(field);
  const char mark = field[at];
  const bool is_other = mark_ != 0 && mark_ != mark;
  if (is_other || field.find_first_of(".,", at + 1) != std::string_view::npos) return {};
  std::string plain(field);
  plain[at] = '.';
  const ParsedNumber number = parsed(plain);
  if (number.fault == NumberFault::none) mark_ = mark;
  return number;
}

std::string table_advice(std::string_view field, TableColumn column, NumberFault fault) {
  if (parse_number(field).fault == NumberFault::none) {  // another number of the table has the other mark
    return "write all numbers with decimal points, or all with decimal commas";
  }
  const bool is_place = column == TableColumn::longitude || column == TableColumn::latitude;
  const bool is_plain = field.find_first_not_of("+-0123456789.,eE_") == std::string_view::npos;
  if (fault != NumberFault::not_a_number || !is_place || is_plain) return number_advice(field, fault);
  return std::string("write degrees with decimals, or such as ") +
         (column == TableColumn::latitude ? "48\u00b008'05\"N" : "11\u00b034'30\"E");
}

ParsedNumber parse_coordinate(std::string_view text, bool is_latitude) {
  const ParsedNumber plain = parse_number(text);
  if (plain.fault != NumberFault::not_a_number) return plain;
  text = trimmed(text);
  const int hemisphere = take_hemisphere(text, is_latitude);
  const bool is_negative = text.starts_with("-");
  if (is_negative || text.starts_with("+")) {
    if (hemisphere != 0) return {};
    text = trimmed(text.substr(1));
  }
  const std::optional<double> degrees = degrees_of(text);
  if (!degrees) return {};
  return {*degrees * (hemisphere < 0 || is_negative ? -1 : 1), NumberFault::none};
}

}  // namespace vantage
